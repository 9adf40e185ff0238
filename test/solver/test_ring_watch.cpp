// When the series follow a ring of the base in the place of implicit steps (docs/implicit_steps.md "Rings").
#include <gtest/gtest.h>

#include "solver/ring_watch.h"

namespace vibratory_alignment {
namespace {

/// Steps of the series until it is asked again whether a ring can be passed over.
int steps_until_asked(RingWatch& watch) {
  int steps = 1;
  while (!watch.asks(1.0)) ++steps;
  return steps;
}

TEST(RingWatch, the_series_follow_once_the_forces_jump_until_the_ring_can_be_passed_over) {
  RingWatch watch;
  EXPECT_FALSE(watch.series_follow());
  watch.ring();
  EXPECT_TRUE(watch.series_follow());
  EXPECT_EQ(steps_until_asked(watch), 1);
  EXPECT_TRUE(watch.series_follow());
  watch.pass_over();
  EXPECT_FALSE(watch.series_follow());
}

TEST(RingWatch, what_is_given_up_is_tried_again_less_and_less_often) {
  RingWatch watch;
  for (const int steps : {4, 8, 16}) {
    watch.give_up_implicit();
    EXPECT_TRUE(watch.series_follow());
    EXPECT_EQ(steps_until_asked(watch), steps);
    watch.pass_over();
  }
  watch.settle_implicit(false);
  watch.give_up_implicit();
  EXPECT_EQ(steps_until_asked(watch), 4);
  watch.ring();
  EXPECT_EQ(steps_until_asked(watch), 1);
}

TEST(RingWatch, an_implicit_step_in_a_ring_is_longer_than_those_of_the_series) {
  RingWatch watch;
  EXPECT_EQ(watch.bounds(10.0).longest, 10.0);
  EXPECT_EQ(watch.bounds(10.0).shortest, 0.0);
  EXPECT_FALSE(watch.bounds(10.0).passes_over);
  watch.ring();
  watch.asks(0.5);
  watch.pass_over();
  EXPECT_EQ(watch.bounds(10.0).shortest, 1.0);
  EXPECT_EQ(watch.bounds(1.0).shortest, 0.5);
  EXPECT_TRUE(watch.bounds(10.0).passes_over);
  watch.settle_implicit(false);
  EXPECT_FALSE(watch.bounds(10.0).passes_over);
}

/// Implicit steps in a row that follow the base, until the series do.
int steps_that_follow_the_base(RingWatch& watch) {
  int steps = 0;
  for (; !watch.series_follow(); ++steps) watch.settle_implicit(true);
  return steps;
}

TEST(RingWatch, implicit_steps_that_follow_the_base_hand_over_to_the_series) {
  RingWatch watch;
  EXPECT_EQ(steps_that_follow_the_base(watch), 2);
  watch.pass_over();
  EXPECT_EQ(steps_that_follow_the_base(watch), 4);
  watch.pass_over();
  watch.settle_implicit(true);
  watch.settle_implicit(false);
  EXPECT_EQ(steps_that_follow_the_base(watch), 8);
}

}  // namespace
}  // namespace vibratory_alignment
