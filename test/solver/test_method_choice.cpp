// What the solver `auto` does with its credit (docs/hybrid_step.md "Automatic"). Costs are counted in series steps of
// one sliding contact, so that a series step of length 1 has the pace 1.
#include <gtest/gtest.h>

#include "solver/method_choice.h"

namespace vibratory_alignment {
namespace {

constexpr double kFar = 1e9;

/// An implicit step costs 3.9 + 0.05 an evaluation + 4.5 a factorization: 6.
constexpr StepEffort kEffort{42, 0};

ContactStates sliding() {
  ContactStates contacts{};
  contacts[0].phase = Phase::loaded;
  contacts[0].slip = Slip::plus;
  return contacts;
}

ContactStates two_contacts() {
  ContactStates contacts = sliding();
  contacts[1] = contacts[0];
  return contacts;
}

/// So many series steps of length 1; true when an implicit step is tried after the last of them and not before.
bool tries_after(int steps, MethodChoice& choice) {
  for (int i = 0; i < steps; ++i) {
    if (choice.starts_trial()) return false;
    choice.earn();
    choice.settle_series(1.0, kFar, sliding());
  }
  return choice.starts_trial();
}

/// A choice whose first trial has just paid 50.
MethodChoice rich() {
  MethodChoice choice;
  EXPECT_TRUE(tries_after(99, choice));
  choice.settle_implicit(56.0, kFar, kEffort, sliding());
  EXPECT_TRUE(choice.implicit());
  return choice;
}

/// Implicit steps that go 1 each until they are given up.
int steps_until_dropped(MethodChoice& choice) {
  int steps = 0;
  for (; choice.implicit(); ++steps) choice.settle_implicit(1.0, kFar, kEffort, sliding());
  return steps;
}

TEST(MethodChoice, the_first_trial_has_to_be_earned) {
  MethodChoice choice;
  // -10 + 0.15 n >= 0.15 x 32
  EXPECT_TRUE(tries_after(99, choice));
}

TEST(MethodChoice, a_trial_that_is_given_up_is_paid_and_ends_implicit_steps) {
  MethodChoice choice;
  ASSERT_TRUE(tries_after(99, choice));
  choice.settle_implicit(0.0, kFar, {22, 1}, sliding());  // 4.85 - 9.5
  EXPECT_FALSE(choice.implicit());
  EXPECT_TRUE(tries_after(63, choice));  // (4.8 + 4.65)/0.15
}

TEST(MethodChoice, implicit_steps_go_on_while_there_is_credit) {
  MethodChoice choice = rich();
  EXPECT_EQ(steps_until_dropped(choice), 11);  // 54.85/5
}

TEST(MethodChoice, gains_are_saved_up_to_a_bound) {
  MethodChoice choice = rich();
  for (int i = 0; i < 100; ++i) choice.settle_implicit(56.0, kFar, kEffort, sliding());
  EXPECT_EQ(steps_until_dropped(choice), 30);  // 150/5
}

TEST(MethodChoice, a_step_cut_short_by_the_limit_may_gain_but_does_not_lose) {
  MethodChoice loser = rich(), winner = rich();
  for (int i = 0; i < 100; ++i) loser.settle_implicit(1.0, 1.0, kEffort, sliding());
  EXPECT_EQ(steps_until_dropped(loser), 11);
  winner.settle_implicit(26.0, 26.0, kEffort, sliding());
  EXPECT_EQ(steps_until_dropped(winner), 15);
}

TEST(MethodChoice, series_steps_of_two_contacts_cost_more) {
  MethodChoice choice, first;
  for (int i = 0; i < 99; ++i) {
    choice.earn();
    choice.settle_series(1.0, kFar, two_contacts());
  }
  EXPECT_DOUBLE_EQ(choice.trial_bounds(kFar).shortest, 2.0 / 2.5);
  EXPECT_DOUBLE_EQ(choice.trial_length(), 2.0 * 6.0 / 2.5);
  EXPECT_TRUE(first.starts_first(1.0, kFar, two_contacts()));
  EXPECT_DOUBLE_EQ(first.moderate_first(), 96.0 / 2.5);
}

TEST(MethodChoice, those_of_one_that_sticks_do_not) {
  ContactStates sticking = sliding();
  sticking[0].slip = Slip::stick;
  MethodChoice choice;
  EXPECT_TRUE(choice.starts_first(1.0, kFar, sticking));
  EXPECT_DOUBLE_EQ(choice.moderate_first(), 96.0);
}

TEST(MethodChoice, series_steps_cut_short_by_the_limit_say_nothing_of_their_pace) {
  MethodChoice choice;
  EXPECT_TRUE(tries_after(99, choice));
  choice.drop();
  choice.earn();
  choice.settle_series(0.1, 0.1, sliding());
  EXPECT_EQ(choice.trial_length(), 12.0);
}

TEST(MethodChoice, nothing_is_tried_where_the_series_have_gone_nowhere) {
  MethodChoice choice, first;
  for (int i = 0; i < 200; ++i) {
    EXPECT_FALSE(choice.starts_trial());
    choice.earn();
    choice.settle_series(0.0, kFar, sliding());
  }
  EXPECT_FALSE(first.starts_first(0.0, kFar, sliding()));
}

TEST(MethodChoice, a_trial_ends_after_50_evaluations) { EXPECT_EQ(MethodChoice().trial_bounds(kFar).evaluations, 50); }

TEST(MethodChoice, a_ring_that_does_not_pay_is_left_to_the_series) {
  MethodChoice choice = rich();
  choice.ring();
  EXPECT_EQ(steps_until_dropped(choice), 2);
  EXPECT_TRUE(tries_after(6, choice));
  EXPECT_EQ(steps_until_dropped(choice), 2);
  EXPECT_TRUE(tries_after(6, choice));
}

TEST(MethodChoice, a_trial_in_a_ring_that_is_given_up_is_not_repeated_so_soon) {
  MethodChoice choice = rich();
  choice.ring();
  steps_until_dropped(choice);
  ASSERT_TRUE(tries_after(6, choice));
  choice.settle_implicit(0.0, kFar, kEffort, sliding());
  EXPECT_FALSE(choice.implicit());
  EXPECT_TRUE(tries_after(32, choice));
}

TEST(MethodChoice, steps_in_the_tanh_layer_have_costs_of_their_own) {
  ContactStates layer = sliding();
  layer[0].slip = Slip::regularized;
  MethodChoice choice = rich();
  for (int i = 0; i < 100; ++i) choice.settle_implicit(1.5 + 0.27 * 40 + 3.0 + 0.01, kFar, {40, 1}, layer);
  EXPECT_EQ(steps_until_dropped(choice), 12);  // 55.85/5
}

TEST(MethodChoice, evaluations_cost_more_where_a_contact_sticks) {
  ContactStates sticking = sliding();
  sticking[0].slip = Slip::stick;
  MethodChoice choice = rich();
  for (int i = 0; i < 100; ++i) choice.settle_implicit(3.9 + 0.12 * 40 + 4.5 + 0.01, kFar, {40, 1}, sticking);
  EXPECT_EQ(steps_until_dropped(choice), 12);  // 55.85/5
}

TEST(MethodChoice, once_a_step_has_paid_the_ring_is_over) {
  MethodChoice choice = rich();
  choice.ring();
  choice.settle_implicit(1.0, kFar, kEffort, sliding());
  choice.settle_implicit(6.0, kFar, kEffort, sliding());
  EXPECT_EQ(steps_until_dropped(choice), 10);  // 49.85/5
}

TEST(MethodChoice, every_contact_has_to_last_before_a_trial) {
  MethodChoice choice = rich();
  choice.leave_contact();
  EXPECT_FALSE(choice.implicit());
  EXPECT_TRUE(tries_after(32, choice));
}

TEST(MethodChoice, the_first_step_of_a_trial_is_implicit_when_the_way_is_long) {
  MethodChoice near, far;
  EXPECT_FALSE(near.starts_first(1.0, 499.0, sliding()));
  EXPECT_TRUE(far.starts_first(1.0, 501.0, sliding()));
  EXPECT_DOUBLE_EQ(far.first_bounds(501.0).shortest, 24.0);
  EXPECT_DOUBLE_EQ(far.moderate_first(), 96.0);
}

}  // namespace
}  // namespace vibratory_alignment
