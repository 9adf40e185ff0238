// What `align accuracy` is made of: the reference, the runs beside it, and the advice that follows from them.
#include "study/accuracy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../support/hard_scene.h"
#include "model/scene_loader.h"

namespace vibratory_alignment {
namespace {

bool always() { return true; }

AccuracyRun run_of(const std::string& solver, double error, double seconds, const std::string& failure = {}) {
  AccuracyRun run;
  run.solver = solver;
  run.pose_error = error;
  run.cpu_seconds = seconds;
  run.failure = failure;
  return run;
}

TEST(Accuracy, advises_the_cheapest_run_whose_finer_ones_keep_the_error_too) {
  const std::vector<AccuracyRun> runs = {run_of("rk4", 1e-4, 1.0), run_of("rk4", 1e-2, 2.0), run_of("rk4", 1e-5, 4.0),
                                         run_of("event", 1e-5, 8.0)};
  EXPECT_EQ(cheapest_for(runs, 1e-1), &runs[0]);
  EXPECT_EQ(cheapest_for(runs, 1e-3), &runs[2]);
  EXPECT_EQ(cheapest_for(runs, 1e-6), nullptr);
  EXPECT_EQ(cheapest_for(runs, 1e-5), &runs[2]) << "at most this error";
}

// What runs into the step limit, or is left out, says nothing about errors.
TEST(Accuracy, a_finer_run_without_an_answer_does_not_speak_against_the_others) {
  const std::vector<AccuracyRun> runs = {run_of("rk4", 0.0, 0.1, "not finite"), run_of("rk4", 1e-4, 1.0),
                                         run_of("rk4", 0.0, 0.0, "step limit")};
  EXPECT_EQ(cheapest_for(runs, 1e-3), &runs[1]);
}

// `event` would take ten million steps and more where `implicit` takes some dozens.
TEST(Accuracy, the_reference_on_a_very_stiff_overdamped_base_is_by_implicit_steps) {
  Scene scene = test::hard_scene("lasting_contact");
  test::set_base(scene, 1e10, 100.0);
  scene.trial.time_limit = 1.0;
  const std::optional<AccuracyReference> reference = accuracy_reference(scene, always);
  ASSERT_TRUE(reference);
  EXPECT_EQ(reference->method, "implicit");
  EXPECT_LT(reference->agreement, 1e-9);
}

// By then the force of the touch that ends the trial has not begun.
TEST(Accuracy, what_ends_with_a_touch_is_compared_before_it) {
  const Scene scene = load_scene_file(SCENE_DIR "/insertion.yaml");
  const std::optional<AccuracyReference> reference = accuracy_reference(scene, always);
  ASSERT_TRUE(reference);
  AccuracyOptions options;
  options.solvers = {"event"};
  options.seconds_per_run = 0.0;
  const auto quiet = [](double, const AccuracyRun*) {};
  const std::vector<AccuracyRun> runs = run_accuracy_study(scene, *reference, options, always, quiet);
  ASSERT_FALSE(runs.empty());
  for (const AccuracyRun& run : runs) {
    EXPECT_LT(run.force_error, 1e-4) << run.setting;
    EXPECT_EQ(run.repetitions, 1);
    EXPECT_GT(run.cpu_seconds, 0.0);
  }
}

TEST(Accuracy, finer_runs_after_one_that_took_too_long_are_left_out) {
  const Scene scene = load_scene_file(SCENE_DIR "/fig2.yaml");
  const std::optional<AccuracyReference> reference = accuracy_reference(scene, always);
  ASSERT_TRUE(reference);
  AccuracyOptions options;
  options.solvers = {"event", "implicit"};
  options.seconds_per_run = 0.0;
  options.longest_run = 0.0;
  const auto quiet = [](double, const AccuracyRun*) {};
  for (const AccuracyRun& run : run_accuracy_study(scene, *reference, options, always, quiet))
    EXPECT_EQ(run.failure.empty(), run.setting == 1e-1) << run.solver << " " << run.setting;
}

TEST(Accuracy, ends_where_it_is_not_to_go_on) {
  const Scene scene = load_scene_file(SCENE_DIR "/fig2.yaml");
  EXPECT_FALSE(accuracy_reference(scene, [] { return false; }));
  const std::optional<AccuracyReference> reference = accuracy_reference(scene, always);
  ASSERT_TRUE(reference);
  long asked = 0;
  const auto quiet = [](double, const AccuracyRun*) {};
  EXPECT_TRUE(run_accuracy_study(
                  scene, *reference, {}, [&] { return ++asked < 1000; }, quiet)
                  .empty());
  EXPECT_EQ(asked, 1000);
}

// Against a reference that is moved by a known difference the errors are that difference: of the pose the largest of x,
// y and phi, of the force the share of the largest peak, of the duration the difference itself.
TEST(Accuracy, errors_are_the_differences_from_the_reference) {
  const Scene scene = load_scene_file(SCENE_DIR "/fig2.yaml");
  const std::optional<AccuracyReference> reference = accuracy_reference(scene, always);
  ASSERT_TRUE(reference);
  ASSERT_TRUE(reference->aligned_time);
  EXPECT_GT(reference->agreement, 0.0) << "two methods do not come to the same last digit";
  AccuracyOptions options;
  options.solvers = {"event"};
  options.seconds_per_run = 0.0;
  const auto finest_beside = [&](const AccuracyReference& moved) {
    return run_accuracy_study(scene, moved, options, always, [](double, const AccuracyRun*) {}).back();
  };
  for (double State::*coordinate : {&State::x, &State::y, &State::phi}) {
    AccuracyReference moved = *reference;
    moved.end.*coordinate += 0.25;
    EXPECT_NEAR(finest_beside(moved).pose_error, 0.25, 1e-9);
  }
  AccuracyReference moved = *reference;
  for (double& force : moved.peak_force) force *= 2.0;
  *moved.aligned_time += 0.125;
  EXPECT_NEAR(finest_beside(moved).force_error, 0.5, 1e-9);
  ASSERT_TRUE(finest_beside(moved).duration_error);
  EXPECT_NEAR(*finest_beside(moved).duration_error, 0.125, 1e-9);
  // a trial that ends before the part aligns goes on until it does
  moved = *reference;
  moved.end_time -= 1e-3;
  ASSERT_TRUE(finest_beside(moved).duration_error);
  EXPECT_LT(*finest_beside(moved).duration_error, 1e-9);
}

// Steps begin at a hundredth of the shortest excitation period, or of 2 pi where that is shorter; six more are a
// quarter of the one before each. A short trial is repeated fifty times, however little time that takes. A step so
// coarse does not close the ledger.
TEST(Accuracy, has_the_steps_and_repetitions_that_are_promised) {
  for (const double frequency : {0.5, 20.0}) {
    Scene scene = load_scene_file(SCENE_DIR "/fig2.yaml");
    scene.excitations[0].frequency = frequency;
    scene.trial.time_limit = 0.05;
    const std::optional<AccuracyReference> reference = accuracy_reference(scene, always);
    ASSERT_TRUE(reference);
    AccuracyOptions options;
    options.solvers = {"rk4"};
    const auto quiet = [](double, const AccuracyRun*) {};
    const std::vector<AccuracyRun> runs = run_accuracy_study(scene, *reference, options, always, quiet);
    ASSERT_EQ(runs.size(), 7u);
    EXPECT_NEAR(runs[0].setting, 0.01 * 2.0 * std::acos(-1.0) / std::max(1.0, frequency), 1e-15);
    for (std::size_t i = 1; i < runs.size(); ++i) EXPECT_NEAR(runs[i].setting / runs[i - 1].setting, 0.25, 1e-12);
    EXPECT_EQ(runs[0].repetitions, 50);
    EXPECT_GT(runs[0].energy_residual, 1e-9);
  }
}

}  // namespace
}  // namespace vibratory_alignment
