// Touches one by one: a ball whose impacts are known, and the sums that a trial's row keeps.
#include "study/touches.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../support/numbers.h"
#include "../support/scenes.h"
#include "model/scene_loader.h"
#include "study/trial_row.h"
#include "study_text.h"

namespace vibratory_alignment {
namespace {

using test::kPi;

// A ball on an undamped base, springs at ease at the height of touch, dropped from 0.3 above: it meets the base with
// v = 0.3 after a quarter of its swing, is in it for half a swing of the frequency sqrt(k + 1) with the largest force
// k v/sqrt(k + 1), and comes back after half a swing of its own.
TEST(Touches, of_a_ball_are_known) {
  constexpr double k = 1e4;
  Scene scene = test::scene_of(test::ball, {"gripper={anchor: {y: 0.9}}", "initial.y=1.2",
                                            "base={stiffness: {y: 1.0e4}}", "trial.time_limit=6"});
  scene.solver.tolerance = 1e-12;
  const std::vector<Touch> touches = touches_of(scene);
  ASSERT_EQ(touches.size(), 2U);
  const double contact = kPi / std::sqrt(k + 1.0);
  for (const Touch& touch : touches) {
    EXPECT_EQ(touch.spot, Spot::a1);
    EXPECT_NEAR(touch.contact_time, contact, 1e-10);
    EXPECT_NEAR(touch.peak_force, k * 0.3 / std::sqrt(k + 1.0), 1e-8);
    EXPECT_NEAR(touch.normal_impulse, 2.0 * 0.3 * k / (k + 1.0), 1e-10);
    EXPECT_EQ(touch.friction_impulse, 0.0);
    EXPECT_NEAR(touch.state.vy, -0.3, 1e-10);
  }
  EXPECT_NEAR(touches[0].time, kPi / 2.0, 1e-12);
  EXPECT_TRUE(std::isnan(touches[0].gap));
  EXPECT_TRUE(std::isnan(touches[0].peak_before));
  EXPECT_NEAR(touches[1].gap, kPi, 1e-10);
  EXPECT_EQ(touches[1].peak_before, touches[0].peak_force);
}

TEST(Touches, add_up_to_the_row_of_the_trial) {
  const Scene scene = load_scene_file(std::string(SCENE_DIR) + "/fig2.yaml");
  const TrialRow row = run_trial_row(scene, 0);
  TrialRow::Spots<long> count{};
  TrialRow::Spots<double> normal{}, friction{}, peak{};
  for (const Touch& touch : touches_of(scene)) {
    const auto spot = static_cast<std::size_t>(touch.spot);
    ++count[spot];
    normal[spot] += touch.normal_impulse;
    friction[spot] += touch.friction_impulse;
    peak[spot] = std::max(peak[spot], touch.peak_force);
  }
  EXPECT_GT(count[0], 1);
  // Fig. 2 starts pressed on A1: a touch, but no impact
  --count[0];
  for (std::size_t spot = 0; spot < kSpotCount; ++spot) {
    EXPECT_EQ(count[spot], row.impacts[spot]);
    EXPECT_EQ(peak[spot], row.peak_force[spot]);
    EXPECT_NEAR(normal[spot], row.normal_impulse[spot], 1e-13);
    EXPECT_NEAR(friction[spot], row.friction_impulse[spot], 1e-13);
  }
}

// One trial of a ball that nothing brings to rest.
TEST(Touches, are_not_asked_for_to_the_end_of_a_long_trial) {
  const Scene scene =
      test::scene_of(test::ball, {"base.damping.y=0", "trial.time_limit=1e9", "solver={name: rk4, step: 1.0e-3}"});
  int asked = 0;
  EXPECT_THROW(touches_of(scene, [&] { return ++asked < 3; }), std::runtime_error);
  EXPECT_EQ(asked, 3);
}

TEST(TouchTable, has_the_values_of_the_trial_in_each_row) {
  const Study study = test::study_of(R"(
set: {trial.time_limit: 6, base.damping.y: 0}
vary:
  - initial.y: [1.2, 1.3]
)",
                                     test::ball + "\n");
  const Table table = touch_table(study);
  const std::vector<double>&y = *table.find("initial.y"), &a1 = *table.find("a1"), &b1 = *table.find("b1");
  ASSERT_GE(table.rows(), 2U);
  EXPECT_EQ(y.front(), 1.2);
  EXPECT_EQ(y.back(), 1.3);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    EXPECT_EQ(a1[row], 1.0);
    EXPECT_EQ(b1[row], 0.0);
  }
  EXPECT_EQ(touch_columns(study).names, table.names);
  EXPECT_EQ(touch_columns(study).rows(), 0U);
  EXPECT_THROW(touch_table(study, [] { return false; }), std::runtime_error);
}

// The ball of the first test in SI units, m, K, k of the gripper and of the base, dropped from h above: it meets the
// base with v = h sqrt(K/m), is in it for half a swing of sqrt((k + K)/m), and comes back after half a swing of its
// own.
TEST(Touches, are_in_the_units_of_the_scene) {
  constexpr double m = 0.1, K = 4000.0, k = 4e7, h = 1e-3;
  Scene scene = test::scene_of(R"(
units: si
part: {mass: 0.1, half_width: 2.0e-3, base_distance: 1.8e-3}
slot: {clearance: 2.0e-4}
gripper: {stiffness: {y: 4000}, anchor: {y: 1.8e-3}}
base: {stiffness: {y: 4.0e+7}}
contacts: [edges]
excitation: {force: 0, frequency: 10}
initial: {x: 4.0e-4, y: 2.8e-3}
trial: {time_limit: 0.03}
)");
  scene.solver.tolerance = 1e-12;
  const std::vector<Touch> touches = touches_of(scene);
  ASSERT_EQ(touches.size(), 2U);
  const double v = h * std::sqrt(K / m), rate = std::sqrt((k + K) / m);
  for (const Touch& touch : touches) {
    EXPECT_NEAR(touch.contact_time * rate / kPi, 1.0, 1e-7);
    EXPECT_NEAR(touch.peak_force / (k * v / rate), 1.0, 1e-7);
    EXPECT_NEAR(touch.normal_impulse / (2.0 * m * v * k / (k + K)), 1.0, 1e-7);
    EXPECT_NEAR(touch.state.vy / -v, 1.0, 1e-7);
    EXPECT_NEAR(touch.state.y / 1.8e-3, 1.0, 1e-7);
    EXPECT_NEAR(touch.state.x / 4e-4, 1.0, 1e-12);
  }
  EXPECT_NEAR(touches[0].time / (kPi / 2.0 * std::sqrt(m / K)), 1.0, 1e-7);
  EXPECT_NEAR(touches[1].gap / (kPi * std::sqrt(m / K)), 1.0, 1e-7);
  EXPECT_NEAR(touches[1].peak_before / touches[0].peak_force, 1.0, 1e-15);
}

// It ends in the middle of its first impact.
TEST(Touches, have_the_one_that_the_trial_ends_in) {
  constexpr double k = 1e4;
  Scene scene =
      test::scene_of(test::ball, {"gripper={anchor: {y: 0.9}}", "initial.y=1.2", "base={stiffness: {y: 1.0e4}}"});
  scene.trial.time_limit = kPi / 2.0 + 0.5 * kPi / std::sqrt(k + 1.0);
  const std::vector<Touch> touches = touches_of(scene);
  ASSERT_EQ(touches.size(), 1U);
  EXPECT_NEAR(touches[0].contact_time, 0.5 * kPi / std::sqrt(k + 1.0), 1e-9);
}

// Each column has what its name says, and a trial that is refused has no rows and ends nothing.
TEST(TouchTable, has_the_numbers_of_each_touch_under_their_names) {
  const std::vector<std::string> settings = {"trial.time_limit=6", "friction.coefficient=0.2",
                                             "gripper={stiffness: {x: 0}, anchor: {y: 0.6}}", "base.damping.y=5"};
  std::string set;
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    set += (set.empty() ? "" : ", ") + setting.substr(0, equals) + ": " + setting.substr(equals + 1);
  }
  const Table table = touch_table(
      test::study_of("set: {" + set + "}\nvary: [{initial.vx: [0.04, nonsense, 0.08]}]\n", test::ball + "\n"));
  std::size_t row = 0;
  for (const char* speed : {"0.04", "0.08"}) {
    std::vector<std::string> all = settings;
    all.push_back(std::string("initial.vx=") + speed);
    const std::vector<Touch> touches = touches_of(test::scene_of(test::ball, all));
    ASSERT_GT(touches.size(), 2U);
    for (const Touch& touch : touches) {
      ASSERT_LT(row, table.rows());
      const auto expect = [&](const char* name, double value) {
        const double found = (*table.find(name))[row];
        EXPECT_TRUE(found == value || (std::isnan(found) && std::isnan(value))) << name << ": " << found;
      };
      expect("time", touch.time);
      expect("contact_time", touch.contact_time);
      expect("gap", touch.gap);
      expect("peak_force", touch.peak_force);
      expect("peak_before", touch.peak_before);
      expect("normal_impulse", touch.normal_impulse);
      expect("friction_impulse", touch.friction_impulse);
      expect("x", touch.state.x);
      expect("y", touch.state.y);
      expect("phi", touch.state.phi);
      expect("vx", touch.state.vx);
      expect("vy", touch.state.vy);
      expect("omega", touch.state.omega);
      ++row;
    }
  }
  EXPECT_EQ(row, table.rows());
}

}  // namespace
}  // namespace vibratory_alignment
