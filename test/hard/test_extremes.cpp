// Extremes (hard/extremes, hard/overturned): each ends with an outcome, in finite numbers and with a closed ledger.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../support/hard_scene.h"
#include "../support/runs.h"

namespace vibratory_alignment {
namespace {

/// What is beyond a solver is given up, but never silently and never for ever.
TrialResult expect_an_end(const std::string& name, const std::vector<std::string>& settings) {
  Scene scene = test::hard_scene(name, settings);
  scene.solver.step_limit = 30000;
  const TrialResult result = test::run(scene);
  const std::string& first = settings.front();
  const State& s = result.final_state;
  EXPECT_NE(result.outcome, Outcome::running) << first;
  EXPECT_TRUE(std::isfinite(s.x + s.y + s.phi + s.vx + s.vy + s.omega)) << first;
  EXPECT_LT(result.energy->residual, 1e-9) << first;
  if (result.outcome == Outcome::failed) {
    EXPECT_FALSE(result.failure.empty()) << first;
  }
  return result;
}

TEST(Extremes, inertia_from_1e_minus_8_to_1e3) {
  for (const char* inertia : {"1.0e-8", "1.0e-6", "1.0e-4", "1.0e-2", "1", "1.0e+3"})
    expect_an_end("extremes", {std::string("part.inertia=") + inertia});
}

// The inertia's own motion is over after some mu/h = 3e-8: then h phi' + k (phi - phi_a) = 0, and a flight is as long
// as its other motions let it be.
TEST(Extremes, decayed_motion_does_not_shorten_flights) {
  Scene scene = test::hard_scene("extremes", {"part.inertia=1.0e-8"});
  Simulation simulation(scene);
  int segments = 0;
  while (simulation.advance() && ++segments < 1000) {
    const Segment& g = simulation.segment();
    if (g.event_count == 0 || g.events[0].kind != EventKind::touch) continue;
    const double slow = 11.0 / 0.31, phi = 0.007 + (0.02 - 0.007) * std::exp(-slow * g.end_time());
    EXPECT_NEAR(g.end.phi, phi, 1e-7);
    EXPECT_NEAR(g.end.omega, -slow * (phi - 0.007), 1e-5);
    break;
  }
  EXPECT_LT(segments, 50);
}

TEST(Extremes, frequency_from_1e_minus_3_to_1e4) {
  for (const char* frequency : {"1.0e-3", "1.0e-1", "1.0e+2", "1.0e+3", "1.0e+4"}) {
    const TrialResult result = expect_an_end("extremes", {std::string("excitation.frequency=") + frequency});
    EXPECT_NE(result.outcome, Outcome::failed) << frequency << ": " << result.failure;
  }
}

TEST(Extremes, clearance_1e_minus_9) {
  const TrialResult result = expect_an_end("extremes", {"slot.clearance=1.0e-9"});
  EXPECT_NE(result.outcome, Outcome::failed) << result.failure;
}

TEST(Extremes, tilt_past_a_right_angle) {
  for (const std::string phi : {"1.5", "1.6", "2.5", "3.14159", "-2.0"}) {
    const TrialResult result = expect_an_end("overturned", {"initial.phi=" + phi, "gripper.anchor.phi=" + phi});
    EXPECT_NE(result.outcome, Outcome::failed) << phi << ": " << result.failure;
  }
}

}  // namespace
}  // namespace vibratory_alignment
