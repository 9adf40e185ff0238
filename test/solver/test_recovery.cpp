// A base that recovers: after the release its deformation u follows u' = -(k/h) u, and the part meets it at d = u.
// Checked in closed form, and against a ball integrated here in long double with the base as one more state.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../support/motion_check.h"
#include "../support/runs.h"
#include "../support/scenes.h"
#include "mechanics/contact_frame.h"

namespace vibratory_alignment {
namespace {

using test::TimedEvent;
using Real = long double;

/// A ball on a shaken base that takes k/h = 8 to recover, longer than some of its flights.
Scene ball(double k, double h, double amplitude, double frequency) {
  Scene scene = test::scene_of(
      test::ball, {"gripper={damping: {y: 0.05}, anchor: {y: 0.6}}", "initial.y=0.95", "base.recovery=true"});
  scene.base.stiffness_x = scene.base.stiffness_y = k;
  scene.base.damping_x = scene.base.damping_y = h;
  scene.excitations[0].amplitude = amplitude;
  scene.excitations[0].frequency = frequency;
  scene.trial.time_limit = 6.0;
  scene.solver.tolerance = 1e-11;
  return scene;
}

struct Ball {
  Real y, v, u;
};

/// The same ball by classical Runge-Kutta steps, events by bisection of the step.
class BallIntegrator {
 public:
  BallIntegrator(const Scene& s)
      : k_(s.base.stiffness_y),
        h_(s.base.damping_y),
        b_(s.part.base_distance),
        y_a_(*s.gripper.anchor_y),
        h_y_(s.gripper.y.damping),
        amplitude_(s.excitations[0].amplitude),
        nu_(s.excitations[0].frequency),
        q_{*s.initial.y, 0.0L, 0.0L} {}

  void run_to(Real end) {
    const Real step = 5e-5L;
    while (t_ < end) {
      const Real h = std::min(step, end - t_);
      const Ball next = stepped(h);
      if (over(t_ + h, next)) {
        Real low = 0.0L, high = h;
        while (high - low > 1e-19L) {
          const Real middle = 0.5L * (low + high);
          (over(t_ + middle, stepped(middle)) ? high : low) = middle;
        }
        q_ = stepped(high);
        t_ += high;
        contact_ = !contact_;
        if (contact_)
          touches.push_back(t_);
        else
          releases.push_back(t_);
      } else {
        q_ = next;
        t_ += h;
      }
    }
  }

  const Ball& state() const { return q_; }
  std::vector<Real> touches, releases;

 private:
  Ball rate(Real t, const Ball& q) const {
    const Real depth = b_ - q.y;
    Real force = -(q.y - y_a_) - h_y_ * q.v + amplitude_ * std::sin(nu_ * t);
    if (contact_) force += k_ * depth - h_ * q.v;
    return {q.v, force, contact_ ? -q.v : -k_ / h_ * q.u};  // in contact the base moves with the ball
  }

  /// The contact ends where its force does, the flight where the ball meets the base.
  bool over(Real, const Ball& q) const { return contact_ ? k_ * (b_ - q.y) - h_ * q.v < 0.0L : b_ - q.y > q.u; }

  Ball stepped(Real h) const {
    const auto add = [](const Ball& a, const Ball& b, Real s) {
      return Ball{a.y + s * b.y, a.v + s * b.v, a.u + s * b.u};
    };
    Ball start = q_;
    if (contact_) start.u = b_ - q_.y;
    const Ball k1 = rate(t_, start), k2 = rate(t_ + 0.5L * h, add(start, k1, 0.5L * h));
    const Ball k3 = rate(t_ + 0.5L * h, add(start, k2, 0.5L * h)), k4 = rate(t_ + h, add(start, k3, h));
    return {start.y + h / 6.0L * (k1.y + 2.0L * k2.y + 2.0L * k3.y + k4.y),
            start.v + h / 6.0L * (k1.v + 2.0L * k2.v + 2.0L * k3.v + k4.v),
            start.u + h / 6.0L * (k1.u + 2.0L * k2.u + 2.0L * k3.u + k4.u)};
  }

  Real k_, h_, b_, y_a_, h_y_, amplitude_, nu_;
  Real t_ = 0.0L;
  Ball q_;
  bool contact_ = false;
};

void expect_same(const Scene& scene) {
  BallIntegrator expected(scene);
  expected.run_to(scene.trial.time_limit);
  std::vector<double> touches, releases;
  for (const TimedEvent& e : test::events_of(scene, scene.trial.time_limit)) {
    // re-loading of a base that is still deformed is a contact of the same ball
    if (e.event.kind == EventKind::touch || e.event.kind == EventKind::reload) touches.push_back(e.time);
    if (e.event.kind == EventKind::release) releases.push_back(e.time);
  }
  ASSERT_EQ(touches.size(), expected.touches.size());
  ASSERT_EQ(releases.size(), expected.releases.size());
  ASSERT_GE(touches.size(), 4u);
  for (std::size_t i = 0; i < touches.size(); ++i)
    EXPECT_NEAR(touches[i], static_cast<double>(expected.touches[i]), 1e-8) << i;
  const State end = test::run(scene, {}, scene.trial.time_limit).final_state;
  EXPECT_NEAR(end.y, static_cast<double>(expected.state().y), 1e-8);
  EXPECT_NEAR(end.vy, static_cast<double>(expected.state().v), 1e-7);
}

TEST(Recovery, a_slow_base_is_met_where_it_is) { expect_same(ball(400.0, 50.0, 1.0, 10.0)); }
TEST(Recovery, a_fast_base_is_met_at_its_surface) { expect_same(ball(1000.0, 6.0, 1.0, 10.0)); }
TEST(Recovery, a_base_that_is_shaken_fast_is_left_and_met_again) { expect_same(ball(300.0, 60.0, 6.0, 40.0)); }

// The ball meets the base at u = u(release) exp(-(k/h) dt), exactly.
TEST(Recovery, deformation_relaxes_as_an_exponential) {
  for (const Scene& scene : {ball(400.0, 50.0, 1.0, 10.0), ball(300.0, 60.0, 6.0, 40.0)}) {
    const double rate = scene.base.stiffness_y / scene.base.damping_y;
    double left = 0.0, since = 0.0;
    int met = 0;
    for (const TimedEvent& e : test::events_of(scene, 6.0)) {
      const double depth = 0.9 - e.state.y;
      if (e.event.kind == EventKind::release) {
        left = depth;
        since = e.time;
      }
      if (e.event.kind != EventKind::touch && e.event.kind != EventKind::reload) continue;
      EXPECT_NEAR(depth, left * std::exp(-rate * (e.time - since)), 1e-14) << "at " << e.time;
      ++met;
    }
    EXPECT_GE(met, 4);
  }
}

// Recovering at once (k/h -> infinity) is the default model.
TEST(Recovery, of_a_fast_base_tends_to_the_default) {
  Scene with = ball(4e4, 4.0, 1.0, 10.0), without = with;
  without.base.recovery = false;
  // what is left of u at the next touch is exp(-1e4 dt): nothing
  EXPECT_LT(test::distance(test::run(with, {}, 6.0).final_state, test::run(without, {}, 6.0).final_state), 1e-9);
}

// Flat on a base that is damped along x alone: h = H sin^2 phi, so that it recovers at once or nearly so.
TEST(Recovery, of_a_base_with_almost_no_damping_along_the_normal) {
  const std::string text = R"(
part: {half_width: 1.0, base_distance: 1.3189476809787817, inertia: 0.1}
slot: {clearance: 0.01}
gripper: {stiffness: {phi: 1}, anchor: {x: 0, phi: 0, y: 1}}
base: {stiffness: {x: 1.0e+4, y: 1.0e+4}, damping: {x: 0.3, y: 0}, recovery: true}
contacts: [edges]
excitation: {amplitude: 0, frequency: 1}
initial: {x: 0.4, y: 1.3189476675399427, phi: 0, vx: -1, omega: 1}
trial: {time_limit: 1.0}
)";
  for (const char* tilt : {"0", "1.0e-9", "1.0e-8", "1.0e-7", "1.0e-6", "1.0e-4"}) {
    const Scene scene = test::scene_of(text, {std::string("initial.phi=") + tilt});
    const TrialResult result = test::checked_run(scene);
    EXPECT_NE(result.outcome, Outcome::failed) << tilt << ": " << result.failure;
    EXPECT_LT(result.energy->residual, 1e-9) << tilt;
  }
}

// A point that has left its wall by a rounding, with a deformation that is one as well, and a part whose other edge
// lets go of it while the first is still inside a base that has recovered at once: neither is touched on the way out,
// so that no touch is deep inside.
TEST(Recovery, a_point_on_its_way_out_is_not_touched_again) {
  const std::string spinning = R"(
part: {half_width: 0.2, base_distance: 0.4, inertia: 0.04}
slot: {clearance: 1e-09, depth: 1}
gripper: {stiffness: {}, damping: {x: 0, y: 0, phi: 0}, anchor: {x: 0, y: 1, phi: 0}}
base: {stiffness: {x: 4e+09, y: 1}, damping: {x: 2e+05, y: 0}, recovery: true}
contacts: [walls]
excitation: {amplitude: 0, frequency: 1}
initial: {x: -0.6, y: 0.1, phi: 0}
trial: {time_limit: 0.002, aligned_depth: 0}
)";
  const std::string far_away = R"(
part: {half_width: 1, base_distance: 1.642, inertia: 1.3}
slot: {clearance: 0.007}
gripper: {stiffness: {x: 0}, damping: {x: 0, y: 0, phi: 0}, anchor: {x: 0, y: 1, phi: 0}}
base: {stiffness: {x: 9.2e+11, y: 2e+11}, damping: {x: 8.3e+04, y: 0}, recovery: true}
contacts: [edges, corners, walls]
excitation: {amplitude: 0, frequency: 1}
initial: {x: -2.4, y: 1, phi: 0.04}
trial: {time_limit: 3.2, aligned_depth: 0}
)";
  for (const std::string& text : {spinning, far_away}) {
    const Scene scene = test::scene_of(text);
    const System system = make_system(scene);
    double least = 0.0, most = 0.0, deepest = 0.0;
    const TrialResult result = test::run(scene, [&](const Segment& g) {
      for (int i = 0; i < g.event_count; ++i) {
        const Event& event = g.events[static_cast<std::size_t>(i)];
        if (event.kind == EventKind::touch)
          deepest = std::max(deepest, contact_kinematics(system, g.end, event.site, event.face).depth);
      }
      for (int i = 0; i < g.loaded_count; ++i) {
        const double force = g.loaded[static_cast<std::size_t>(i)].normal_force[0];
        least = std::min(least, force);
        most = std::max(most, force);
      }
    });
    EXPECT_NE(result.outcome, Outcome::failed) << result.failure;
    EXPECT_GT(least, -1e-6 * most) << text;
    EXPECT_LT(deepest, 1e-6) << text;
  }
}

/// A part that turns with an edge under its bottom, on a base stiffer one way, whose k/h is 5 to 12.
const char* const turning = R"(
part: {half_width: 1.0, base_distance: 1.0, inertia: 0.3}
slot: {clearance: 0.01}
gripper: {stiffness: {x: 40, phi: 3}, damping: {x: 0.1, y: 0.1, phi: 0.1}, anchor: {x: 0.2, y: 0.5, phi: 0.5}}
base: {stiffness: {x: 1.2e+3, y: 4.0e+2}, damping: {x: 100, y: 80}, recovery: true}
contacts: [edges]
friction: {coefficient: 0.05}
excitation: {amplitude: 40, frequency: 40}
initial: {x: 0.2, y: 1.1, phi: 0.5, omega: 1}
trial: {time_limit: 12.0}
solver: {name: event, tolerance: 1.0e-11}
)";

/// Integral of k/h of the bottom's normal over the segment, by Simpson's rule.
double relaxed(const System& system, const Segment& segment) {
  constexpr int kPanels = 64;
  double sum = 0.0;
  for (int i = 0; i <= kPanels; ++i) {
    const double phi = state_at(segment, segment.duration * i / kPanels).phi;
    const double along = std::cos(phi) * std::cos(phi), across = std::sin(phi) * std::sin(phi);
    const double rate = (system.stiffness_y * along + system.stiffness_x * across) /
                        (system.damping_y * along + system.damping_x * across);
    sum += (i == 0 || i == kPanels ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * rate;
  }
  return sum * segment.duration / (3.0 * kPanels);
}

double depth_of(const System& system, const State& state, Site site) {
  return contact_kinematics(system, state, site, Face::bottom).depth;
}

// The normal of a face of the part turns after the base has been left, and k/h is that of now: u = u(release)
// exp(-integral of k/h), and the part meets the base there.
TEST(Recovery, beside_a_face_that_turns_goes_at_the_rate_of_its_normal) {
  int met = 0;
  double most_turned = 0.0;
  for (const double frequency : {20.0, 30.0, 40.0, 60.0}) {
    Scene scene = test::scene_of(turning);
    scene.excitations[0].frequency = frequency;
    const System system = make_system(scene);
    std::array<double, kSiteCount> left{}, phi_left{};
    const TrialResult result = test::run(scene, [&](const Segment& segment) {
      const double decay = std::exp(-relaxed(system, segment));
      for (double& u : left) u *= decay;
      for (int i = 0; i < segment.event_count; ++i) {
        const Event& event = segment.events[static_cast<std::size_t>(i)];
        const auto site = static_cast<std::size_t>(event.site);
        if (event.kind == EventKind::release && segment.contacts[site].face == Face::bottom) {
          left[site] = depth_of(system, segment.end, event.site);
          phi_left[site] = segment.end.phi;
        }
        const bool touches = event.kind == EventKind::touch && event.face == Face::bottom;
        if (!(touches || event.kind == EventKind::reload) || left[site] < 1e-6) continue;
        EXPECT_NEAR(depth_of(system, segment.end, event.site), left[site], 1e-12) << "at " << segment.end_time();
        most_turned = std::max(most_turned, std::abs(segment.end.phi - phi_left[site]));
        left[site] = 0.0;
        ++met;
      }
    });
    EXPECT_LT(result.energy->residual, 1e-9);
    EXPECT_NEAR(result.energy->release_loss, 0.0, 1e-11);
  }
  EXPECT_GE(met, 8);
  EXPECT_GT(most_turned, 0.02);
}

// Solvers that only see states at the ends of their steps have the same law.
TEST(Recovery, beside_a_face_that_turns_is_the_same_with_fixed_steps) {
  const Scene exact = test::scene_of(turning, {"trial.time_limit=2.2"});
  Scene stepped = exact;
  stepped.solver.name = "rk4";
  stepped.solver.step = 1e-5;
  EXPECT_LT(test::distance(test::run(stepped).final_state, test::run(exact).final_state), 1e-6);
}

// k/h falls as the part turns while N falls to zero: a base that went on at the rate of the release would be met at
// once, and left at once, for ever.
TEST(Recovery, of_a_base_left_by_a_turning_face_is_not_met_at_once) {
  const std::string narrow = R"(
part: {half_width: 0.59, base_distance: 0.3876, inertia: 0.1332}
slot: {clearance: 0.002}
gripper: {stiffness: {x: 0, phi: 6.053}, damping: {x: 0.019, y: 0, phi: 0.1031}, anchor: {x: 0, phi: 0}, pressing_force: 0.063}
base: {stiffness: {x: 1.131e+05, y: 2.937e+04}, damping: {x: 937.5, y: 131.6}, recovery: true}
contacts: [edges, corners]
friction: {coefficient: 0.1096}
excitation: {amplitude: 2.57, frequency: 1, phase: -7.205436616077949}
initial: {x: -0.3115514847158318, vx: 0.0004, vy: 0.0057, omega: -0.002}
trial: {time_limit: 6, aligned_depth: 0}
)";
  const std::string light = R"(
part: {half_width: 0.6137290436987827, base_distance: 0.34321643420707454, inertia: 1.6851792338481887e-08}
slot: {clearance: 7.894103298632899e-08}
gripper: {stiffness: {x: 1.3383152821867355}, damping: {x: 0.5696981265118617, y: 0.14629996157531677, phi: 2.5727052541468333e-06}, anchor: {x: 0, phi: 0}, pressing_force: 3.169765232410698}
base: {stiffness: {x: 256120928.1250705, y: 505830088.5825627}, damping: {x: 764.7089359776396, y: 31808.912612125136}, recovery: true}
contacts: [edges]
friction: {coefficient: 0.34171849715083535}
excitation:
  - {amplitude: 1, frequency: 1252.6508581807009, direction: y, waveform: triangle}
  - {amplitude: 0.7311906099633312, frequency: 10.459666306263316, direction: x}
initial: {x: 0.8805174193294362, y: 0.3957540308181461, phi: -2.7463685824023836}
trial: {time_limit: 0.04012728856501981, aligned_depth: 0.006864328684141491}
)";
  for (const std::string& text : {narrow, light}) {
    const TrialResult result = test::checked_run(test::scene_of(text));
    EXPECT_NE(result.outcome, Outcome::failed) << result.failure;
    EXPECT_LT(result.energy->residual, 1e-8);
  }
}

TEST(Recovery, closes_the_ledger) {
  for (const Scene& scene :
       {ball(400.0, 50.0, 1.0, 10.0), ball(1000.0, 6.0, 1.0, 10.0), ball(300.0, 60.0, 6.0, 40.0)}) {
    const TrialResult result = test::run(scene, {}, 6.0);
    EXPECT_LT(result.energy->residual, 1e-9);
    // nothing is dropped: what the base keeps goes into its own damper
    EXPECT_NEAR(result.energy->release_loss, 0.0, 1e-11);
  }
}

/// A part whose side presses on the edge a1: along the side of the tilted part the base has k/h = 6e9, elsewhere less.
constexpr char kFastFace[] = R"(
part: {half_width: 1, base_distance: 1}
slot: {clearance: 0.003, depth: 1}
gripper: {stiffness: {x: 0}, damping: {x: 0, y: 0, phi: 0}, anchor: {x: 0, phi: 0}, pressing_force: 1}
base: {stiffness: {x: 1.0e+3, y: 1}, damping: {x: 0, y: 2}}
contacts: [edges, walls]
excitation: [{amplitude: 0, frequency: 1}]
initial: {x: 0.09, y: 0.2, phi: 0.0003, vx: 0, vy: 0, omega: 0}
trial: {time_limit: 0.4, aligned_depth: 0}
solver: {tolerance: 1.0e-10}
)";

// A deformation may recover within a step of any order, at a rate whose powers overflow. The part that has left it goes
// on as if the base had kept none.
TEST(Recovery, powers_of_a_fast_recovery_do_not_overflow) {
  const TrialResult with = test::run(test::scene_of(kFastFace, {"base.recovery=true"}));
  const TrialResult without = test::run(test::scene_of(kFastFace));
  ASSERT_EQ(with.outcome, Outcome::time_limit) << with.failure;
  EXPECT_GT(std::abs(with.final_state.vx), 3.0);  // thrown off, and back
  EXPECT_LT(test::distance(with.final_state, without.final_state), 1e-12);
}

}  // namespace
}  // namespace vibratory_alignment
