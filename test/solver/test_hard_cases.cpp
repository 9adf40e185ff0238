// Extremes: each ends with an outcome, in finite numbers, with a closed ledger where that is promised. Large friction is
// compared with the reference integrator.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../support/reference_scene.h"
#include "../support/runs.h"
#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

using test::run;
using test::scene_of;

bool is_finite(const State& s) { return std::isfinite(s.x + s.y + s.phi + s.vx + s.vy + s.omega); }

/// Cases may be given up (stiff lasting contact is not for this solver), but never silently and never for ever.
TrialResult expect_an_end(const std::vector<std::string>& settings, long step_limit = 30000) {
  Scene scene = scene_of(test::plain, settings);
  scene.solver.step_limit = step_limit;
  const TrialResult result = run(scene);
  std::string all;
  for (const std::string& setting : settings) all += setting + " ";
  EXPECT_NE(result.outcome, Outcome::running) << all;
  EXPECT_TRUE(is_finite(result.final_state)) << all;
  if (result.outcome == Outcome::failed) {
    EXPECT_FALSE(result.failure.empty()) << all;
  }
  return result;
}

TEST(HardCases, inertia_from_1e_minus_8_to_1e3) {
  for (const char* inertia : {"1.0e-8", "1.0e-6", "1.0e-4", "1.0e-2", "1", "1.0e+3"})
    expect_an_end({std::string("part.inertia=") + inertia, "trial.time_limit=0.5"});
}

TEST(HardCases, frequency_from_1e_minus_3_to_1e4) {
  for (const char* frequency : {"1.0e-3", "1.0e-1", "1.0e+2", "1.0e+3", "1.0e+4"}) {
    const TrialResult result = expect_an_end({std::string("excitation.frequency=") + frequency, "trial.time_limit=1"});
    EXPECT_NE(result.outcome, Outcome::failed) << frequency << ": " << result.failure;
  }
}

TEST(HardCases, clearance_1e_minus_9) {
  const TrialResult result = expect_an_end({"slot.clearance=1.0e-9"});
  EXPECT_NE(result.outcome, Outcome::failed) << result.failure;
}

TEST(HardCases, tilt_past_a_right_angle) {
  for (const char* phi : {"1.5", "1.6", "2.5", "3.14159", "-2.0"}) {
    const TrialResult result = expect_an_end({std::string("initial={x: 0.1, y: 2.5, phi: ") + phi + "}", "contacts=[edges, corners, walls]",
        std::string("gripper={anchor: {y: 0.5, phi: ") + phi + "}, stiffness: {x: 0.1, phi: 3}}", "trial.time_limit=6"});
    EXPECT_NE(result.outcome, Outcome::failed) << phi << ": " << result.failure;
    EXPECT_LT(result.energy->residual, 1e-9) << phi;
  }
}

// Bouncing on ever stiffer bases: the number of steps an impact takes stays the same, and the motion tends to the rigid
// limit, from which it is a contact's duration, O(1/sqrt(k)), away.
TEST(HardCases, stiffness_up_to_1e12) {
  double steps[10] = {};
  State end[10];
  int n = 0;
  for (const double k : {1e4, 1e6, 1e8, 1e10, 1e12}) {
    Scene scene = scene_of(test::ball, {"initial.y=1.2"});
    scene.base = {k, k, 0.2 * std::sqrt(k), 0.2 * std::sqrt(k), false};
    const TrialResult result = run(scene, {}, 6.0);
    EXPECT_NE(result.outcome, Outcome::failed) << result.failure;
    EXPECT_LT(result.energy->residual, 1e-9);
    steps[n] = static_cast<double>(result.counts.steps) / static_cast<double>(result.impacts[0]);
    end[n++] = result.final_state;
  }
  for (int i = 1; i < n; ++i) EXPECT_LT(steps[i], 1.5 * steps[0] + 5.0);
  for (int i = 1; i + 1 < n; ++i)
    EXPECT_LT(test::distance(end[i], end[n - 1]), 0.3 * test::distance(end[i - 1], end[n - 1])) << i;
}

// Slender, steep and rough: with f > a cot of the lever angle friction drives the part down into the base (the dynamic
// jam of the Painleve paradox). The growth is followed, it ends, and another integrator says the same.
TEST(HardCases, friction_that_jams_a_slender_part) {
  reference::ReferenceCase c;
  reference::ReferenceParameters& p = c.parameters;
  p.a = 0.3L;
  p.b = 1.5L;
  p.l = 0.4L;
  p.mu = 0.05L;
  p.k_x = 0.5L;
  p.k_phi = 3.0L;
  p.h_x = p.h_y = p.h_phi = 0.02L;
  p.c1 = p.c2 = 3000.0L;
  p.h1 = p.h2 = 20.0L;
  p.excitation_y = {1.0L, 15.0L, 0.0L};
  p.y_a = 1.2L;
  c.start = {0.2L, 1.55L, 0.1L, 1.5L, -0.5L, -0.5L};
  p.x_a = 0.2L;
  c.end_time = 1.2L;
  for (const reference::Real f : {1.0L, 2.0L, 4.0L}) {
    p.f = f;
    const auto expected = reference::integrate(p, c.start, c.end_time, 2e-3L);
    Scene scene = test::scene_of_reference(c);
    scene.solver.tolerance = 1e-13;
    const TrialResult result = run(scene, {}, static_cast<double>(c.end_time));
    EXPECT_NE(result.outcome, Outcome::failed) << result.failure;
    EXPECT_LT(test::distance(result.final_state, expected.state), 1e-10) << static_cast<double>(f);
    EXPECT_LT(result.energy->residual, 1e-11) << static_cast<double>(f);
    EXPECT_GT(result.energy->friction_loss, 0.0);
    EXPECT_EQ(result.impacts[0], expected.touches[0]);
    EXPECT_NEAR(result.peak_force[0], static_cast<double>(expected.peak_force[0]), 1e-8);
  }
}

// Neither phase nor ledger drifts over 3e4 periods (the phase over 1e6 of them: test_drive.cpp). The steady swing of the
// free part is the closed form A/(1 - nu^2) sin(nu t), which takes from the excitation and gives back all the time.
TEST(HardCases, many_periods_drift_nowhere) {
  const double nu = 20.0, amplitude = 1.0 / (1.0 - nu * nu), pi = 3.14159265358979323846;
  Scene scene = scene_of(test::ball, {"excitation={amplitude: 1.0, frequency: 20.0}", "gripper.anchor.y=2.0", "initial.y=2.0"});
  scene.initial.vy = nu * amplitude;  // starts on the steady swing
  scene.trial.time_limit = 3e4 * 2.0 * pi / nu + 1.0;
  const TrialResult result = run(scene, {}, scene.trial.time_limit);
  const double swing = amplitude * std::sin(std::fmod(nu * scene.trial.time_limit, 2.0 * pi));
  // the angle nu t, 2e5 at the end, is a rounded number: 3e-11 of phase, of an amplitude of 2.5e-3
  EXPECT_NEAR(result.final_state.y, 2.0 + swing, 1e-12);
  // the same in the work, 0.05 nu t 3e-11 of 1.3e-3 if it all added up one way: a drift would be 1e3 times as much
  EXPECT_LT(result.energy->residual, 1e-7);
}

}  // namespace
}  // namespace vibratory_alignment
