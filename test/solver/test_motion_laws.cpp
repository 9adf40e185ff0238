// Whole runs under the eyes of MotionCheck: every segment must obey the model, whatever the scene calls for.
// The names say what is switched on; the numbers only make sure that it happens.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../support/cases.h"
#include "../support/motion_check.h"
#include "../support/random_scenes.h"
#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

struct LawCase {
  std::string name;
  std::vector<std::string> settings;
};

std::ostream& operator<<(std::ostream& out, const LawCase& c) { return out << c.name; }

/// Slips down at about 3; floor and walls when asked for.
const std::string full = R"(
part: {half_width: 0.673, base_distance: 0.9015, inertia: 0.149}
slot: {clearance: 0.09}
gripper:
  stiffness: {x: 0.0147, phi: 7.3}
  damping: {x: 0.011, y: 0.01, phi: 1.33}
  pressing_force: 0.2
base: {stiffness: {x: 3648.0, y: 7600.0}, damping: {x: 9.96, y: 20.75}}
contacts: [edges, corners]
friction: {coefficient: 0.319}
excitation: {amplitude: 1.0, frequency: 20.0}
initial: {x: 0.2, y: 0.895, phi: 0.025}
trial: {time_limit: 6.0, aligned_depth: 0.02}
)";

const std::vector<LawCase>& cases() {
  static const std::vector<LawCase> all = {
      {"dry", {}},
      {"tight", {"solver.tolerance=1e-12"}},
      {"loose", {"solver.tolerance=1e-4"}},
      {"no_friction", {"friction=null"}},
      {"much_friction", {"friction.coefficient=1.5"}},
      {"regularised", {"friction.regularization=2.0e-3"}},
      {"regularised_steep", {"friction.regularization=1.0e-5", "trial.time_limit=1"}},
      {"isotropic", {"base={stiffness: {y: 7600}, damping: {y: 20}}"}},
      {"undamped_base", {"base.damping={y: 0}"}},
      {"overdamped_base", {"base.damping={x: 300, y: 600}"}},
      {"damped_one_way_only", {"base.damping={x: 20, y: 0}"}},
      {"soft_base", {"base={stiffness: {y: 50}, damping: {y: 1}}"}},
      {"recovery", {"base.recovery=true"}},
      {"recovery_slow", {"base={stiffness: {x: 300, y: 600}, damping: {x: 40, y: 80}, recovery: true}"}},
      {"recovery_and_walls", {"base.recovery=true", "contacts=[edges, corners, walls]", "slot.depth=0.3"}},
      {"walls_and_floor", {"contacts=[edges, corners, walls]", "slot.depth=0.1", "gripper.pressing_force=0.4"}},
      {"walls_without_edges",
       {"contacts=[corners, walls]", "initial.x=0.05", "initial.y=0.95", "initial.phi=-0.2", "gripper.anchor.phi=-0.3",
        "gripper.pressing_force=null", "gripper.anchor.y=0.3"}},
      {"wedged_in_the_slot",
       {"contacts=[edges, corners, walls]", "slot={clearance: 0.02, depth: 0.4}",
        "initial={x: 0.005, y: 0.8, phi: 0.01}", "gripper.anchor.phi=0.15", "gripper.pressing_force=null",
        "gripper.anchor.y=0.4"}},
      {"edges_only", {"contacts=[edges]"}},
      {"corners_only",
       {"contacts=[corners]", "initial.y=0.93", "initial.phi=-0.03", "gripper.pressing_force=null",
        "gripper.anchor.y=0.75"}},
      {"square", {"excitation.waveform=square"}},
      {"triangle", {"excitation.waveform=triangle", "excitation.phase=0.7"}},
      {"chirp", {"excitation={amplitude: 1, frequency: 5, waveform: chirp, end_frequency: 35, sweep_time: 2}"}},
      {"three_directions",
       {"excitation=[{amplitude: 1, frequency: 20}, {amplitude: 0.4, frequency: 13, direction: x, phase: 1}, "
        "{amplitude: 0.3, frequency: 8, direction: phi, waveform: triangle}]"}},
      {"all_waveforms",
       {"excitation=[{amplitude: 0.6, frequency: 20, waveform: square}, {amplitude: 0.5, frequency: 17, waveform: "
        "triangle}, "
        "{amplitude: 0.2, frequency: 6, direction: x, waveform: square}, {amplitude: 0.3, frequency: 3, waveform: "
        "chirp, "
        "end_frequency: 40, sweep_time: 3, direction: phi}]"}},
      {"pressed_without_impacts", {"gripper.pressing_force=2.0"}},
      {"weight", {"weight=0.5"}},
      {"tilt_locked", {"part.inertia=null", "initial.phi=0.025"}},
      {"x_locked", {"gripper.stiffness.x=null"}},
      {"only_y", {"part.inertia=null", "gripper.stiffness.x=null", "initial.phi=0.0"}},
      {"light_tilt", {"part.inertia=1.0e-5", "trial.time_limit=1"}},
      {"fast_start", {"initial={x: 0.2, y: 0.95, phi: 0.1, vx: -0.7, vy: -1.5, omega: 3}"}},
      {"from_below_the_surface", {"initial={x: 0.2, y: 0.87, phi: 0.0}"}},
      {"spinning",
       {"initial={x: 0.1, y: 1.4, phi: 0.5, vx: 0.1, vy: -0.5, omega: 7}", "gripper.stiffness.phi=0.5",
        "gripper.damping.phi=0"}},
      {"tilted_far",
       {"initial={x: 0.1, y: 1.3, phi: 1.2}", "gripper.anchor.phi=1.0", "gripper.pressing_force=null",
        "gripper.anchor.y=0.3"}},
      {"flat_on_edge_and_corner", {"initial={x: 0.3, y: 1.0, phi: 0.0}"}},
      {"flat_on_the_floor",
       {"contacts=[edges, corners, walls]", "slot.depth=0.3", "initial={x: 0.02, y: 0.7, phi: 0}",
        "gripper.pressing_force=null", "gripper.anchor.y=0.1", "trial.aligned_depth=0.29"}},
      {"low_frequency", {"excitation.frequency=0.9", "gripper.pressing_force=0.5", "trial.time_limit=10"}},
      {"high_frequency", {"excitation.frequency=300", "excitation.amplitude=5", "trial.time_limit=2"}},
  };
  return all;
}

class MotionLawsOf : public testing::TestWithParam<LawCase> {};
INSTANTIATE_TEST_SUITE_P(scene, MotionLawsOf, testing::ValuesIn(cases()),
                         [](const auto& info) { return info.param.name; });

TEST_P(MotionLawsOf, hold_in_every_segment) {
  Scene scene = test::scene_of(full, GetParam().settings);
  scene.name = GetParam().name;
  const TrialResult result = test::checked_run(scene);
  EXPECT_NE(result.outcome, Outcome::failed) << result.failure;
  EXPECT_GT(
      result.impacts[0] + result.impacts[1] + result.impacts[2] + result.impacts[3] + (result.mode == Mode::nonimpact),
      0);
  // truncation and the roundoff of a stiff base
  EXPECT_LT(result.energy->residual, std::max(1e-9, 1e-2 * scene.solver.tolerance));
}

// Random scenes of all effects. The seeds beyond the first hundred have found faults before.
TEST(MotionLaws, hold_in_random_scenes) {
  std::vector<unsigned> seeds = {152, 163, 169, 224, 231, 242, 260, 311, 614, 652, 902, 929, 1025, 1041};
  for (unsigned seed = 1; seed <= test::cases_of(100); ++seed) seeds.push_back(seed);
  for (const unsigned seed : seeds) {
    Scene scene = test::random_scene(seed);
    scene.name = "seed " + std::to_string(seed);
    const TrialResult result = test::checked_run(scene);
    EXPECT_NE(result.outcome, Outcome::failed) << scene.name << ": " << result.failure;
    EXPECT_LT(result.energy->residual, 1e-9) << scene.name;
  }
}

// What a crossing of the tanh layer passes over would be seen: other contacts, ends of faces, kinks of the excitation.
TEST(MotionLaws, hold_in_random_scenes_whose_layers_are_crossed) {
  for (unsigned seed = 1; seed <= test::cases_of(150); ++seed) {
    Scene scene = test::random_scene(seed);
    scene.name = "seed " + std::to_string(seed) + " with layers";
    test::cross_layers(scene);
    const TrialResult result = test::checked_run(scene);
    EXPECT_NE(result.outcome, Outcome::failed) << scene.name << ": " << result.failure;
    EXPECT_LT(result.energy->residual, 1e-5) << scene.name;
  }
}

}  // namespace
}  // namespace vibratory_alignment
