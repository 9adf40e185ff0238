// A part that stands level on both lower corners (hard/standing_level): the same floor holds both, so that T of each is
// not known, only their sum. The feet stay where they were put, while the springs of gripper and floor come to balance.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "../support/hard_scene.h"
#include "../support/runs.h"

namespace vibratory_alignment {
namespace {

/// Moment per tilt: of gripper and floor, and of the pressing force, whose lever is -b phi.
double tilt_stiffness(const Scene& scene) {
  const double k = scene.base.stiffness_y, a = scene.part.half_width, b = scene.part.base_distance;
  return scene.gripper.phi.stiffness + 2.0 * k * a * a - b * *scene.gripper.pressing_force;
}

/// The tilt at which moments balance.
double level_tilt(const Scene& scene) {
  return scene.gripper.phi.stiffness * scene.gripper.anchor_phi / tilt_stiffness(scene);
}

/// How far from there friction may hold the part: the feet, 2 a phi apart in height, with T = +-f f0/2 each. A solver
/// that counts their levers as the same leaves it where moments balance.
double held_tilt(const Scene& scene) {
  return scene.friction->coefficient * *scene.gripper.pressing_force * scene.part.half_width * level_tilt(scene) /
         tilt_stiffness(scene);
}

void expect_rest(const Scene& scene, double start_tilt) {
  // the gripper's anchor lies below where one of the corners first touches
  const double anchor_y = scene.part.half_width * start_tilt - *scene.gripper.pressing_force;
  const double k = scene.base.stiffness_y, tilt = level_tilt(scene);
  const TrialResult result = test::run(scene, {}, scene.trial.time_limit);
  ASSERT_NE(result.outcome, Outcome::failed) << scene.solver.name << ": " << result.failure;
  const State& end = result.final_state;
  EXPECT_NEAR(end.phi, tilt, 1.001 * held_tilt(scene) + 1e-14) << scene.solver.name;
  EXPECT_NEAR(end.x, scene.part.base_distance * (start_tilt - end.phi), 1e-14) << scene.solver.name;
  EXPECT_NEAR(end.y, anchor_y / (2.0 * k + 1.0), 1e-14) << scene.solver.name;
}

TEST(StandingLevel, comes_to_rest_where_the_springs_balance) {
  for (const char* solver : {"event", "implicit", "auto"}) {
    const Scene scene = test::hard_scene("standing_level", {std::string("solver.name=") + solver});
    expect_rest(scene, *scene.initial.phi);
  }
}

TEST(StandingLevel, stays_at_rest_where_it_begins_at_rest) {
  for (const char* solver : {"event", "implicit", "auto"}) {
    Scene scene =
        test::hard_scene("standing_level", {std::string("solver.name=") + solver, "base={stiffness: {y: 9.0e+4}}",
                                            "part.half_width=1.0", "gripper.anchor.phi=0.002"});
    scene.initial.phi.reset();
    expect_rest(scene, level_tilt(scene));
  }
}

}  // namespace
}  // namespace vibratory_alignment
