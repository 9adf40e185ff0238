// What the solver `auto` does with its credit (docs/automatic.md). Costs are counted in series steps of
// one sliding contact, so that a series step of length 1 has the pace 1.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "solver/method_choice.h"

namespace vibratory_alignment {
namespace {

constexpr double kFar = 1e9;

/// Length that passes over what rings, long enough for a trial, and gains nothing.
constexpr double kQuiet = 2.0;

/// A usual implicit step of one sliding contact, and its cost: 0.85, and 0.052 an evaluation.
constexpr long kEffort = 36;
constexpr double kStep = 0.85, kEvaluation = 0.052;
constexpr double kUsual = kStep + 36 * kEvaluation;
constexpr double kUsualStuck = kStep + 36 * 0.058;  ///< of one that sticks

/// What a series step adds to the credit for each 1 of its cost; the credit for a trial, and for one in the tanh layer.
constexpr double kShare = 0.2, kTrial = 0.8, kTrialInLayer = 1.0;

/// Series steps in one contact before an implicit one is tried, and the length of a trial over one that would pay.
constexpr int kTrialAfter = 10;
constexpr double kTrialGain = 10.0;

ContactStates contacts_that(std::initializer_list<Slip> slips) {
  ContactStates contacts{};
  std::size_t i = 0;
  for (const Slip slip : slips) {
    contacts[i].phase = Phase::loaded;
    contacts[i++].slip = slip;
  }
  return contacts;
}

const ContactStates kSliding = contacts_that({Slip::plus});

/// True when an implicit step is tried now, where one of this length passes over what rings.
bool starts(MethodChoice& choice, double length_over_ring, double longest = kFar) {
  return choice.starts(length_over_ring, longest);
}

void go_by_series(MethodChoice& choice, double gone = 1.0) {
  choice.earn();
  choice.settle_series(gone, kFar, false);
}

/// A series step of such contacts that goes 1; true when an implicit one was tried instead.
bool tries(MethodChoice& choice, const ContactStates& contacts = kSliding, double longest = kFar) {
  choice.look_at(contacts);
  if (starts(choice, kQuiet, longest)) return true;
  go_by_series(choice);
  return false;
}

/// Series steps of length 1 until an implicit step is tried.
int steps_until_trial(MethodChoice& choice, const ContactStates& contacts = kSliding, double longest = kFar) {
  int steps = 0;
  while (steps < 1000 && !tries(choice, contacts, longest)) ++steps;
  return steps;
}

/// So many steps are the first to reach this number.
void expect_first_from(double number, int steps) { EXPECT_NEAR(steps, number + 0.5, 0.5 + 1e-9); }

/// A choice whose first trial has just paid 20, and its credit.
MethodChoice rich() {
  MethodChoice choice;
  expect_first_from(kTrial * kUsual / kShare, steps_until_trial(choice));  // 11
  choice.settle_implicit(kUsual + 20.0, kFar, kEffort);
  EXPECT_TRUE(choice.implicit());
  return choice;
}
constexpr double kRich = 11 * kShare + 20.0;

/// Implicit steps until they are given up, each of which goes as far as a series step of this pace and so loses kLoss.
constexpr double kLoss = kUsual - 1.0;
int steps_until_dropped(MethodChoice& choice, double pace = 1.0) {
  int steps = 0;
  for (; choice.implicit(); ++steps) choice.settle_implicit(pace, kFar, kEffort);
  return steps;
}

/// What an implicit step takes where the contacts are such: one that goes farther has gained, and is taken again once a
/// ring has decayed.
double cost_of(const ContactStates& contacts, double series_cost, long effort) {
  MethodChoice choice;
  for (int i = 0; !tries(choice, contacts); ++i)
    if (i > 1000) return HUGE_VAL;
  double low = 0.0, high = 1e3;
  for (int i = 0; i < 60; ++i) {
    const double way = 0.5 * (low + high);
    MethodChoice copy = choice;
    copy.settle_implicit(way, kFar, effort);
    copy.ring();
    go_by_series(copy);
    (starts(copy, kFar) ? high : low) = way;
  }
  return high * series_cost;
}

TEST(MethodChoice, the_first_trial_has_to_be_earned_however_short_the_way) {
  for (const double longest : {10.0, kFar}) {
    MethodChoice choice;
    expect_first_from(kTrial * kUsual / kShare, steps_until_trial(choice, kSliding, longest));
  }
}

// A series step costs 1.2.
TEST(MethodChoice, a_trial_in_the_tanh_layer_has_to_be_earned_for_longer) {
  const ContactStates layer = contacts_that({Slip::regularized});
  MethodChoice choice;
  const double usual = kStep + 36 * 0.092, earned = 1.2 * kShare;
  const int first = steps_until_trial(choice, layer);
  expect_first_from(kTrialInLayer * usual / earned, first);
  choice.give_up_implicit(74, 0.0);
  const double debt = kStep + 74 * 0.092 - first * earned;
  expect_first_from((kTrialInLayer * usual + debt) / earned, steps_until_trial(choice, layer));
}

/// So many series steps of this growth in such contacts, each of which an event may end.
MethodChoice after_steps(int steps, double growth = 1.0, const ContactStates& contacts = kSliding, bool event = false) {
  MethodChoice choice;
  double way = 1.0;
  for (int i = 0; i < steps; ++i, way *= growth) {
    choice.look_at(contacts);
    choice.earn();
    choice.settle_series(way, kFar, event);
  }
  choice.look_at(contacts);
  return choice;
}

/// Series that have settled would go 1.25 times as far. Six times what would pay then is worth an early trial.
constexpr double kEarly = 6.0 * 1.25 * kUsual;

TEST(MethodChoice, a_step_that_may_be_long_is_tried_after_four_steps) {
  MethodChoice three = after_steps(3), four = after_steps(4), short_of_it = four, short_way = four;
  EXPECT_FALSE(starts(three, kFar));
  EXPECT_FALSE(starts(short_of_it, 0.99 * kEarly));
  EXPECT_FALSE(starts(short_way, kFar, 0.99 * kEarly));
  EXPECT_TRUE(starts(four, 1.01 * kEarly));
  // at first less long than another trial, which knows more, but the longer the farther it may go
  constexpr double kFirst = 2.5 * 1.25 * kUsual;
  EXPECT_DOUBLE_EQ(four.trial_length(), std::pow(kFirst, 0.7) * std::pow(1.01 * kEarly, 0.3));
  MethodChoice far = after_steps(4);
  EXPECT_TRUE(starts(far, 1e6 * kFirst));
  EXPECT_NEAR(far.trial_length(), std::pow(10.0, 1.8) * kFirst, 1e-9 * far.trial_length());
  EXPECT_DOUBLE_EQ(four.bounds(kFar).shortest, 1.2 * 1.25);
  EXPECT_EQ(four.bounds(kFar).evaluations, 80);
  EXPECT_FALSE(four.bounds(kFar).easily);
}

TEST(MethodChoice, an_early_trial_asks_for_steps_that_have_settled) {
  MethodChoice growing = after_steps(8, 1.03), settled = after_steps(8, 1.01);
  MethodChoice ended = after_steps(8, 1.0, kSliding, true);
  EXPECT_FALSE(starts(growing, kFar));
  EXPECT_TRUE(starts(settled, kFar));
  EXPECT_FALSE(starts(ended, kFar));
  MethodChoice other = after_steps(3);
  other.look_at(contacts_that({Slip::stick}));
  go_by_series(other);
  EXPECT_FALSE(starts(other, kFar));
  MethodChoice in_layer = after_steps(9, 1.0, contacts_that({Slip::regularized}));
  EXPECT_FALSE(starts(in_layer, kFar));
}

TEST(MethodChoice, an_early_trial_that_is_given_up_has_to_be_paid_back) {
  MethodChoice choice = after_steps(4);
  ASSERT_TRUE(starts(choice, kFar));
  choice.give_up_implicit(80, 0.0);
  int steps = 0;
  for (; steps < 1000 && !starts(choice, kFar); ++steps) {
    choice.look_at(kSliding);
    go_by_series(choice);
  }
  expect_first_from((kStep + 80 * kEvaluation - 4 * kShare) / kShare, steps);
}

TEST(MethodChoice, a_trial_that_is_given_up_is_paid_and_ends_implicit_steps) {
  MethodChoice choice;
  const int earned = steps_until_trial(choice);
  choice.give_up_implicit(74, 0.0);
  EXPECT_FALSE(choice.implicit());
  const double debt = kStep + 74 * kEvaluation - earned * kShare;
  EXPECT_GT(debt, 0.0);
  expect_first_from((kTrial * kUsual + debt) / kShare, steps_until_trial(choice));
}

TEST(MethodChoice, a_trial_that_is_given_up_is_tried_again_with_half_its_length) {
  MethodChoice choice;
  steps_until_trial(choice);
  ASSERT_DOUBLE_EQ(choice.trial_length(), kTrialGain * kUsual);
  const auto length_after = [&](double given_up) {
    choice.give_up_implicit(74, given_up);
    steps_until_trial(choice);
    return choice.trial_length();
  };
  EXPECT_DOUBLE_EQ(length_after(8.0), 4.0);
  EXPECT_DOUBLE_EQ(length_after(4.0), 2.0);
  EXPECT_DOUBLE_EQ(length_after(2.0), 1.25);  // more than the 1.2 that a trial has to go
  EXPECT_DOUBLE_EQ(length_after(0.0), kTrialGain * kUsual);
  EXPECT_DOUBLE_EQ(length_after(8.0), 4.0);
  MethodChoice other_contact = choice;
  choice.settle_implicit(kUsual + 20.0, kFar, kEffort);  // one has been taken
  EXPECT_DOUBLE_EQ(choice.trial_length(), kTrialGain * kUsual);
  other_contact.leave_contact();
  ASSERT_LT(steps_until_trial(other_contact), 1000);
  EXPECT_DOUBLE_EQ(other_contact.trial_length(), kTrialGain * kUsual);
}

TEST(MethodChoice, a_trial_that_is_refused_whatever_its_length_is_made_less_and_less_often) {
  MethodChoice choice = rich();
  for (const int steps : {10, 20, 40, 80, 160, 160}) {
    choice.give_up_implicit(1, 0.0);
    EXPECT_EQ(steps_until_trial(choice), steps);
  }
  choice.give_up_implicit(1, 0.0);
  MethodChoice other_contact = choice;
  other_contact.leave_contact();
  EXPECT_EQ(steps_until_trial(other_contact), kTrialAfter);
  EXPECT_EQ(steps_until_trial(choice), 160);
  choice.give_up_implicit(1, 8.0);  // for its length
  EXPECT_EQ(steps_until_trial(choice), kTrialAfter);
  choice.give_up_implicit(1, 0.0);
  EXPECT_EQ(steps_until_trial(choice), 10);
}

// A long step, which would be tried early, after four steps of the series, has to wait as well.
TEST(MethodChoice, refusals_are_forgotten_when_a_step_is_taken_or_nothing_touches) {
  const auto steps_until_early = [](MethodChoice& choice) {
    choice.look_at(kSliding);
    int steps = 0;
    for (; steps < 1000 && !starts(choice, kFar); ++steps) go_by_series(choice);
    return steps;
  };
  MethodChoice refused = after_steps(4);
  ASSERT_TRUE(starts(refused, kFar));
  for (const int steps : {10, 20, 40}) {
    refused.give_up_implicit(1, 0.0);
    EXPECT_EQ(steps_until_early(refused), steps);
  }
  MethodChoice taken = refused, left = refused;
  taken.settle_implicit(2.0 * kEarly, kFar, kEffort);
  taken.give_up_implicit(1, 0.0);
  EXPECT_EQ(steps_until_early(taken), 10);
  left.leave_contact();
  EXPECT_EQ(steps_until_early(left), 4);
  left.give_up_implicit(1, 0.0);
  EXPECT_EQ(steps_until_early(left), 10);
}

// There a shorter one has the larger error.
TEST(MethodChoice, a_step_that_was_to_pass_over_a_ring_says_nothing_of_shorter_ones) {
  MethodChoice choice = rich();
  choice.ring();
  go_by_series(choice);
  ASSERT_TRUE(starts(choice, kFar));
  choice.give_up_implicit(kEffort, 8.0);
  int steps = 0;
  for (; steps < 1000 && !starts(choice, kQuiet); ++steps) go_by_series(choice);
  EXPECT_EQ(steps, kTrialAfter);
  EXPECT_GE(choice.trial_length(), kTrialGain * kUsual);
}

TEST(MethodChoice, a_step_with_an_event_at_once_is_paid_but_not_given_up) {
  MethodChoice choice = rich();
  choice.settle_implicit(0.0, kFar, kEffort);
  EXPECT_TRUE(choice.implicit());
  expect_first_from((kRich - kUsual) / kLoss, steps_until_dropped(choice));
  MethodChoice start;
  start.look_at(kSliding);
  start.start_passing_over(1.0, kFar, 0.0);
  start.settle_implicit(0.0, kFar, kEffort);
  EXPECT_TRUE(start.may_pass_over());
}

TEST(MethodChoice, implicit_steps_go_on_while_there_is_credit) {
  MethodChoice choice = rich();
  expect_first_from(kRich / kLoss, steps_until_dropped(choice));
}

TEST(MethodChoice, gains_are_saved_up_to_a_bound) {
  MethodChoice choice = rich();
  for (int i = 0; i < 100; ++i) choice.settle_implicit(kUsual + 50.0, kFar, kEffort);
  expect_first_from(130.0 / kLoss, steps_until_dropped(choice));
}

TEST(MethodChoice, a_step_cut_short_by_the_limit_may_gain_but_does_not_lose) {
  MethodChoice loser = rich(), winner = rich();
  for (int i = 0; i < 100; ++i) loser.settle_implicit(1.0, 1.0, kEffort);
  expect_first_from(kRich / kLoss, steps_until_dropped(loser));
  winner.settle_implicit(kUsual + 5.0, kUsual + 5.0, kEffort);
  expect_first_from((kRich + 5.0) / kLoss, steps_until_dropped(winner));
}

TEST(MethodChoice, a_trial_has_ten_times_the_length_that_would_pay_at_most) {
  MethodChoice choice = rich();
  EXPECT_DOUBLE_EQ(choice.trial_length(), kTrialGain * kUsual);
}

TEST(MethodChoice, a_trial_is_given_up_sooner_than_other_implicit_steps) {
  MethodChoice choice, in_layer;
  const auto expect_trial = [](const MethodChoice& tried, double shortest, long evaluations, bool easily) {
    EXPECT_EQ(tried.bounds(kFar).longest, kFar);
    EXPECT_DOUBLE_EQ(tried.bounds(kFar).shortest, shortest);
    EXPECT_EQ(tried.bounds(kFar).evaluations, evaluations);
    EXPECT_EQ(tried.bounds(kFar).easily, easily);
  };
  ASSERT_LT(steps_until_trial(choice), 100);
  expect_trial(choice, 1.2, 30, true);
  choice.give_up_implicit(kEffort, 0.0);
  ASSERT_LT(steps_until_trial(choice), 100);
  expect_trial(choice, 1.2, 80, false);
  ASSERT_LT(steps_until_trial(in_layer, contacts_that({Slip::regularized})), 200);
  expect_trial(in_layer, 1.2 / 1.2, 40, false);
  choice.settle_implicit(kUsual + 50.0, kFar, kEffort);
  ASSERT_TRUE(choice.implicit());
  EXPECT_EQ(choice.bounds(kFar).longest, kFar);
  EXPECT_EQ(choice.bounds(kFar).shortest, 0.0);
  EXPECT_EQ(choice.bounds(kFar).evaluations, 130);
}

// A series step that costs s and goes 1 has the pace 1/s; a trial of a usual implicit step of cost c is 10 c/s long.
TEST(MethodChoice, costs_follow_the_laws_of_the_contacts) {
  struct Kind {
    std::initializer_list<Slip> slips;
    double series, evaluation;
  };
  constexpr Slip plus = Slip::plus, minus = Slip::minus, stick = Slip::stick, layer = Slip::regularized;
  const Kind kinds[] = {{{plus}, 1.0, 0.052},       {{plus, minus}, 2.1, 0.066}, {{stick}, 1.6, 0.058},
                        {{stick, plus}, 4.8, 0.13}, {{stick, stick}, 6.1, 0.17}, {{layer}, 1.2, 0.092},
                        {{layer, minus}, 2.4, 0.1}, {{layer, layer}, 2.6, 0.165}};
  for (const Kind& kind : kinds) {
    const ContactStates contacts = contacts_that(kind.slips);
    MethodChoice choice;
    for (int i = 0; i < 500 && !tries(choice, contacts); ++i) {
    }
    EXPECT_NEAR(choice.trial_length(), kTrialGain * (kStep + 36 * kind.evaluation) / kind.series, 1e-12);
    EXPECT_NEAR(cost_of(contacts, kind.series, 40), kStep + 40 * kind.evaluation, 1e-9);
  }
}

TEST(MethodChoice, an_implicit_step_is_given_up_when_it_has_taken_the_credit) {
  MethodChoice choice = rich();
  double credit = kRich;
  for (; choice.implicit(); credit -= kLoss) {
    EXPECT_EQ(choice.bounds(kFar).evaluations, std::clamp(static_cast<long>(credit / kEvaluation), 80L, 130L));
    choice.settle_implicit(1.0, kFar, kEffort);
  }
  EXPECT_LT(credit / kEvaluation, 80.0);  // all three have been seen
}

TEST(MethodChoice, series_steps_cut_short_by_the_limit_say_nothing_of_their_pace) {
  MethodChoice choice;
  for (int i = 0; i < 40; ++i) tries(choice);
  choice.earn();
  choice.settle_series(0.1, 0.1, false);
  EXPECT_DOUBLE_EQ(choice.trial_length(), kTrialGain * kUsual);
}

TEST(MethodChoice, nothing_is_tried_where_the_series_have_gone_nowhere) {
  MethodChoice choice;
  for (int i = 0; i < 200; ++i) {
    choice.look_at(kSliding);
    EXPECT_FALSE(starts(choice, kFar));
    go_by_series(choice, 0.0);
  }
}

TEST(MethodChoice, nothing_is_tried_while_no_step_passes_over_what_rings) {
  MethodChoice choice;
  for (int i = 0; i < 200; ++i) {
    choice.look_at(kSliding);
    EXPECT_FALSE(starts(choice, 0.0));
    go_by_series(choice);
  }
  EXPECT_TRUE(starts(choice, kQuiet));
}

TEST(MethodChoice, nothing_is_tried_where_only_what_is_too_short_passes_over_what_rings) {
  MethodChoice choice;
  for (int i = 0; i < 200; ++i) {
    choice.look_at(kSliding);
    EXPECT_FALSE(starts(choice, 1.19));
    EXPECT_FALSE(starts(choice, kFar, 1.19));
    go_by_series(choice);
  }
  EXPECT_TRUE(starts(choice, 1.21));
}

TEST(MethodChoice, a_ring_is_left_to_the_series_at_once) {
  MethodChoice choice = rich();
  choice.ring();
  EXPECT_FALSE(choice.implicit());
  EXPECT_EQ(steps_until_trial(choice), kTrialAfter);
}

TEST(MethodChoice, events_that_undo_each_other_are_left_to_the_series) {
  MethodChoice choice = rich();
  choice.distrust();
  EXPECT_FALSE(choice.implicit());
  go_by_series(choice);
  EXPECT_FALSE(starts(choice, kQuiet));
}

TEST(MethodChoice, a_ring_that_an_implicit_step_follows_at_a_loss_is_left_to_the_series) {
  MethodChoice gains = rich(), loses = rich(), passes = rich();
  gains.settle_implicit(1.01 * kUsual, kFar, kEffort, true);
  EXPECT_TRUE(gains.implicit());
  passes.settle_implicit(0.99 * kUsual, kFar, kEffort, false);
  EXPECT_TRUE(passes.implicit());
  loses.settle_implicit(0.99 * kUsual, kFar, kEffort, true);
  EXPECT_FALSE(loses.implicit());
  go_by_series(loses);  // as after a kink
  EXPECT_FALSE(starts(loses, 0.0));
  EXPECT_TRUE(starts(loses, kFar));
}

// One that has paid goes on after a single series step, if it is to be 1.5 times as long as would pay; the series would
// go 1.25 times as far as they did in the ring.
TEST(MethodChoice, implicit_steps_that_have_paid_go_on_as_soon_as_the_ring_is_passed_over) {
  constexpr double kPays = 1.5 * 1.25 * kUsual;
  MethodChoice choice = rich();
  choice.ring();
  EXPECT_FALSE(starts(choice, kFar));  // no step shows the ring
  go_by_series(choice);
  EXPECT_FALSE(starts(choice, 0.0));
  EXPECT_FALSE(starts(choice, 0.99 * kPays));
  EXPECT_FALSE(starts(choice, kFar, 0.99 * kPays));
  EXPECT_TRUE(starts(choice, 1.01 * kPays));
  EXPECT_TRUE(choice.implicit());
  EXPECT_DOUBLE_EQ(choice.trial_length(), 1.01 * kPays);
  EXPECT_TRUE(choice.bounds(kFar).passes_over);
  EXPECT_EQ(choice.bounds(kFar).evaluations, 130);  // what the credit pays, not a trial's 80
}

// Steps that grow from 1 to r go on to r^4 r, at most to 4 r.
TEST(MethodChoice, steps_of_the_series_that_grow_while_a_ring_decays_are_expected_to_go_on) {
  for (const auto& [growth, way] : {std::pair{1.0, 1.25}, {1.2, std::pow(1.2, 5)}, {2.0, 8.0}}) {
    MethodChoice choice = rich();
    choice.ring();
    go_by_series(choice);
    go_by_series(choice, growth);
    const double pays = 1.5 * kUsual * way;
    EXPECT_FALSE(starts(choice, 0.99 * pays)) << growth;
    EXPECT_TRUE(starts(choice, 1.01 * pays)) << growth;
  }
}

// What it asks for is what it takes: an ordinary trial, one that goes on after a ring, an early one.
TEST(MethodChoice, the_shortest_step_that_starts_is_known_beforehand) {
  MethodChoice first, after_ring = rich(), early;
  steps_until_trial(first);
  EXPECT_EQ(first.shortest_start(), HUGE_VAL);  // one is due
  first.give_up_implicit(kEffort, 0.0);
  while (first.shortest_start() == HUGE_VAL) go_by_series(first);
  after_ring.ring();
  EXPECT_EQ(after_ring.shortest_start(), HUGE_VAL);  // no step shows the ring
  go_by_series(after_ring);
  early.look_at(kSliding);
  for (int i = 0; i < 4; ++i) go_by_series(early);
  for (const MethodChoice& choice : {first, after_ring, early}) {
    const double least = choice.shortest_start();
    ASSERT_LT(least, HUGE_VAL);
    MethodChoice shorter = choice, as_long = choice;
    EXPECT_FALSE(starts(shorter, (1.0 - 1e-9) * least));
    EXPECT_TRUE(starts(as_long, least));
  }
}

// From ten series steps on an ordinary trial may be as short as 1.2; the other is worth it as before.
TEST(MethodChoice, the_step_that_goes_on_after_a_ring_is_known_however_long_the_ring) {
  MethodChoice choice = rich();
  choice.ring();
  for (int i = 0; i < 2 * kTrialAfter; ++i) {
    go_by_series(choice);
    EXPECT_NEAR(choice.shortest_resumed(), 1.5 * 1.25 * kUsual, 1e-9) << i;
  }
  EXPECT_NEAR(choice.shortest_start(), 1.2, 1e-9);
  EXPECT_TRUE(starts(choice, 1.01 * 1.5 * 1.25 * kUsual));
  EXPECT_TRUE(choice.bounds(kFar).passes_over);
}

TEST(MethodChoice, what_is_given_up_after_a_ring_is_tried_again_less_and_less_often) {
  MethodChoice choice = rich();
  const auto steps_until_resumed = [&] {
    int steps = 0;
    for (; steps < 1000 && !starts(choice, kFar); ++steps) go_by_series(choice);
    return steps;
  };
  choice.ring();
  EXPECT_EQ(steps_until_resumed(), 1);
  for (const int steps : {4, 8, kTrialAfter}) {
    choice.give_up_implicit(kEffort, 8.0);
    EXPECT_EQ(steps_until_resumed(), steps);
  }
  choice.settle_implicit(1.0, kFar, kEffort);  // taken, but at a loss
  choice.ring();
  EXPECT_EQ(steps_until_resumed(), kTrialAfter);
  choice.settle_implicit(2.0 * kUsual, kFar, kEffort);
  choice.ring();
  EXPECT_EQ(steps_until_resumed(), 1);
  choice.distrust();
  EXPECT_EQ(steps_until_resumed(), 4);
}

TEST(MethodChoice, implicit_steps_that_have_not_paid_have_to_wait) {
  MethodChoice choice;
  steps_until_trial(choice);
  choice.settle_implicit(kUsual - 1.0, kFar, kEffort);
  choice.ring();
  int steps = 0;
  for (; steps < 1000 && !starts(choice, 0.9 * kEarly); ++steps) go_by_series(choice);
  EXPECT_EQ(steps, kTrialAfter);
}

// Where nothing moves they go any way, which is no pace.
TEST(MethodChoice, series_that_go_any_way_say_nothing) {
  MethodChoice asked = rich(), not_asked = rich();
  asked.learn_pace(HUGE_VAL);
  EXPECT_EQ(steps_until_dropped(asked), steps_until_dropped(not_asked));
}

TEST(MethodChoice, the_series_are_asked_less_and_less_often) {
  MethodChoice choice;
  EXPECT_FALSE(choice.asks_series());
  choice = rich();  // after one implicit step
  std::vector<int> asked;
  for (int steps = 1; steps < 200; ++steps) {
    if (choice.asks_series()) asked.push_back(steps);
    choice.settle_implicit(kUsual, kFar, kEffort);
  }
  EXPECT_EQ(asked, (std::vector<int>{2, 4, 8, 16, 32, 64, 96, 128, 160, 192}));
}

// They would go 1.25 x 8 = 10, of which half is believed: 1 + (10 - 1)/2. The credit shrinks by as much.
TEST(MethodChoice, a_faster_pace_of_the_series_is_learned_and_costs_credit) {
  MethodChoice faster = rich(), little_faster = rich();
  faster.learn_pace(8.0);
  EXPECT_DOUBLE_EQ(faster.trial_length(), 5.5 * kTrialGain * kUsual);
  expect_first_from(kRich / 5.5 / kLoss, steps_until_dropped(faster, 5.5));
  little_faster.learn_pace(0.88);
  EXPECT_DOUBLE_EQ(little_faster.trial_length(), 1.05 * kTrialGain * kUsual);
  expect_first_from(kRich / 1.05 / kLoss, steps_until_dropped(little_faster, 1.05));
}

TEST(MethodChoice, a_slower_pace_is_only_learned_from_steps_of_the_series) {
  MethodChoice choice = rich();
  choice.learn_pace(0.7);  // x 1.25 < 1
  EXPECT_DOUBLE_EQ(choice.trial_length(), kTrialGain * kUsual);
  expect_first_from(kRich / kLoss, steps_until_dropped(choice));
}

TEST(MethodChoice, what_is_learned_of_one_law_is_of_that_law) {
  MethodChoice choice = rich();
  choice.look_at(contacts_that({Slip::stick}));
  choice.learn_pace(12.8);  // 1.25 x 12.8/1.6 = 10
  EXPECT_DOUBLE_EQ(choice.trial_length(), 5.5 * kTrialGain * kUsualStuck);
  choice.look_at(kSliding);
  EXPECT_DOUBLE_EQ(choice.trial_length(), kTrialGain * kUsual);
}

TEST(MethodChoice, every_contact_has_to_last_before_a_trial) {
  MethodChoice choice = rich();
  choice.leave_contact();
  EXPECT_FALSE(choice.implicit());
  EXPECT_EQ(steps_until_trial(choice), kTrialAfter);
}

TEST(MethodChoice, every_contact_has_a_pace_of_its_own) {
  MethodChoice choice = rich();
  choice.leave_contact();
  choice.look_at(kSliding);
  int steps = 0;
  for (; steps < 1000 && !starts(choice, 2.0 * kQuiet); ++steps) go_by_series(choice, 2.0);
  EXPECT_EQ(steps, kTrialAfter);
  EXPECT_DOUBLE_EQ(choice.trial_length(), 2.0 * kTrialGain * kUsual);
}

TEST(MethodChoice, another_number_of_contacts_has_a_pace_of_its_own) {
  MethodChoice choice = rich();
  const ContactStates two = contacts_that({Slip::plus, Slip::plus});
  choice.look_at(two);
  EXPECT_FALSE(choice.implicit());
  EXPECT_EQ(steps_until_trial(choice, two), 6);
  choice.look_at(kSliding);  // whose pace is still known
  EXPECT_TRUE(choice.implicit());
  EXPECT_DOUBLE_EQ(choice.trial_length(), kTrialGain * kUsual);
}

TEST(MethodChoice, a_contact_that_begins_to_stick_goes_on_at_the_pace_of_the_one_that_slid) {
  MethodChoice choice = rich();
  choice.look_at(contacts_that({Slip::stick}));
  EXPECT_TRUE(choice.implicit());
  EXPECT_DOUBLE_EQ(choice.trial_length(), kTrialGain * kUsualStuck);
}

TEST(MethodChoice, the_tanh_layer_is_stiffer_than_what_slides) {
  MethodChoice choice = rich();
  choice.look_at(contacts_that({Slip::regularized}));
  EXPECT_FALSE(choice.implicit());
}

/// A choice at the first step of a trial.
MethodChoice fresh() {
  MethodChoice choice;
  choice.look_at(kSliding);
  return choice;
}

TEST(MethodChoice, a_ring_is_passed_over_at_the_start_alone) {
  MethodChoice flown = fresh(), kinked = fresh(), begun = fresh();
  flown.leave_contact();
  EXPECT_FALSE(flown.may_pass_over());
  kinked.ring();
  EXPECT_FALSE(kinked.may_pass_over());
  go_by_series(begun, 0.0);  // what sticks has been found to slip
  EXPECT_TRUE(begun.may_pass_over());
  begun.settle_series(1.0, kFar, false);
  EXPECT_FALSE(begun.may_pass_over());
}

/// A choice that is about to pass over a ring, where the series go 1.
MethodChoice passing(double longest = kFar, double change = 0.0) {
  MethodChoice choice = fresh();
  choice.start_passing_over(1.0, longest, change);
  return choice;
}

TEST(MethodChoice, a_ring_that_has_been_passed_over_is_so_once) {
  MethodChoice choice = passing();
  choice.settle_implicit(400.0, 501.0, kEffort);
  EXPECT_TRUE(choice.implicit());
  EXPECT_FALSE(choice.may_pass_over());
}

TEST(MethodChoice, a_ring_whose_steps_undo_each_other_is_not_passed_over) {
  MethodChoice choice = passing();
  choice.settle_implicit(0.0, 501.0, kEffort);
  EXPECT_TRUE(choice.may_pass_over());
  choice.distrust();
  EXPECT_FALSE(choice.may_pass_over());
}

// The next one, after a ring, goes on where that has paid, and is none of the easy ones.
TEST(MethodChoice, a_step_that_has_passed_over_a_ring_has_paid) {
  MethodChoice choice = passing();
  choice.settle_implicit(400.0, 501.0, kEffort);
  choice.ring();
  go_by_series(choice);
  ASSERT_TRUE(starts(choice, kFar));
  EXPECT_TRUE(choice.bounds(kFar).passes_over);
  EXPECT_FALSE(choice.bounds(kFar).easily);
}

TEST(MethodChoice, a_ring_is_passed_over_where_it_is_small_and_the_way_is_long) {
  constexpr double kWay = 9.0 * kUsual;
  EXPECT_TRUE(fresh().passing_over_pays(1.0, 1.01 * kWay, 5.9e-2));
  EXPECT_FALSE(fresh().passing_over_pays(1.0, 1.01 * kWay, 6.1e-2));
  EXPECT_FALSE(fresh().passing_over_pays(1.0, 0.99 * kWay, 5.9e-2));
  EXPECT_TRUE(fresh().passing_over_pays(1.0, 3.1, 1e-10));
  EXPECT_FALSE(fresh().passing_over_pays(1.0, 2.9, 1e-10));
  EXPECT_FALSE(fresh().passing_over_pays(0.0, kFar, 1e-10));
}

// Two that stick: a series step costs 6.6, a usual implicit one 0.85 and 36 times 0.17.
TEST(MethodChoice, the_way_over_a_ring_is_measured_by_what_it_costs_the_series) {
  MethodChoice choice;
  choice.look_at(contacts_that({Slip::stick, Slip::stick}));
  constexpr double kWay = 9.0 * (kStep + 36 * 0.17) / 6.1;
  EXPECT_TRUE(choice.passing_over_pays(1.0, 1.01 * kWay, 5.9e-2));
  EXPECT_FALSE(choice.passing_over_pays(1.0, 0.99 * kWay, 5.9e-2));
}

// But 30 evaluations; and after 100 no further length is tried.
TEST(MethodChoice, a_ring_may_take_a_fifth_of_what_the_way_costs_the_series) {
  constexpr long kFifth = static_cast<long>(5.0 / kEvaluation),
                 kTen = static_cast<long>(50.0 / kEvaluation);  // 96, 961
  constexpr long kMost = std::numeric_limits<int>::max();
  for (const auto& [way, of_all, of_first_ones] :
       {std::tuple{25.0, kFifth, kFifth}, {4.0, 30L, 30L}, {250.0, kTen, 100L}, {HUGE_VAL, kMost, 100L}}) {
    EXPECT_EQ(passing(way).bounds(kFar).most_cost, of_all) << way;
    EXPECT_EQ(passing(way).bounds(kFar).cost, of_first_ones) << way;
  }
}

// For each 20 usual steps that the way costs by 0.06 more, four times that at most; it is soon given up then.
TEST(MethodChoice, a_larger_ring_is_passed_over_where_the_way_is_longer) {
  for (const auto& [way, change] : {std::pair{20.0, 0.06}, {30.0, 0.09}, {80.0, 0.24}, {1e6, 0.24}}) {
    const double longest = 1.001 * way * kUsual;
    EXPECT_TRUE(fresh().passing_over_pays(1.0, longest, change)) << way;
    EXPECT_FALSE(fresh().passing_over_pays(1.0, longest, 1.01 * change)) << way;
  }
  // where a series step costs more than 30 evaluations a ring of any size is
  for (const Slip other : {Slip::stick, Slip::plus}) {
    MethodChoice beside_stick;
    beside_stick.look_at(contacts_that({Slip::stick, other}));
    EXPECT_TRUE(beside_stick.passing_over_pays(1.0, 1e3, 100.0));
  }
  MethodChoice sliding;
  sliding.look_at(contacts_that({Slip::plus, Slip::plus}));
  EXPECT_FALSE(sliding.passing_over_pays(1.0, 1e3, 100.0));
  EXPECT_EQ(passing(kFar, 0.06).bounds(kFar).cost, 100);
  EXPECT_EQ(passing(kFar, 0.061).bounds(kFar).cost, 30);
  EXPECT_GT(passing(kFar, 0.061).bounds(kFar).most_cost, 1000);
}

TEST(MethodChoice, in_the_tanh_layer_only_what_hardly_rings_is_passed_over) {
  for (const Slip other : {Slip::regularized, Slip::stick, Slip::plus}) {
    MethodChoice choice;
    choice.look_at(contacts_that({Slip::regularized, other}));
    EXPECT_FALSE(choice.passing_over_pays(1.0, kFar, 2e-9));
    EXPECT_TRUE(choice.passing_over_pays(1.0, kFar, 1e-10));
  }
}

TEST(MethodChoice, a_ring_is_passed_over_by_a_long_step_or_soon_given_up) {
  const StepBounds bounds = passing().bounds(501.0);
  EXPECT_EQ(bounds.longest, 501.0);
  EXPECT_DOUBLE_EQ(bounds.shortest, 3.0);
  EXPECT_EQ(bounds.cost, 100);
  EXPECT_TRUE(bounds.passes_over);
  EXPECT_FALSE(bounds.easily);
}

// Contacts that find their states at the start are none that a step could have gone by.
TEST(MethodChoice, events_at_the_start_are_not_paid_for) {
  MethodChoice choice = passing();
  for (int i = 0; i < 4; ++i) choice.settle_implicit(0.0, kFar, 1000);
  EXPECT_TRUE(choice.implicit());
  choice.settle_implicit(1.0, kFar, 1000);
  EXPECT_FALSE(choice.implicit());
}

TEST(MethodChoice, other_implicit_steps_take_the_trouble) {
  MethodChoice choice = passing();
  choice.settle_implicit(400.0, 501.0, kEffort);
  EXPECT_FALSE(choice.bounds(501.0).easily);
}

TEST(MethodChoice, what_is_not_passed_over_is_not_paid) {
  MethodChoice choice = passing();
  choice.give_up_implicit(2000, 2.0);
  EXPECT_FALSE(choice.implicit());
  expect_first_from(kTrial * kUsual / kShare, steps_until_trial(choice));
  EXPECT_DOUBLE_EQ(choice.trial_length(), kTrialGain * kUsual);  // nor says anything of shorter steps
}

}  // namespace
}  // namespace vibratory_alignment
