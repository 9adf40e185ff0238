// The checker itself: whole answers that are right pass, doctored ones do not.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../support/mirror.h"
#include "../support/scenes.h"
#include "answer_checks.h"
#include "mechanics/system.h"

namespace vibratory_alignment::hunt {
namespace {

class DoctoredAnswer : public testing::Test {
 protected:
  Scene scene_ = test::scene_of(test::plain);
  System system_ = make_system(scene_);
  Trace trace_ = run_trial(scene_, true);
};

TEST_F(DoctoredAnswer, is_found_nothing_in_before) {
  EXPECT_FALSE(trace_.fault);
  EXPECT_FALSE(check_ending(trace_.result, Range::ordinary));
  EXPECT_FALSE(check_finite(trace_.result));
  EXPECT_FALSE(check_energy(scene_, trace_));
  EXPECT_FALSE(check_same(trace_.result, run_sampled(scene_, 0.01, true)));
  EXPECT_LT(difference(system_, trace_, mirrored(run_trial(test::mirrored(scene_), false)), Compared::places_and_rates),
            1e-12);
  EXPECT_GE(trace_.touches.size(), 3u);
}

TEST_F(DoctoredAnswer, that_never_ended) {
  trace_.result.outcome = Outcome::running;
  EXPECT_TRUE(check_ending(trace_.result, Range::wild));
}

TEST_F(DoctoredAnswer, that_failed) {
  trace_.result.outcome = Outcome::failed;
  trace_.result.failure = "the step has become too short at time 1.5";
  EXPECT_EQ(refusal(trace_.result), "the step has become too short");
  EXPECT_TRUE(check_ending(trace_.result, Range::ordinary));
  EXPECT_FALSE(check_ending(trace_.result, Range::wild));
}

TEST_F(DoctoredAnswer, up_to_the_step_limit_is_a_refusal) {
  scene_.solver.step_limit = 10;
  const Trace refused = run_trial(scene_, true);
  EXPECT_EQ(refusal(refused.result), "step limit");
  EXPECT_FALSE(check_ending(refused.result, Range::ordinary));
}

TEST_F(DoctoredAnswer, with_a_number_that_is_none) {
  trace_.result.peak_force[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(check_finite(trace_.result));
}

TEST_F(DoctoredAnswer, whose_energy_comes_from_nowhere) {
  EnergyLedger& energy = *trace_.result.energy;
  energy.final += 1e-5 * energy.exchanged;
  EXPECT_EQ(check_energy(scene_, trace_)->invariant, Invariant::ledger_closes);
}

// The balance still closes, but friction feeds the motion.
TEST_F(DoctoredAnswer, whose_friction_drives) {
  EnergyLedger& energy = *trace_.result.energy;
  energy.excitation_work -= 2.0 * energy.friction_loss;
  energy.friction_loss = -energy.friction_loss;
  EXPECT_EQ(check_energy(scene_, trace_)->invariant, Invariant::losses);
}

TEST_F(DoctoredAnswer, that_is_another_in_its_last_bit) {
  TrialResult other = trace_.result;
  other.final_state.omega = std::nextafter(other.final_state.omega, 1e9);
  EXPECT_TRUE(check_same(trace_.result, other));
  other = trace_.result;
  ++other.counts.steps;
  EXPECT_TRUE(check_same(trace_.result, other));
}

TEST_F(DoctoredAnswer, that_leans_to_one_side) {
  Trace image = mirrored(run_trial(test::mirrored(scene_), false));
  image.touches.front().state.vx += 1e-6;
  EXPECT_GT(difference(system_, trace_, image, Compared::places_and_rates), 1e-7);
  EXPECT_LT(difference(system_, trace_, image, Compared::places), 1e-12);
  image = mirrored(run_trial(test::mirrored(scene_), false));
  image.touches.pop_back();
  EXPECT_EQ(difference(system_, trace_, image, Compared::places), INFINITY);
  // the unmirrored scene is not its own mirror image
  EXPECT_GT(difference(system_, trace_, mirrored(trace_), Compared::places), 1e-3);
}

TEST_F(DoctoredAnswer, that_is_elsewhere_between_its_touches) {
  Trace other = trace_;
  ASSERT_FALSE(other.places.empty());
  other.places.back().phi += 1e-6;
  EXPECT_GT(difference(system_, trace_, other, Compared::places), 1e-8);
}

// Where steps are others, a settled motion ends later or sooner; in its mirror image it does not.
TEST_F(DoctoredAnswer, that_settles_at_another_time) {
  trace_.all_touches = true;
  trace_.result.outcome = Outcome::stalled;
  Trace other = trace_;
  other.result.final_time += 0.1;
  EXPECT_EQ(difference(system_, trace_, other, Compared::places), 0.0);
  EXPECT_GT(difference(system_, trace_, other, Compared::places_and_rates), 0.01);
  // or is not seen to before the time limit, when the watch has been restarted
  other.result.outcome = Outcome::time_limit;
  EXPECT_EQ(difference(system_, trace_, other, Compared::places), INFINITY);
  EXPECT_EQ(difference(system_, trace_, other, Compared::places_but_settling), 0.0);
  other.touches.front().state.x += 1.0;
  EXPECT_GT(difference(system_, trace_, other, Compared::places_but_settling), 0.01);
}

// A time says as little as the way that the part goes in it, but no less.
TEST_F(DoctoredAnswer, that_touches_later_is_as_far_off_as_it_goes_until_then) {
  Trace other = trace_;
  State& there = other.touches.front().state;
  other.touches.front().time += 0.1;
  EXPECT_DOUBLE_EQ(difference(system_, trace_, other, Compared::places_and_rates), 0.1);
  const double size = std::abs(there.x) + std::abs(there.y) + system_.half_width + system_.base_distance;
  there.vx = 0.0;
  there.vy = -2e-3 * size;
  there.omega = 0.0;
  trace_.touches.front().state = there;
  EXPECT_NEAR(difference(system_, trace_, other, Compared::places), 2e-4, 1e-18);
  there.vy = -20.0 * size;
  EXPECT_DOUBLE_EQ(difference(system_, trace_, other, Compared::places), 0.1);
}

// Touches at once count as one only where that is asked for.
TEST_F(DoctoredAnswer, whose_touches_are_merged_tells_no_more_of_them_than_there_are) {
  EXPECT_EQ(run_trial(scene_, false, 1.0).touches.size(), trace_.touches.size());
  const Scene repeated = random_scene(2410, Range::ordinary);
  EXPECT_LT(run_trial(repeated, false, 1.0).touches.size(), run_trial(repeated, false, 0.0).touches.size());
}

}  // namespace
}  // namespace vibratory_alignment::hunt
