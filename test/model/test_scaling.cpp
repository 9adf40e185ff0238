// One physical case, in SI units and in the paper's dimensionless numbers, is one scene. The expected numbers come from
// the nomenclature of the paper (section 2), each written out as it is printed there, not from the program's factors.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "model/scaling.h"
#include "model/scene.h"
#include "scene_text.h"

namespace vibratory_alignment {
namespace {

using scene_text::least_si;
using scene_text::load;

// The physical case: M, K_Y, F1 and p = sqrt(K_Y / M).
constexpr double M = 0.137, K = 3910.0, F = 7.3;
const double p = std::sqrt(K / M);

const std::string full_si = R"(
name: full
units: si
part: {mass: 0.137, half_width: 1.3e-3, base_distance: 1.7e-3, inertia: 9.1e-8}
slot: {clearance: 1.1e-4, depth: 2.3e-3}
gripper:
  stiffness: {x: 311.0, y: 3910.0, phi: 0.83}
  damping: {x: 0.31, y: 1.13, phi: 1.9e-5}
  anchor: {x: 4.1e-4, phi: 0.011}
  pressing_force: 1.9
base: {stiffness: {x: 2.9e6, y: 4.7e6}, damping: {x: 61.0, y: 83.0}, recovery: true}
contacts: [edges, corners, walls]
friction: {coefficient: 0.23, regularization: 3.7e-4}
weight: 1.34
excitation:
  - {force: 7.3, frequency: 91.0, phase: 0.4, waveform: chirp, end_frequency: 170.0, sweep_time: 0.031}
  - {force: 2.1, frequency: 47.0, direction: x}
  - {moment: 1.3e-3, frequency: 33.0, direction: phi}
initial: {x: 3.7e-4, y: 1.65e-3, phi: 0.021, vx: 0.013, vy: -0.017, omega: 1.9}
trial: {time_limit: 0.71, aligned_depth: 4.3e-5, inserted_depth: 1.9e-3, force_limit: 310.0}
solver: {name: rk4, step: 1.0e-6}
)";

/// The same by hand. Lengths by K/F, forces by 1/F, times by p, k_phi = K_phi K / F^2, h = H / sqrt(K M),
/// h_phi = H_phi p^3 M / F^2, mu = (I / M) / (F / K)^2, nu = omega / p.
Scene expected_scene() {
  Scene s;
  s.part = {1.3e-3 * K / F, 1.7e-3 * K / F};
  s.slot = {1.1e-4 * K / F, 2.3e-3 * K / F};
  s.gripper.x = {true, 1.0, 311.0 / K, 0.31 / std::sqrt(K * M)};
  s.gripper.y = {true, 1.0, 1.0, 1.13 / std::sqrt(K * M)};
  s.gripper.phi = {true, (9.1e-8 / M) * (K / F) * (K / F), 0.83 * K / (F * F), 1.9e-5 * p * p * p * M / (F * F)};
  s.gripper.anchor_x = 4.1e-4 * K / F;
  s.gripper.anchor_phi = 0.011;
  s.gripper.pressing_force = 1.9 / F;
  s.base = {2.9e6 / K, 4.7e6 / K, 61.0 / std::sqrt(K * M), 83.0 / std::sqrt(K * M), true};
  s.friction = Friction{0.23, 3.7e-4 * K / (F * p)};
  s.weight = 1.34 / F;
  const double two_pi = 2.0 * std::acos(-1.0);
  s.excitations = {{Direction::y, Waveform::chirp, 1.0, two_pi * 91.0 / p, 0.4, two_pi * 170.0 / p, 0.031 * p},
                   {Direction::x, Waveform::sine, 2.1 / F, two_pi * 47.0 / p, 0.0, 0.0, 0.0},
                   {Direction::phi, Waveform::sine, 1.3e-3 * K / (F * F), two_pi * 33.0 / p, 0.0, 0.0, 0.0}};
  s.initial.x = 3.7e-4 * K / F;
  s.initial.y = 1.65e-3 * K / F;
  s.initial.phi = 0.021;
  s.initial.vx = 0.013 * K / (F * p);
  s.initial.vy = -0.017 * K / (F * p);
  s.initial.omega = 1.9 / p;
  s.trial = {0.71 * p, 4.3e-5 * K / F, 1.9e-3 * K / F, 310.0 / F};
  s.solver.step = 1.0e-6 * p;
  return s;
}

/// Every number of a scene that has all of them.
std::vector<std::pair<std::string, double>> numbers(const Scene& s) {
  std::vector<std::pair<std::string, double>> all = {
      {"half_width", s.part.half_width},
      {"base_distance", s.part.base_distance},
      {"clearance", s.slot.clearance},
      {"depth", s.slot.depth.value()},
      {"anchor_x", s.gripper.anchor_x},
      {"anchor_phi", s.gripper.anchor_phi},
      {"pressing_force", s.gripper.pressing_force.value()},
      {"base.stiffness_x", s.base.stiffness_x},
      {"base.stiffness_y", s.base.stiffness_y},
      {"base.damping_x", s.base.damping_x},
      {"base.damping_y", s.base.damping_y},
      {"friction.coefficient", s.friction.value().coefficient},
      {"regularization", s.friction.value().regularization.value()},
      {"weight", s.weight},
      {"initial.x", s.initial.x},
      {"initial.y", s.initial.y.value()},
      {"initial.phi", s.initial.phi.value()},
      {"initial.vx", s.initial.vx},
      {"initial.vy", s.initial.vy},
      {"initial.omega", s.initial.omega},
      {"time_limit", s.trial.time_limit},
      {"aligned_depth", s.trial.aligned_depth},
      {"inserted_depth", s.trial.inserted_depth.value()},
      {"force_limit", s.trial.force_limit.value()},
      {"step", s.solver.step.value()},
  };
  for (const GripperAxis& axis : {s.gripper.x, s.gripper.y, s.gripper.phi}) {
    all.emplace_back("axis.inertia", axis.inertia);
    all.emplace_back("axis.stiffness", axis.stiffness);
    all.emplace_back("axis.damping", axis.damping);
  }
  for (const Excitation& excitation : s.excitations) {
    all.emplace_back("excitation.amplitude", excitation.amplitude);
    all.emplace_back("excitation.frequency", excitation.frequency);
    all.emplace_back("excitation.phase", excitation.phase);
    all.emplace_back("excitation.end_frequency", excitation.end_frequency);
    all.emplace_back("excitation.sweep_time", excitation.sweep_time);
  }
  return all;
}

TEST(Scaling, SiSceneIsTheDimensionlessOneOfThePaper) {
  const auto scaled = numbers(load(full_si));
  const auto expected = numbers(expected_scene());
  ASSERT_EQ(scaled.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(scaled[i].second, expected[i].second, 2e-15 * std::abs(expected[i].second)) << expected[i].first;
}

TEST(Scaling, LeavesPureNumbersAlone) {
  const Scene scene = load(full_si);
  EXPECT_EQ(scene.friction->coefficient, 0.23);
  EXPECT_EQ(scene.initial.phi, 0.021);
  EXPECT_EQ(scene.gripper.anchor_phi, 0.011);
  EXPECT_EQ(scene.excitations[0].phase, 0.4);
}

TEST(Scaling, MakesTheAxialAxisAndTheExcitationTheUnits) {
  const Scene scene = load(full_si);
  EXPECT_EQ(scene.gripper.y.inertia, 1.0);
  EXPECT_EQ(scene.gripper.y.stiffness, 1.0);
  EXPECT_EQ(scene.gripper.x.inertia, 1.0);
  EXPECT_EQ(scene.excitations[0].amplitude, 1.0);
  ASSERT_TRUE(scene.scales);
  EXPECT_EQ(scene.scales->mass_kg, M);
  EXPECT_EQ(scene.scales->stiffness_n_per_m, K);
  EXPECT_EQ(scene.scales->force_n, F);
}

TEST(Scaling, LockedMotionsKeepUnitInertia) {
  const Scene scene = load(least_si);
  EXPECT_EQ(scene.gripper.x.inertia, 1.0);
  EXPECT_EQ(scene.gripper.phi.inertia, 1.0);
}

TEST(Scaling, DisplacementActsThroughTheSpring) {
  const Scene scene = load(least_si, {"excitation={displacement: 2.0e-3, frequency: 100}"});
  EXPECT_DOUBLE_EQ(scene.scales->force_n, 4000.0 * 2.0e-3);
  EXPECT_EQ(scene.excitations[0].amplitude, 1.0);

  const Scene lateral = load(least_si, {"gripper.stiffness.x=500", "initial.x=0",
                                        "excitation=[{force: 8, frequency: 1}, "
                                        "{displacement: 2.0e-3, frequency: 1, direction: x}]"});
  EXPECT_DOUBLE_EQ(lateral.excitations[1].amplitude, 500.0 * 2.0e-3 / 8.0);
}

TEST(Scaling, ForceScaleIsTheLargestForceThatThereIs) {
  const auto force_scale = [](const std::string& excitation) {
    return load(least_si, {"excitation=" + excitation}).scales->force_n;
  };
  EXPECT_EQ(force_scale("[{force: 3, frequency: 1}, {force: -5, frequency: 1}]"), 5.0) << "by size";
  EXPECT_EQ(force_scale("[{force: 3, frequency: 1}, {force: 50, frequency: 1, direction: x}]"), 3.0) << "y comes first";
  EXPECT_EQ(force_scale("[{force: 0, frequency: 1}, {force: 50, frequency: 1, direction: x}]"), 50.0);
  EXPECT_EQ(force_scale("{moment: 7, frequency: 1, direction: phi}"), 4000.0 * 1.0e-3) << "K_Y half_width";
  EXPECT_EQ(force_scale("{force: 0, frequency: 1}"), 4000.0 * 1.0e-3);
}

TEST(Scaling, RefusesWhatLeavesTheRangeOfNumbers) {
  const auto faults = scene_text::faults(least_si, {"part.mass=1e-90", "trial.time_limit=1e90", "initial.vy=1e-90"});
  ASSERT_EQ(faults.size(), 2u);
  EXPECT_EQ(faults[0].find("initial.vy: too large or too small"), 0u) << faults[0];
  EXPECT_EQ(faults[1].find("trial.time_limit: too large or too small"), 0u) << faults[1];
}

TEST(OutputUnits, TakeASiSceneBackToItsOwnNumbers) {
  const Scene scene = load(full_si);
  const OutputUnits units = output_units(scene);
  const auto expect_near = [](double value, double expected) { EXPECT_NEAR(value, expected, 2e-15 * expected); };
  expect_near(scene.trial.time_limit * units.time, 0.71);
  expect_near(scene.part.half_width * units.length, 1.3e-3);
  expect_near(scene.initial.vx * units.velocity, 0.013);
  expect_near(scene.initial.omega * units.angular_velocity, 1.9);
  expect_near(scene.weight * units.force, 1.34);
  expect_near(scene.excitations[2].amplitude * units.moment, 1.3e-3);
  expect_near(units.impulse, F / p);
  expect_near(units.energy, F * F / K);
}

TEST(OutputUnits, AreOnesForADimensionlessSceneEvenWithScales) {
  const Scene scene = load(scene_text::least, {"scales={mass: 0.1, stiffness: 4000, force: 8}"});
  const OutputUnits own = output_units(scene);
  for (const double factor :
       {own.time, own.length, own.velocity, own.angular_velocity, own.force, own.moment, own.impulse, own.energy})
    EXPECT_EQ(factor, 1.0);
  ASSERT_TRUE(scene.scales);
  EXPECT_DOUBLE_EQ(si_output_units(*scene.scales).length, 2.0e-3);
  EXPECT_DOUBLE_EQ(si_output_units(*scene.scales).time, 5.0e-3);
}

}  // namespace
}  // namespace vibratory_alignment
