#include "solver/semi_implicit.h"

#include <algorithm>
#include <cmath>

#include "solver/box_friction.h"
#include "solver/damped_pushes.h"
#include "solver/first_order.h"

namespace vibratory_alignment {
namespace {

/// Sweeps over the friction of several contacts; one contact needs two to five.
constexpr int kMostSweeps = 200;

/// A velocity, or a force beside the other forces, that is rounding.
constexpr double kRounding = 1e-15;

constexpr int kMostNewtonSteps = 60;

/// Velocity of x, y and phi, or what changes it.
struct Velocity {
  double x = 0.0, y = 0.0, phi = 0.0;

  void add(const Velocity& other, double factor) {
    x += factor * other.x;
    y += factor * other.y;
    phi += factor * other.phi;
  }
  double dot(const Velocity& other) const { return x * other.x + y * other.y + phi * other.phi; }
};

/// A contact that may push in this step, with the directions that it has at the start.
struct Pushing {
  Site site = Site::a1;
  Face face = Face::none;
  ContactPoint point;
  Velocity normal, tangent;                              ///< n and t with their levers
  Velocity normal_kick, tangent_kick;                    ///< change of velocity that a unit of N or T makes in the step
  double normal_mobility = 0.0, tangent_mobility = 0.0;  ///< what they do to n.v and V
  double n = 0.0, t = 0.0;                               ///< N, T
  double end_slip = 0.0;                                 ///< V at the end of the step
};

/// u with u + strength tanh(u/eps) = b. From below, where Newton's steps never go beyond the root: tanh is concave.
double solve_layer(double b, double strength, double eps) {
  const double target = std::abs(b);
  double u = std::max(target - strength, target / (1.0 + strength / eps));
  for (int i = 0; i < kMostNewtonSteps; ++i) {
    const double z = std::tanh(u / eps);
    const double change = (target - u - strength * z) / (1.0 + strength / eps * (1.0 - z * z));
    u += change;
    if (!(change > kRounding * target)) break;
  }
  return std::copysign(u, b);
}

class Step {
 public:
  explicit Step(const StepStart& start)
      : start_(start), system_(start.system), h_(start.duration), drive_(start.drives.at(0.0)) {
    const State& s = start.book.placed.state;
    inverse_mass_ = {inverse_mass(system_.x), inverse_mass(system_.y), inverse_mass(system_.phi)};
    velocity_ = {free_velocity(system_.x, inverse_mass_.x, s.x, s.vx, drive_.x),
                 free_velocity(system_.y, inverse_mass_.y, s.y, s.vy, drive_.y - system_.weight),
                 free_velocity(system_.phi, inverse_mass_.phi, s.phi, s.omega, drive_.phi)};
    for (int n = 0; n < start.sites.count; ++n) add_contact(start.sites.sites[static_cast<std::size_t>(n)]);
  }

  void solve() {
    if (count_ == 0) return;
    const double reach = system_.half_width + system_.base_distance + system_.slot_half_width;
    const double speed = std::abs(velocity_.x) + std::abs(velocity_.y) + reach * std::abs(velocity_.phi);
    solve_normal_forces();
    if (system_.friction > 0.0) solve_friction(reach, speed);
  }

  void write(Segment& segment, std::array<Slip, kSiteCount>& slip_at_end) const {
    segment.end = end_state();
    set_first_order_motion(start_, drive_, segment);
    if (count_ == 0) return;
    const PlacedState end(segment.end);
    for (int i = 0; i < count_; ++i) {
      const Pushing& c = contacts_[static_cast<std::size_t>(i)];
      const bool sticks = std::abs(c.t) < system_.friction * c.n;
      add_first_order_contact(start_, c.site, {c.n, c.t, sticks}, end, segment, slip_at_end);
    }
  }

 private:
  double inverse_mass(const Axis& axis) const { return axis.moves ? 1.0 / (axis.inertia + h_ * axis.damping) : 0.0; }

  double free_velocity(const Axis& axis, double inverse_mass, double q, double v, double force) const {
    return axis.moves ? inverse_mass * (axis.inertia * v + h_ * (force - axis.stiffness * (q - axis.anchor))) : v;
  }

  void add_contact(Site site) {
    if (!may_push(system_, start_.book, site)) return;
    Pushing& c = contacts_[static_cast<std::size_t>(count_++)];
    c.site = site;
    c.face = start_.book.contacts[static_cast<std::size_t>(site)].face;
    c.point = start_.book.touching[static_cast<std::size_t>(site)];
    c.normal = {c.point.normal.x, c.point.normal.y, c.point.normal_lever()};
    c.tangent = {c.point.tangent.x, c.point.tangent.y, c.point.tangent_lever()};
    c.normal_kick = kick(c.normal);
    c.tangent_kick = kick(c.tangent);
    c.normal_mobility = c.normal.dot(c.normal_kick);
    c.tangent_mobility = c.tangent.dot(c.tangent_kick);
  }

  Velocity kick(const Velocity& direction) const {
    return {h_ * inverse_mass_.x * direction.x, h_ * inverse_mass_.y * direction.y,
            h_ * inverse_mass_.phi * direction.phi};
  }

  State end_state() const {
    const State& s = start_.book.placed.state;
    return {s.x + h_ * velocity_.x, s.y + h_ * velocity_.y, s.phi + h_ * velocity_.phi, velocity_.x, velocity_.y,
            velocity_.phi};
  }

  /// N = max(0, k d + h d'), d of the start, d' of the end, without friction.
  void solve_normal_forces() {
    DampedPushes problem;
    problem.count = count_;
    for (int i = 0; i < count_; ++i) {
      const Pushing& c = contacts_[static_cast<std::size_t>(i)];
      problem.damping[i] = c.point.damping;
      problem.offered[i] = c.point.stiffness * c.point.depth - c.point.damping * c.normal.dot(velocity_);
      for (int j = 0; j < count_; ++j)
        problem.mobility[i][j] = c.normal.dot(contacts_[static_cast<std::size_t>(j)].normal_kick);
    }
    const Mobility::Vector pushes = solve_damped_pushes(problem);
    for (int i = 0; i < count_; ++i) {
      Pushing& c = contacts_[static_cast<std::size_t>(i)];
      c.n = pushes[i];
      velocity_.add(c.normal_kick, c.n);
    }
  }

  /// V of every contact where the velocities found so far lead.
  void look_at_end() {
    const PlacedState end(end_state());
    for (int i = 0; i < count_; ++i) {
      Pushing& c = contacts_[static_cast<std::size_t>(i)];
      c.end_slip = contact_point(system_, end, c.site, c.face, site_point(system_, end, c.site)).slip_velocity;
    }
  }

  /// T of every contact, so that the law of friction holds with V of the end, in the end's own geometry: each time for
  /// the V that the T found so far leads to. `reach`: of the part's points; `speed`: of them, without contacts.
  void solve_friction(double reach, double speed) {
    double scale = speed;
    for (int i = 0; i < count_; ++i) {
      const Pushing& c = contacts_[static_cast<std::size_t>(i)];
      scale += c.n * (c.normal_mobility + system_.friction * c.tangent_mobility);
    }
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
      look_at_end();
      const Mobility::Vector next = system_.regularization > 0.0 ? regularized_friction() : dry_friction(reach);
      double most = 0.0;
      for (int i = 0; i < count_; ++i) {
        Pushing& c = contacts_[static_cast<std::size_t>(i)];
        const double change = next[static_cast<std::size_t>(i)] - c.t;
        most = std::max(most, c.tangent_mobility * std::abs(change));
        c.t += change;
        velocity_.add(c.tangent_kick, change);
      }
      if (!(most > kRounding * scale)) break;
    }
  }

  Mobility::Vector dry_friction(double reach) const {
    BoxFriction problem;
    problem.count = count_;
    problem.typical = h_ * (inverse_mass_.x + inverse_mass_.y + inverse_mass_.phi * reach * reach);
    for (int i = 0; i < count_; ++i) {
      const Pushing& c = contacts_[static_cast<std::size_t>(i)];
      problem.limit[i] = system_.friction * c.n;
      problem.slip_free[i] = c.end_slip;
      for (int j = 0; j < count_; ++j) {
        const Pushing& other = contacts_[static_cast<std::size_t>(j)];
        problem.mobility[i][j] = c.tangent.dot(other.tangent_kick);
        problem.slip_free[i] -= problem.mobility[i][j] * other.t;
      }
    }
    return solve_box_friction(problem);
  }

  /// T = -f N tanh(V/eps): all contacts answer at once, each with its share.
  Mobility::Vector regularized_friction() const {
    const double eps = system_.regularization;
    Mobility::Vector next{};
    for (int i = 0; i < count_; ++i) {
      const Pushing& c = contacts_[static_cast<std::size_t>(i)];
      const double limit = system_.friction * c.n, share = count_ * c.tangent_mobility;
      const double v = solve_layer(c.end_slip - share * c.t, share * limit, eps);
      next[static_cast<std::size_t>(i)] = -limit * std::tanh(v / eps);
    }
    return next;
  }

  const StepStart& start_;
  const System& system_;
  double h_;
  Load3 drive_;
  Velocity inverse_mass_;
  Velocity velocity_;  ///< at the end of the step, as far as it is known
  int count_ = 0;
  std::array<Pushing, kSiteCount> contacts_;
};

}  // namespace

int SemiImplicit::step(const StepStart& start, Segment& segment, std::array<Slip, kSiteCount>& slip_at_end) {
  Step step(start);
  step.solve();
  step.write(segment, slip_at_end);
  return 1;
}

}  // namespace vibratory_alignment
