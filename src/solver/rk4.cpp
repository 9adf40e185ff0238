#include "solver/rk4.h"

#include <algorithm>
#include <cmath>

namespace vibratory_alignment {
namespace {

/// Never divided by zero: T of a contact that cannot slide.
constexpr double kNarrowest = 1e-300;

struct Rates {
  double vx, vy, omega, ax, ay, alpha;
};

State moved(const State& s, const Rates& r, double t) {
  return {s.x + t * r.vx, s.y + t * r.vy, s.phi + t * r.omega, s.vx + t * r.ax, s.vy + t * r.ay, s.omega + t * r.alpha};
}

/// Forces of one contact.
struct ContactForces {
  Face face = Face::none;  ///< none: does not touch
  double normal = 0.0, tangential = 0.0, slip_velocity = 0.0;
  double layer = 0.0;  ///< eps of tanh(V/eps)
};
using Forces = std::array<ContactForces, kSiteCount>;

class RightHandSide {
 public:
  RightHandSide(const StepStart& start, double step) : start_(start), system_(start.system) {
    int pushing = 0;
    for (std::size_t i = 0; i < kSiteCount; ++i) pushing += may_push(system_, start.book, static_cast<Site>(i)) ? 1 : 0;
    layer_time_ = step * std::max(1, pushing);
  }

  Rates operator()(const PlacedState& placed, double t, const Load3& drive, Forces* forces) const {
    const State& s = placed.state;
    Load3 sum{free_force(system_.x, s.x, s.vx) + drive.x, free_force(system_.y, s.y, s.vy) + drive.y - system_.weight,
              free_force(system_.phi, s.phi, s.omega) + drive.phi};
    for (int n = 0; n < start_.sites.count; ++n) {
      const Site site = start_.sites.sites[static_cast<std::size_t>(n)];
      const Vec2 point = site_point(system_, placed, site);
      const SiteFate fate = fate_of(system_, start_.sites, start_.book, site, placed, point, t);
      ContactForces contact;
      if (fate.phase == Phase::loaded && (fate.changed || may_push(system_, start_.book, site)))
        contact = add_contact(placed, site, fate.face, point, sum);
      if (forces != nullptr) (*forces)[static_cast<std::size_t>(site)] = contact;
    }
    return {s.vx,
            s.vy,
            s.omega,
            sum.x * system_.x.inverse_inertia,
            sum.y * system_.y.inverse_inertia,
            sum.phi * system_.phi.inverse_inertia};
  }

 private:
  static double free_force(const Axis& axis, double q, double v) {
    return -axis.stiffness * (q - axis.anchor) - axis.damping * v;
  }

  /// MODEL.md "Contact", with T = -f N tanh(V/eps).
  ContactForces add_contact(const PlacedState& placed, Site site, Face face, const Vec2& point, Load3& sum) const {
    const ContactPoint p = contact_point(system_, placed, site, face, point);
    ContactForces contact;
    contact.face = face;
    contact.normal = std::max(0.0, p.push());
    contact.slip_velocity = p.slip_velocity;
    if (contact.normal == 0.0) return contact;
    if (system_.friction > 0.0) {
      const double limit = system_.friction * contact.normal;
      contact.layer = system_.regularization > 0.0 ? system_.regularization : dry_layer(p, limit);
      contact.tangential = -limit * std::tanh(p.slip_velocity / contact.layer);
    }
    sum.x += contact.normal * p.normal.x + contact.tangential * p.tangent.x;
    sum.y += contact.normal * p.normal.y + contact.tangential * p.tangent.y;
    sum.phi += contact.normal * p.normal_lever() + contact.tangential * p.tangent_lever();
    return contact;
  }

  /// Dry friction: in the middle of the layer V decays with h lambda = 1, all contacts together; the method is stable
  /// up to 2.78.
  double dry_layer(const ContactPoint& p, double limit) const {
    return std::max(layer_time_ * limit * mobility_along(system_, p.tangent, p.tangent_lever()), kNarrowest);
  }

  const StepStart& start_;
  const System& system_;
  double layer_time_ = 0.0;
};

Slip slip_of(const System& system, const ContactForces& contact) {
  if (system.friction == 0.0) return Slip::none;
  if (std::abs(contact.slip_velocity) <= system.tanh_saturation * contact.layer) return Slip::regularized;
  return contact.slip_velocity > 0.0 ? Slip::plus : Slip::minus;
}

/// The stages' own interpolant, of third order: k2 and k3 share their weight throughout.
void set_motion(Series& series, double begin, double k1, double k2, double k3, double k4, double h) {
  const double middle = k2 + k3;
  series[0] = begin;
  series[1] = k1;
  series[2] = (-1.5 * k1 + middle - 0.5 * k4) / h;
  series[3] = (2.0 / 3.0) * (k1 - middle + k4) / (h * h);
}

/// The parabola through the values at begin, middle and end.
void set_parabola(Series& series, double begin, double middle, double end, double h) {
  series[0] = begin;
  series[1] = (4.0 * middle - 3.0 * begin - end) / h;
  series[2] = 2.0 * (begin - 2.0 * middle + end) / (h * h);
  series[3] = 0.0;
}

/// The forces of what is loaded at the start, as lines between both ends of the step. At the end they are those of the
/// same law, 0 where the contact has ended.
void add_contacts(const StepStart& start, const RightHandSide& rates, const Load3& drive_begin, const Load3& drive_end,
                  Segment& segment, std::array<Slip, kSiteCount>& slip_at_end) {
  const System& system = start.system;
  const double h = start.duration;
  const PlacedState placed(segment.end);
  Forces begin, end;
  rates(start.book.placed, 0.0, drive_begin, &begin);
  rates(placed, h, drive_end, &end);
  for (std::size_t i = 0; i < kSiteCount; ++i) {
    if (segment.contacts[i].phase != Phase::loaded) continue;
    const auto site = static_cast<Site>(i);
    const Face face = segment.contacts[i].face;
    const ContactPoint& p0 = start.book.touching[i];
    const ContactPoint p1 = contact_point(system, placed, site, face, site_point(system, placed, site));
    ContactSeries& contact = segment.loaded[static_cast<std::size_t>(segment.loaded_count++)];
    contact.site = site;
    set_cubic(contact.depth, 3, p0.depth, p0.depth_rate, p1.depth, p1.depth_rate, h);
    set_line(contact.normal_force, 3, begin[i].normal, end[i].normal, h);
    set_line(contact.tangential_force, 3, begin[i].tangential, end[i].tangential, h);
    set_line(contact.slip_velocity, 3, p0.slip_velocity, p1.slip_velocity, h);
    segment.contacts[i].slip = slip_of(system, begin[i]);
    slip_at_end[i] = slip_of(system, end[i]);
  }
}

}  // namespace

int Rk4::step(const StepStart& start, Segment& segment, std::array<Slip, kSiteCount>& slip_at_end) {
  const double h = start.duration;
  const State& s = start.book.placed.state;
  const RightHandSide rates(start, step_);
  const Load3 d0 = start.drives.at(0.0), dm = start.drives.at(0.5 * h), d1 = start.drives.at(h);
  const Rates k1 = rates(start.book.placed, 0.0, d0, nullptr);
  const Rates k2 = rates(PlacedState(moved(s, k1, 0.5 * h)), 0.5 * h, dm, nullptr);
  const Rates k3 = rates(PlacedState(moved(s, k2, 0.5 * h)), 0.5 * h, dm, nullptr);
  const Rates k4 = rates(PlacedState(moved(s, k3, h)), h, d1, nullptr);
  const auto mean = [](double a, double b, double c, double d) { return (a + 2.0 * (b + c) + d) / 6.0; };
  const Rates k{
      mean(k1.vx, k2.vx, k3.vx, k4.vx), mean(k1.vy, k2.vy, k3.vy, k4.vy), mean(k1.omega, k2.omega, k3.omega, k4.omega),
      mean(k1.ax, k2.ax, k3.ax, k4.ax), mean(k1.ay, k2.ay, k3.ay, k4.ay), mean(k1.alpha, k2.alpha, k3.alpha, k4.alpha)};
  segment.end = moved(s, k, h);

  segment.order = 3;
  const auto set = [&](Series& series, double from, double Rates::*rate) {
    set_motion(series, from, k1.*rate, k2.*rate, k3.*rate, k4.*rate, h);
  };
  set(segment.x, s.x, &Rates::vx);
  set(segment.y, s.y, &Rates::vy);
  set(segment.phi, s.phi, &Rates::omega);
  set(segment.vx, s.vx, &Rates::ax);
  set(segment.vy, s.vy, &Rates::ay);
  set(segment.omega, s.omega, &Rates::alpha);
  set_parabola(segment.drive_x, d0.x, dm.x, d1.x, h);
  set_parabola(segment.drive_y, d0.y, dm.y, d1.y, h);
  set_parabola(segment.drive_phi, d0.phi, dm.phi, d1.phi, h);

  const bool any_loaded = std::any_of(segment.contacts.begin(), segment.contacts.end(),
                                      [](const ContactState& c) { return c.phase == Phase::loaded; });
  if (!any_loaded) return 4;
  add_contacts(start, rates, d0, d1, segment, slip_at_end);
  return 6;
}

}  // namespace vibratory_alignment
