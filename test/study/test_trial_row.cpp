// What a study keeps of a trial: the result of the trial itself, and impulses and times of contact that obey Newton's
// laws.
#include "study/trial_row.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "../support/random_scenes.h"
#include "../support/runs.h"
#include "../support/scenes.h"
#include "study/row_numbers.h"

namespace vibratory_alignment {
namespace {

using test::scene_of;

TEST(TrialRow, IsTheResultOfTheTrial) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    Scene scene = test::random_scene(seed);
    scene.trial.time_limit = 5.0;
    const TrialResult result = test::run(scene);
    const TrialRow row = run_trial_row(scene, 7);
    EXPECT_EQ(row.index, 7u);
    EXPECT_EQ(row.outcome, result.outcome);
    EXPECT_EQ(row.mode, result.mode);
    EXPECT_EQ(row.end_time, result.final_time);
    EXPECT_EQ(test::distance(row.end, result.final_state), 0.0);
    EXPECT_EQ(row.impacts, result.impacts);
    EXPECT_EQ(row.peak_force, result.peak_force);
    const double duration = result.aligned_time.value_or(TrialRow::none);
    EXPECT_TRUE(row.duration == duration || (std::isnan(row.duration) && std::isnan(duration)));
  }
}

// Every quantity stands under its own name: all numbers of this row differ.
TEST(TrialRow, NumbersHaveTheirNames) {
  TrialRow row;
  row.duration = 1.0, row.end_time = 2.0, row.nonimpact_time = 3.0;
  row.end = {4.0, 5.0, 6.0, 7.0, 8.0, 9.0};
  row.impacts = {11, 12, 13, 14};
  row.first_impact = {21.0, 22.0, 23.0, 24.0}, row.last_impact = {31.0, 32.0, 33.0, 34.0};
  row.peak_force = {41.0, 42.0, 43.0, 44.0}, row.normal_impulse = {51.0, 52.0, 53.0, 54.0};
  row.friction_impulse = {61.0, 62.0, 63.0, 64.0}, row.impulse_x = {71.0, 72.0, 73.0, 74.0};
  row.impulse_y = {81.0, 82.0, 83.0, 84.0}, row.contact_time = {91.0, 92.0, 93.0, 94.0};
  std::map<std::string, double> expected = {{"duration", 1.0}, {"end_time", 2.0}, {"nonimpact_time", 3.0},
                                            {"x", 4.0},        {"y", 5.0},        {"phi", 6.0},
                                            {"vx", 7.0},       {"vy", 8.0},       {"omega", 9.0}};
  const char* const of_spots[] = {"impacts",          "first_impact", "last_impact", "peak_force",  "normal_impulse",
                                  "friction_impulse", "impulse_x",    "impulse_y",   "contact_time"};
  double ten = 0.0;
  for (const std::string name : of_spots) {
    ten += 10.0;
    double spot = 0.0;
    for (const char* const at : {"_a1", "_a2", "_b1", "_b2"}) expected[name + at] = ten + ++spot;
  }
  const std::vector<std::string>& names = row_number_names();
  const std::vector<double> numbers = row_numbers(row);
  ASSERT_EQ(names.size(), numbers.size());
  std::map<std::string, double> found;
  for (std::size_t i = 0; i < names.size(); ++i) found[names[i]] = numbers[i];
  EXPECT_EQ(found, expected);
  EXPECT_EQ(found.size(), names.size()) << "a name twice";
}

// The touches among the events are the impacts, but for one that a trial starts in.
TEST(TrialRow, FirstAndLastImpactAreTheTimesOfTheTouches) {
  for (unsigned seed = 1; seed <= 25; ++seed) {
    Scene scene = test::random_scene(seed);
    scene.trial.time_limit = 5.0;
    TrialRow::Spots<double> first{}, last{};
    TrialRow::Spots<long> count{};
    for (const test::TimedEvent& e : test::events_of(scene)) {
      if (e.event.kind != EventKind::touch || e.time <= 1e-12) continue;
      const auto spot = static_cast<std::size_t>(spot_of(e.event.site));
      if (count[spot]++ == 0) first[spot] = e.time;
      last[spot] = e.time;
    }
    const TrialRow row = run_trial_row(scene, 0);
    EXPECT_EQ(row.impacts, count);
    for (std::size_t spot = 0; spot < kSpotCount; ++spot) {
      EXPECT_EQ(std::isnan(row.first_impact[spot]), count[spot] == 0);
      EXPECT_EQ(std::isnan(row.last_impact[spot]), count[spot] == 0);
      if (count[spot] == 0) continue;
      EXPECT_EQ(row.first_impact[spot], first[spot]);
      EXPECT_EQ(row.last_impact[spot], last[spot]);
    }
  }
}

// With no gripper along x the base alone moves the part sideways: its impulse is the momentum gained.
TEST(TrialRow, ImpulseAlongXIsTheMomentumGained) {
  const Scene scene =
      scene_of(test::plain, {"gripper.stiffness.x=0", "gripper.damping.x=0", "contacts=[edges, corners]"});
  const TrialRow row = run_trial_row(scene, 0);
  double sum = 0.0;
  for (const double impulse : row.impulse_x) sum += impulse;
  EXPECT_GT(std::abs(row.end.vx), 1e-3);
  EXPECT_NEAR(sum, row.end.vx, 1e-12);
}

// A ball on an undamped base, springs at ease at the height of touch: an impact lasts half a swing of the frequency
// sqrt(k + 1), turns the velocity v into -v and gives the impulse 2 v + (gripper: what acts meanwhile); the part of it
// that the base gives is 2 v k/(k + 1).
TEST(TrialRow, OneImpactHasTheImpulseAndTimeOfTheHalfSwing) {
  for (const double k : {1e2, 1e4, 1e6}) {
    Scene scene = scene_of(test::ball, {"gripper={anchor: {y: 0.9}}", "initial.y=1.2", "base={stiffness: {y: 1.0e4}}",
                                        "trial.time_limit=3"});
    scene.base.stiffness_x = scene.base.stiffness_y = k;
    scene.solver.tolerance = 1e-12;
    const TrialRow row = run_trial_row(scene, 0);
    ASSERT_EQ(row.impacts[0], 1);
    EXPECT_NEAR(row.first_impact[0], std::acos(0.0), 1e-12);
    EXPECT_NEAR(row.contact_time[0], std::acos(-1.0) / std::sqrt(k + 1.0), 1e-10);
    EXPECT_NEAR(row.normal_impulse[0], 2.0 * 0.3 * k / (k + 1.0), 1e-10);
    EXPECT_DOUBLE_EQ(row.normal_impulse[0], row.impulse_y[0]);
    for (std::size_t spot = 1; spot < kSpotCount; ++spot) {
      EXPECT_EQ(row.contact_time[spot], 0.0);
      EXPECT_EQ(row.normal_impulse[spot], 0.0);
    }
  }
}

// A part that slides to the right without turning back: T = -f N all the time, so are the integrals.
TEST(TrialRow, FrictionOfASlidingPartIsTheCoefficientTimesTheNormalImpulse) {
  const Scene scene =
      scene_of(test::ball, {"gripper={stiffness: {x: 0}, anchor: {y: 0.6}}", "friction.coefficient=0.25",
                            "initial={x: 0.2, y: 1.0, vx: 1}", "trial.time_limit=1.2"});
  const TrialRow row = run_trial_row(scene, 0);
  EXPECT_GT(row.end.vx, 0.0);
  EXPECT_GT(row.normal_impulse[0], 0.1);
  EXPECT_NEAR(row.friction_impulse[0], -0.25 * row.normal_impulse[0], 1e-12);
  EXPECT_NEAR(row.impulse_x[0], row.friction_impulse[0], 1e-12);
}

// Pressed with less than the excitation a ball bounces, with more it does not; what is in between changes over, and the
// time in nonimpact mode is that between the changes.
TEST(TrialRow, NonimpactTimeIsTheTimeInThatMode) {
  const auto row_of = [](const std::string& force) {
    return run_trial_row(scene_of(test::ball, {"gripper={pressing_force: " + force + "}", "initial={x: 0.2}",
                                               "excitation={amplitude: 1, frequency: 10}"}),
                         0);
  };
  EXPECT_EQ(row_of("0.1").mode, Mode::impact);
  EXPECT_EQ(row_of("0.1").nonimpact_time, 0.0);
  EXPECT_EQ(row_of("3").mode, Mode::nonimpact);
  EXPECT_EQ(row_of("3").nonimpact_time, row_of("3").end_time);
  // comes to rest on the base: bounces first, then stays
  const Scene resting = scene_of(test::ball, {"gripper={anchor: {y: 0.6}}", "trial.time_limit=20"});
  const TrialResult result = test::run(resting);
  ASSERT_EQ(result.mode_changes.size(), 2u);
  EXPECT_NEAR(run_trial_row(resting, 0).nonimpact_time, result.final_time - result.mode_changes[1].time, 1e-15);
}

// The scene in SI units is the same motion: numbers differ by the units' sizes.
TEST(TrialRow, IsInTheUnitsOfTheScene) {
  const std::string si = R"(
units: si
part: {mass: 0.1, half_width: 2.0e-3, base_distance: 1.8e-3, inertia: 6.0e-8}
slot: {clearance: 2.0e-4}
gripper: {stiffness: {x: 60, y: 4000, phi: 0.1}, pressing_force: 1.6}
base: {stiffness: {y: 3.0e+7}, damping: {y: 300}}
contacts: [edges]
excitation: {force: 8, frequency: 640}
initial: {x: 4.0e-4}
trial: {time_limit: 0.02}
)";
  const Scene scene = scene_of(si);
  const TrialResult result = test::run(scene);
  const TrialRow row = run_trial_row(scene, 0);
  const double length = 8.0 / 4000.0, time = std::sqrt(0.1 / 4000.0);
  ASSERT_GT(row.impacts[0], 0);
  EXPECT_NEAR(row.end_time / (result.final_time * time), 1.0, 1e-14);
  EXPECT_NEAR(row.end.x / (result.final_state.x * length), 1.0, 1e-14);
  EXPECT_NEAR(row.end.vy / (result.final_state.vy * length / time), 1.0, 1e-14);
  EXPECT_NEAR(row.peak_force[0] / (result.peak_force[0] * 8.0), 1.0, 1e-14);
  EXPECT_NEAR(row.first_impact[0] / (result.impact_times[0]->first * time), 1.0, 1e-14);
  // of the order of peak times duration, not of a dimensionless number
  EXPECT_LT(row.normal_impulse[0], row.peak_force[0] * row.contact_time[0]);
  EXPECT_GT(row.normal_impulse[0], 0.1 * row.peak_force[0] * row.contact_time[0]);
}

TEST(TrialRow, WithoutAStartIsRefused) {
  // tilted by more than a right angle, nothing is touched from above: no pressing force can be set
  const TrialRow row = run_trial_row(scene_of(test::plain, {"initial.x=40", "contacts=[edges]"}), 3);
  EXPECT_TRUE(row.refused);
  EXPECT_EQ(row.index, 3u);
  EXPECT_STREQ(outcome_word(row), "refused");
  EXPECT_FALSE(row.reason.empty());
}

TEST(TrialRow, OfATrialThatBreaksOffIsFailed) {
  const TrialRow row = run_trial_row(scene_of(test::plain, {"solver.step_limit=3"}), 0);
  EXPECT_FALSE(row.refused);
  EXPECT_STREQ(outcome_word(row), "failed");
  EXPECT_NE(row.reason.find("step"), std::string::npos) << row.reason;
}

// One impact of a ball in SI units: m, K, k of the gripper and of the base, dropped from h above with the sideways
// speed u over a base with friction f, which it slides on all the time.
TEST(TrialRow, HasEveryNumberInTheUnitsOfTheScene) {
  constexpr double m = 0.1, K = 4000.0, k = 4e7, h = 1e-3, f = 0.1, u = 2.0;
  Scene scene = scene_of(R"(
units: si
part: {mass: 0.1, half_width: 2.0, base_distance: 1.8e-3}
slot: {clearance: 2.0e-4}
gripper: {stiffness: {x: 0, y: 4000}, anchor: {y: 1.8e-3}}
base: {stiffness: {y: 4.0e+7}}
contacts: [edges]
friction: {coefficient: 0.1}
excitation: {force: 8, frequency: 10, direction: x}
initial: {x: 0.4, y: 2.8e-3, vx: 2.0}
trial: {time_limit: 0.01}
)");
  scene.excitations[0].amplitude = 0.0;
  scene.solver.tolerance = 1e-12;
  const TrialRow row = run_trial_row(scene, 0);
  ASSERT_EQ(row.impacts[0], 1);
  const double v = h * std::sqrt(K / m), rate = std::sqrt((k + K) / m), impulse = 2.0 * m * v * k / (k + K);
  const double fall = std::acos(0.0) * std::sqrt(m / K), contact = std::acos(-1.0) / rate;
  EXPECT_NEAR(row.end_time / 0.01, 1.0, 1e-14);
  EXPECT_NEAR(row.first_impact[0] / fall, 1.0, 1e-7);
  EXPECT_NEAR(row.last_impact[0] / fall, 1.0, 1e-7);
  EXPECT_NEAR(row.contact_time[0] / contact, 1.0, 1e-7);
  EXPECT_NEAR(row.peak_force[0] / (k * v / rate), 1.0, 1e-7);
  EXPECT_NEAR(row.normal_impulse[0] / impulse, 1.0, 1e-7);
  EXPECT_NEAR(row.friction_impulse[0] / (-f * impulse), 1.0, 1e-7);
  EXPECT_NEAR(row.impulse_x[0] / (-f * impulse), 1.0, 1e-7);
  EXPECT_NEAR(row.impulse_y[0] / impulse, 1.0, 1e-7);
  EXPECT_NEAR(row.end.vx / (u - f * impulse / m), 1.0, 1e-7);
  const double swing = (0.01 - fall - contact) * std::sqrt(K / m);
  EXPECT_NEAR(row.end.y / (1.8e-3 + h * std::sin(swing)), 1.0, 1e-6);
  EXPECT_NEAR(row.end.vy / (v * std::cos(swing)), 1.0, 1e-6);
}

// A part that only turns, undamped, in SI units: phi(t) = phi0 cos(t sqrt(k_phi/J)).
TEST(TrialRow, HasTheRateOfTheTiltInTheUnitsOfTheScene) {
  const TrialRow row = run_trial_row(scene_of(R"(
units: si
part: {mass: 0.1, half_width: 2.0e-3, base_distance: 1.8e-3, inertia: 1.0e-6}
slot: {clearance: 2.0e-4}
gripper: {stiffness: {y: 4000, phi: 0.25}, anchor: {y: 1.0, phi: 0.0}}
base: {stiffness: {y: 4.0e+7}}
contacts: [edges]
excitation: {force: 0, frequency: 10}
initial: {x: 4.0e-4, y: 1.0, phi: 0.1}
trial: {time_limit: 1.0e-3}
)"),
                                     0);
  EXPECT_NEAR(row.end.phi, 0.1 * std::cos(0.5), 1e-12);
  EXPECT_NEAR(row.end.omega, -0.1 * 500.0 * std::sin(0.5), 1e-9);
}

}  // namespace
}  // namespace vibratory_alignment
