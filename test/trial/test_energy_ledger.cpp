// The energy ledger: closed on every scene that is shipped, and each of its terms where a closed form gives it.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "../support/runs.h"
#include "../support/scenes.h"
#include "trial/energy.h"

namespace vibratory_alignment {
namespace {

using test::run;
using test::scene_of;

std::vector<std::string> shipped_scenes() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(SCENE_DIR))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

class ShippedScene : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(scene, ShippedScene, testing::ValuesIn(shipped_scenes()), [](const auto& info) {
  std::string name = std::filesystem::path(info.param).stem().string();
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
});

TEST_P(ShippedScene, closes_its_ledger) {
  const TrialResult result = run(load_scene_file(GetParam()));
  EXPECT_NE(result.outcome, Outcome::failed) << result.failure;
  ASSERT_TRUE(result.energy);
  const EnergyLedger& e = *result.energy;
  EXPECT_LT(e.residual, 1e-9);
  // energy leaves through dampers and friction only
  EXPECT_GE(e.gripper_loss, 0.0);
  EXPECT_GE(e.base_loss, 0.0);
  EXPECT_GE(e.friction_loss, -1e-12);
  // the balance itself, from the terms that are reported
  const double balance = e.initial + e.excitation_work + e.turning - e.gripper_loss - e.base_loss - e.friction_loss -
                         e.release_loss - e.final;
  EXPECT_LT(std::abs(balance), 1e-9 * e.exchanged);
  EXPECT_GE(e.exchanged, std::abs(e.initial));
}

TEST(EnergyLedger, is_kept_on_request_only) {
  SimulationOptions options;
  options.energy = false;
  Simulation simulation(scene_of(test::ball), options);
  while (simulation.advance()) {
  }
  EXPECT_FALSE(simulation.result().energy);
}

// A part that swings freely, damped: E(0) - E(t) went into the damper.
TEST(EnergyLedger, of_a_damped_swing) {
  const Scene scene =
      scene_of(test::ball, {"gripper={anchor: {y: 2.0}, damping: {y: 0.3}}", "initial.y=2.5", "trial.time_limit=7"});
  const TrialResult r = run(scene, {}, 7.0);
  const double w = std::sqrt(1.0 - 0.15 * 0.15),
               y = 0.5 * std::exp(-0.15 * 7.0) * (std::cos(w * 7.0) + 0.15 / w * std::sin(w * 7.0));
  const double v = -0.5 * std::exp(-0.15 * 7.0) / w * std::sin(w * 7.0);
  EXPECT_NEAR(r.energy->initial, 0.125, 1e-15);
  EXPECT_NEAR(r.energy->final, 0.5 * (y * y + v * v), 1e-14);
  EXPECT_NEAR(r.energy->gripper_loss, 0.125 - 0.5 * (y * y + v * v), 1e-13);
  EXPECT_EQ(r.energy->excitation_work, 0.0);
}

// The steady swing A sin(nu t)/(1 - nu^2) takes what the excitation gives: E(t) - E(0) = work.
TEST(EnergyLedger, of_a_driven_swing) {
  const double nu = 3.0, a = 1.0 / (1.0 - nu * nu), t = 5.3;
  Scene scene = scene_of(
      test::ball, {"gripper={anchor: {y: 3.0}}", "initial.y=3.0", "excitation={amplitude: 1.0, frequency: 3.0}"});
  scene.initial.vy = nu * a;
  const TrialResult r = run(scene, {}, t);
  // integral of sin(nu t) a nu cos(nu t)
  EXPECT_NEAR(r.energy->excitation_work, 0.5 * a * std::sin(nu * t) * std::sin(nu * t), 1e-14);
}

// One impact: (1 - e^2) v^2/2 is lost, in the damper of the base and with what the base keeps when the part leaves it.
TEST(EnergyLedger, of_one_impact) {
  Scene scene = scene_of(
      test::ball, {"gripper={anchor: {y: 0.9}}", "initial.y=1.2", "base={stiffness: {y: 1.0e6}, damping: {y: 600}}"});
  scene.solver.tolerance = 1e-12;
  double before = 0.0, after = 0.0, dropped = 0.0;
  const TrialResult r = run(
      scene,
      [&](const Segment& g) {
        for (int i = 0; i < g.event_count; ++i) {
          const EventKind kind = g.events[static_cast<std::size_t>(i)].kind;
          if (kind == EventKind::touch) before = g.end.vy;
          if (kind != EventKind::release) continue;
          after = g.end.vy;
          dropped = 0.5e6 * std::pow(0.9 - g.end.y, 2);
        }
      },
      2.5);
  ASSERT_EQ(r.impacts[0], 1);
  EXPECT_NEAR(r.energy->release_loss, dropped, 1e-13);
  const double spring = 0.5 * 2.0 * dropped / 1e6;  // of the gripper at the release, k_y = 1
  EXPECT_NEAR(r.energy->base_loss + dropped, 0.5 * (before * before - after * after) - spring, 1e-12);
}

// In a segment so short that the part goes less than the last digit of its depth the damper takes what the velocities
// say, h d'^2: the slope between two rounded depths is none.
TEST(EnergyLedger, of_a_segment_that_only_rounding_sees) {
  constexpr double kTime = 1e-17, kSpeed = 2.0, kDepth = 1e-3, kDamping = 600.0, kLastDigit = 1e-16;
  const System system = make_system(scene_of(test::ball, {"base={stiffness: {y: 1.0e6}, damping: {y: 600}}"}));
  Segment g;
  g.duration = kTime;
  g.order = 1;
  g.begin.y = g.end.y = system.base_distance - kDepth;
  g.begin.vy = g.end.vy = -kSpeed;
  g.y[0] = g.begin.y;
  g.y[1] = g.vy[0] = -kSpeed;
  g.contacts[0] = {Phase::loaded, Face::bottom};
  g.loaded_count = 1;
  g.loaded[0].site = Site::a1;
  g.loaded[0].depth[0] = kDepth;
  g.loaded[0].depth[1] = kSpeed + kLastDigit / kTime;
  EnergyAccount account(system);
  account.book(g);
  EXPECT_NEAR(account.ledger().base_loss / (kDamping * kSpeed * kSpeed * kTime), 1.0, 1e-6);
}

// A part at its anchor that is pushed by as much as the last digit of its place: the energy there is that digit,
// squared, whatever the work. An imbalance of energies that are known counts, however small they are.
TEST(EnergyLedger, of_a_trial_that_ends_where_it_began) {
  const System system = make_system(scene_of(test::ball, {"gripper={anchor: {y: 2.0}}"}));
  const auto residual_after = [&](double way) {
    Segment g;
    g.duration = g.order = 1;
    g.begin.y = g.end.y = 2.0;
    g.end.y += way;
    g.y = {2.0, way};
    g.vy = {way};
    g.drive_y = {0.125 * way};  // a quarter of the work that the spring takes
    EnergyAccount account(system);
    account.book(g);
    return account.ledger().residual;
  };
  EXPECT_EQ(residual_after(std::nextafter(2.0, 3.0) - 2.0), 0.0);
  EXPECT_NEAR(residual_after(std::ldexp(1.0, -40)), 3.0, 1e-6);
}

// An implicit step passes over a ring, which its velocities may still show at its start: the damper takes no more than
// N says, (N - k d) d'.
TEST(EnergyLedger, of_an_implicit_step) {
  constexpr double kTime = 1e-3, kSpeed = 2.0, kDepth = 1e-2, kDamping = 600.0, kStiffness = 1e6;
  const System system = make_system(scene_of(test::ball, {"base={stiffness: {y: 1.0e6}, damping: {y: 600}}"}));
  for (const double share : {0.0, 0.5, 1.0}) {  // of the damper's force that is in N
    Segment g;
    g.coarse = true;
    g.duration = kTime;
    g.order = 1;
    g.begin.y = system.base_distance - kDepth;
    g.end.y = g.begin.y - kSpeed * kTime;
    g.begin.vy = g.end.vy = -kSpeed;
    g.y = {g.begin.y, -kSpeed};
    g.vy = {-kSpeed};
    g.contacts[0] = {Phase::loaded, Face::bottom};
    g.loaded_count = 1;
    g.loaded[0].site = Site::a1;
    g.loaded[0].depth = {kDepth, kSpeed};
    g.loaded[0].normal_force = {kStiffness * kDepth + share * kDamping * kSpeed, kStiffness * kSpeed};
    EnergyAccount account(system);
    account.book(g);
    EXPECT_NEAR(account.ledger().base_loss / (kDamping * kSpeed * kSpeed * kTime), share, 1e-9);
  }
}

// C1 != C2: the normal turns under load and the spring's stiffness with it, which is a term of its own.
TEST(EnergyLedger, of_a_normal_that_turns) {
  const std::vector<std::string> turning = {"base={stiffness: {x: 300, y: 900}}",
                                            "friction=null",
                                            "gripper.damping=null",
                                            "initial={x: 0.21, y: 1.0, phi: 0.3, omega: -2.0}",
                                            "gripper.pressing_force=null",
                                            "gripper.anchor.y=0.6"};
  const TrialResult r = run(scene_of(test::plain, turning));
  EXPECT_GT(std::abs(r.energy->turning), 1e-4);
  EXPECT_LT(r.energy->residual, 1e-11);
  std::vector<std::string> fixed = turning;
  fixed[0] = "base={stiffness: {y: 900}}";
  EXPECT_EQ(run(scene_of(test::plain, fixed)).energy->turning, 0.0);
}

// ... and that of a base which has not come back yet, when the part has left it and turns on: to the base's own damper.
TEST(EnergyLedger, of_a_normal_that_turns_over_a_base_that_recovers) {
  const TrialResult r =
      run(scene_of(test::plain, {"base={stiffness: {x: 300, y: 900}, damping: {x: 90, y: 90}, recovery: true}",
                                 "friction=null", "gripper.damping=null", "gripper.pressing_force=null",
                                 "initial={x: 0.21, y: 1.0, phi: 0.3, omega: -2.0}", "gripper.anchor.y=0.6"}));
  ASSERT_GT(test::total_impacts(r), 1);
  EXPECT_GT(std::abs(r.energy->turning), 1e-4);
  EXPECT_LT(r.energy->residual, 1e-11);
}

}  // namespace
}  // namespace vibratory_alignment
