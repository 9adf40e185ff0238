// Impacts with closed forms: restitution of a linear base, chatter to rest, a ball on a shaken table.
// The part only moves up and down, so that it is a ball of mass 1 on a spring and damper that can only push.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "../support/runs.h"
#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

using test::events_of;
using test::scene_of;
using test::TimedEvent;

/// A ball over a base of stiffness k and damping ratio zeta.
Scene ball(double k, double zeta, const std::vector<std::string>& settings = {}) {
  Scene scene = scene_of(test::ball, settings);
  scene.base.stiffness_x = scene.base.stiffness_y = k;
  scene.base.damping_x = scene.base.damping_y = 2.0 * zeta * std::sqrt(k);
  scene.solver.tolerance = 1e-12;
  return scene;
}

/// Speed after over speed before the first impact.
double restitution(const Scene& scene) {
  double before = 0.0;
  for (const TimedEvent& e : events_of(scene)) {
    if (e.event.kind == EventKind::touch) before = e.state.vy;
    // without damping force and depth end together, and the contact is over
    if (e.event.kind == EventKind::release) return -e.state.vy / before;
  }
  return NAN;
}

/// Push only: the ball leaves when k d + h d' = 0, which is d'' = 0.
double linear_restitution(double zeta) {
  if (zeta < 1.0) {
    const double beta = std::sqrt(1.0 - zeta * zeta);
    return std::exp(-zeta / beta * std::atan2(2.0 * zeta * beta, 2.0 * zeta * zeta - 1.0));
  }
  // d ~ exp(-r t) - exp(-R t): r^2 exp(-r t) = R^2 exp(-R t)
  const double root = std::sqrt(zeta * zeta - 1.0), fast = zeta + root, slow = 1.0 / fast;
  const double t = 2.0 * std::log(fast / slow) / (fast - slow);
  return -(fast * std::exp(-fast * t) - slow * std::exp(-slow * t)) / (fast - slow);
}

// The gripper's spring is at ease at the height of touch, so that its force in contact is d: it changes the stiffness k
// by 1, and so the restitution by O(1/k).
TEST(Impact, restitution_is_that_of_a_linear_base) {
  for (const double zeta : {0.0, 0.05, 0.1, 0.3, 0.6, 0.9, 1.5, 5.0})
    for (const double k : {1e4, 1e6, 1e8}) {
      const Scene scene = ball(k, zeta, {"gripper.anchor.y=0.9", "initial.y=1.2"});
      EXPECT_NEAR(restitution(scene), linear_restitution(zeta), 3.0 / k + 1e-9) << zeta << " " << k;
    }
}

TEST(Impact, restitution_has_the_published_values) {
  const double known[][2] = {{0.1, 0.74408}, {0.3, 0.45098}, {0.6, 0.24884}};
  for (const auto& [zeta, e] : known) {
    EXPECT_NEAR(linear_restitution(zeta), e, 5e-6);
    EXPECT_NEAR(restitution(ball(1e7, zeta, {"gripper.anchor.y=0.9", "initial.y=1.2"})), e, 6e-6);
  }
}

// Linear: the restitution does not know the speed.
TEST(Impact, restitution_does_not_depend_on_the_speed) {
  const double slow = restitution(ball(1e6, 0.3, {"gripper.anchor.y=0.9", "initial.y=0.9001"}));
  const double fast = restitution(ball(1e6, 0.3, {"gripper.anchor.y=0.9", "initial.y=3.0"}));
  EXPECT_NEAR(slow, fast, 1e-9);
}

// A ball that falls by 1e-3 under g = 1 (its weight; the spring adds 1e-3 of that) and bounces with e: the flights last
// 2 e v/g, 2 e^2 v/g, ... together 2 e v/(g (1 - e)), until v is lost in the base's own sag g/sqrt(k).
TEST(Impact, chatter_comes_to_rest_after_finitely_many_events) {
  for (const double k : {1e6, 1e8, 1e10}) {
    const double zeta = 0.1, e = linear_restitution(zeta), v = std::sqrt(2e-3);
    Scene scene = ball(k, zeta, {"gripper.anchor.y=0.9", "initial.y=0.901", "weight=1"});
    scene.solver.tolerance = 1e-8;
    const double rigid = v + 2.0 * e * v / (1.0 - e);
    const std::vector<TimedEvent> events = events_of(scene, 1.3 * rigid);
    double last_touch = 0.0;
    int touches = 0;
    for (const TimedEvent& event : events)
      if (event.event.kind == EventKind::touch) {
        last_touch = event.time;
        ++touches;
      }
    const double bounces = std::log(v * std::sqrt(k)) / std::log(1.0 / e);
    EXPECT_LE(touches, bounces + 3.0) << k;
    EXPECT_GE(touches, bounces - 8.0) << k;
    // what is cut off of the geometric series, and the time spent in contact, are of the order of touches / sqrt(k)
    EXPECT_NEAR(last_touch, rigid, 2e-3 * rigid + 10.0 * touches / std::sqrt(k)) << k;
    EXPECT_LT(events.size(), 8.0 * touches + 20.0);
  }
}

// ... and then stays there, at rest under its load, which is an outcome.
TEST(Impact, chatter_ends_in_lasting_contact) {
  const Scene scene = ball(1e4, 0.1, {"gripper.anchor.y=0.9", "initial.y=0.91", "weight=1", "trial.time_limit=1000"});
  const TrialResult result = test::run(scene);
  EXPECT_EQ(result.outcome, Outcome::stalled) << result.failure;
  EXPECT_NEAR(result.final_state.y, 0.9 - 1.0 / (1e4 + 1.0), 1e-12);
  EXPECT_LT(result.counts.events, 200);
}

/// Times between the last 20 touches, as shares of the period, of a ball on a table shaken with acceleration Gamma g. Seen
/// from the table that is a force Gamma w sin(nu tau). Spring and base are so soft and so stiff that neither is felt.
/// It starts 1 % off the motion that bounces once a period T: there it leaves with u = w T e/(1 + e) in the phase
/// cos theta = pi (1 - e)/(1 + e)/Gamma.
std::vector<double> flights_on_a_shaken_table(double gamma, double zeta) {
  const double pi = 3.14159265358979323846, nu = 1000.0, period = 2.0 * pi / nu, e = linear_restitution(zeta);
  Scene scene = ball(1e12, zeta, {"gripper.anchor.y=0.9", "weight=1", "excitation.frequency=1000"});
  scene.excitations[0].amplitude = gamma;
  scene.excitations[0].phase = std::acos(pi * (1.0 - e) / (1.0 + e) / gamma);
  scene.initial.y = 0.9;
  scene.initial.vy = 1.01 * period * e / (1.0 + e);
  scene.solver.tolerance = 1e-9;
  scene.trial.time_limit = 300.0 * period;
  std::vector<double> shares;
  double last = NAN;
  for (const TimedEvent& event : events_of(scene, scene.trial.time_limit)) {
    if (event.event.kind != EventKind::touch) continue;
    shares.push_back((event.time - last) / period);
    last = event.time;
  }
  return {shares.end() - 20, shares.end()};
}

// With e = e(0.3): one bounce a period from Gamma = pi (1 - e)/(1 + e) = 1.189, and no longer stably beyond
// Gamma^2 = (pi (1 - e)/(1 + e))^2 + (2 (1 + e^2)/(1 + e)^2)^2 = 1.649^2.
TEST(Impact, ball_on_a_shaken_table_bounces_once_a_period) {
  for (const double gamma : {1.25, 1.4, 1.55, 1.63})
    for (const double share : flights_on_a_shaken_table(gamma, 0.3)) EXPECT_NEAR(share, 1.0, 1e-4) << gamma;
}

TEST(Impact, ball_on_a_shaken_table_doubles_its_period) {
  for (const double gamma : {1.67, 1.72}) {
    const std::vector<double> shares = flights_on_a_shaken_table(gamma, 0.3);
    for (std::size_t i = 0; i + 2 < shares.size(); ++i) {
      EXPECT_NEAR(shares[i], shares[i + 2], 1e-3) << gamma;
      EXPECT_NEAR(shares[i] + shares[i + 1], 2.0, 1e-3) << gamma;
      EXPECT_GT(std::abs(shares[i] - shares[i + 1]), 0.01) << gamma;
    }
  }
}

// With less than its weight the ball never leaves: |A| < f0 + w.
TEST(Impact, nothing_bounces_below_the_pressing_force) {
  const std::vector<std::string> pressed = {"gripper={pressing_force: 0.8, damping: {y: 0.05}}", "initial.y=null", "excitation.amplitude=0.7",
                                            "excitation.frequency=20"};
  EXPECT_EQ(test::total_impacts(test::run(ball(1e4, 0.1, pressed), {}, 10.0)), 0);
  std::vector<std::string> shaken = pressed;
  shaken[2] = "excitation.amplitude=1.2";
  EXPECT_GT(test::total_impacts(test::run(ball(1e4, 0.1, shaken), {}, 10.0)), 3);
}

}  // namespace
}  // namespace vibratory_alignment
