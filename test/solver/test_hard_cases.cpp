// Many periods of the excitation. The other hard cases with known answers are in test/hard.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/runs.h"
#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

using test::run;
using test::scene_of;

// Neither phase nor ledger drifts over 3e4 periods (the phase over 1e6 of them: test_drive.cpp). The steady swing of
// the free part is the closed form A/(1 - nu^2) sin(nu t), which takes from the excitation and gives back all the time.
TEST(HardCases, many_periods_drift_nowhere) {
  const double nu = 20.0, amplitude = 1.0 / (1.0 - nu * nu), pi = 3.14159265358979323846;
  Scene scene =
      scene_of(test::ball, {"excitation={amplitude: 1.0, frequency: 20.0}", "gripper.anchor.y=2.0", "initial.y=2.0"});
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
