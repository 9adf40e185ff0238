// An effect whose parameter is neutral, or that never comes into play, leaves the motion as it is without the effect:
// every segment, event and result to the last bit.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "../support/runs.h"
#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

using test::scene_of;

using Settings = std::vector<std::string>;

/// Of a velocity: slower is at rest.
constexpr double kRest = 1e-60;

/// Start and end of every segment, its events, and what the result says of the contacts.
std::vector<double> trace(const Scene& scene, bool energy = true) {
  SimulationOptions options;
  options.energy = energy;
  options.until = scene.trial.time_limit;
  Simulation simulation(scene, options);
  std::vector<double> numbers;
  const auto add = [&](const State& s) {
    numbers.insert(numbers.end(), {s.x, s.y, s.phi, s.vx, s.vy, std::abs(s.omega) < kRest ? 0.0 : s.omega});
  };
  while (simulation.advance()) {
    const Segment& segment = simulation.segment();
    numbers.push_back(segment.start.high);
    numbers.push_back(segment.start.low);
    numbers.push_back(segment.duration);
    add(segment.begin);
    add(segment.end);
    for (int i = 0; i < segment.event_count; ++i) {
      const Event& event = segment.events[static_cast<std::size_t>(i)];
      numbers.push_back(static_cast<double>(event.kind));
      numbers.push_back(static_cast<double>(event.site));
    }
  }
  const TrialResult result = simulation.result();
  EXPECT_NE(result.outcome, Outcome::failed) << result.failure;
  EXPECT_GT(test::total_impacts(result), 10);
  for (const double peak : result.peak_force) numbers.push_back(peak);
  for (const long impacts : result.impacts) numbers.push_back(static_cast<double>(impacts));
  numbers.push_back(static_cast<double>(result.mode));
  return numbers;
}

void expect_same(const Scene& without, const Scene& neutral) {
  const std::vector<double> a = trace(without), b = trace(neutral);
  std::size_t i = 0;
  while (i < a.size() && i < b.size() && std::memcmp(&a[i], &b[i], sizeof(double)) == 0) ++i;
  EXPECT_TRUE(i == a.size() && i == b.size())
      << "number " << i << " of " << a.size() << " and " << b.size() << ": " << a[i] << ", " << b[i] - a[i];
}

// A part that bounces on A1, all motions, far from corners and walls.
const std::string bouncing_block = R"(
part: {half_width: 0.673, base_distance: 0.9015, inertia: 0.42}
slot: {clearance: 0.02}
gripper:
  stiffness: {x: 0.53, phi: 60.0}
  damping: {x: 0.011, y: 0.01, phi: 1.33}
  anchor: {phi: 0.2}
  pressing_force: 0.3
base: {stiffness: {y: 7600.0}, damping: {x: 20.75, y: 20.75}}
contacts: [edges]
excitation: [{amplitude: 1.0, frequency: 20.0}]
initial: {x: 0.55, phi: 0.2}
trial: {time_limit: 10.0, aligned_depth: 0.02}
)";

Scene with(const Settings& settings) { return scene_of(bouncing_block, settings); }

TEST(NeutralEffect, friction_of_zero) {
  expect_same(with({}), with({"friction={coefficient: 0.0}"}));
  expect_same(with({}), with({"friction={coefficient: 0.0, regularization: 1.0e-3}"}));
}

TEST(NeutralEffect, oblique_base_that_is_equal_both_ways) { expect_same(with({}), with({"base.stiffness.x=7600.0"})); }

TEST(NeutralEffect, corners_and_walls_out_of_reach) {
  for (const char* friction : {"friction={coefficient: 0.0}", "friction={coefficient: 0.3}"}) {
    expect_same(with({friction}), with({friction, "contacts=[edges, corners]"}));
    expect_same(with({friction}), with({friction, "contacts=[edges, corners, walls]"}));
    expect_same(with({friction}), with({friction, "contacts=[edges, corners, walls]", "slot.depth=0.8"}));
  }
}

TEST(NeutralEffect, slot_depth_without_walls) { expect_same(with({}), with({"slot.depth=0.01"})); }

TEST(NeutralEffect, second_excitation_without_amplitude) {
  for (const char* direction : {"x", "y", "phi"})
    for (const char* waveform : {"sine", "square", "triangle", "chirp, end_frequency: 11.0, sweep_time: 3.0"})
      expect_same(with({}),
                  with({"excitation=[{amplitude: 1.0, frequency: 20.0}, {amplitude: 0.0, frequency: 7.0, direction: " +
                        std::string(direction) + ", waveform: " + waveform + "}]"}));
}

TEST(NeutralEffect, weight_of_zero) { expect_same(with({}), with({"weight=0.0"})); }

// A base without damping has no time to recover in.
TEST(NeutralEffect, recovery_without_damping) {
  const Settings undamped = {"base.damping={x: 0.0, y: 0.0}"};
  expect_same(with(undamped), with({undamped[0], "base.recovery=true"}));
}

// Upright on a base without friction, with an edge exactly below the mass centre: nothing pushes the part sideways, and
// nothing turns it.
const std::string upright = R"(
part: {half_width: 0.625, base_distance: 0.875}
slot: {clearance: 0.125}
gripper: {damping: {y: 0.01}, pressing_force: 0.3}
base: {stiffness: {y: 7600.0}, damping: {x: 20.75, y: 20.75}}
contacts: [edges]
excitation: [{amplitude: 1.0, frequency: 20.0}]
initial: {x: 0.75}
trial: {time_limit: 10.0, aligned_depth: 0.02}
)";

TEST(NeutralEffect, lateral_motion_that_nothing_excites) {
  expect_same(scene_of(upright), scene_of(upright, {"gripper.stiffness.x=0.53"}));
}

TEST(NeutralEffect, tilt_that_nothing_excites) {
  const Settings turns = {"part.inertia=0.42", "gripper.stiffness.phi=60.0", "gripper.damping.phi=1.33"};
  expect_same(scene_of(upright), scene_of(upright, turns));
  expect_same(scene_of(upright, {"gripper.stiffness.x=0.53"}),
              scene_of(upright, {"gripper.stiffness.x=0.53", turns[0], turns[1], turns[2]}));
}

// So heavy that no moment turns it.
TEST(NeutralEffect, tilt_of_endless_inertia) {
  const std::string locked = "part={half_width: 0.673, base_distance: 0.9015}", heavy = "part.inertia=1.0e+100";
  for (const char* friction : {"friction={coefficient: 0.0}", "friction={coefficient: 0.3}"})
    for (const char* base : {"base.stiffness.x=7600.0", "base.stiffness.x=3648.0"})
      expect_same(with({friction, base, locked}), with({friction, base, heavy}));
}

TEST(NeutralEffect, energy_ledger_that_nobody_reads) {
  const Scene scene = with({"friction={coefficient: 0.3}"});
  EXPECT_EQ(trace(scene, false), trace(scene, true));
}

}  // namespace
}  // namespace vibratory_alignment
