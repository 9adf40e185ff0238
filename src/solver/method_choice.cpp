#include "solver/method_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vibratory_alignment {
namespace {

/// A kind of contacts. Costs: of a step of the series, and of one evaluation of the forces in an implicit step; 1 is
/// the time of a series step of one sliding contact. The base rings alike, so that the series go about as far, where
/// `ring` is the same.
struct Kind {
  double series, evaluation;
  int ring;

  /// Cost of an implicit step that takes this.
  constexpr double implicit(long evaluations) const {
    constexpr double kStep = 0.85;
    return kStep + evaluation * static_cast<double>(evaluations);
  }
  constexpr double usual_implicit() const { return implicit(36); }
};

/// By the dearest law that contacts follow, and for each: one that is alone, beside others, beside others of that law
/// (which is not asked for where all slide).
/// The series have a loop of their own for one that is alone; an evaluation finds T where a contact sticks. What
/// sticking adds is softer than the base, the tanh layer is not; two that stick hold the part.
constexpr std::size_t kSlide = 0, kStick = 3, kInLayer = 6;
constexpr std::array<Kind, 9> kKind = {{{1.0, 0.052, 0},
                                        {2.1, 0.066, 1},
                                        {2.1, 0.066, 1},
                                        {1.6, 0.058, 0},
                                        {4.8, 0.13, 1},
                                        {6.1, 0.17, 2},
                                        {1.2, 0.092, 3},
                                        {2.4, 0.1, 4},
                                        {2.6, 0.165, 4}}};

/// What a power more than usual adds to the cost of a series step.
constexpr double kPower = 0.03;

/// What every series step in contact adds to what implicit steps may lose beside the series, as a share of its cost,
/// and the most that gains may be saved for later losses: the short steps after a slip event.
constexpr double kTrialShare = 0.2, kMostCredit = 130.0;

/// What a trial asks for, as a multiple of a usual implicit step; and in the tanh layer.
constexpr double kTrial = 0.8, kTrialInLayer = 1.0;

/// Length of a step that is not tried, however long it may be.
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Length of a trial at most, as a multiple of the one that would pay, and the same that an implicit step is to have
/// where it is taken again once the base rings no more.
constexpr double kTrialGain = 10.0, kResumeGain = 1.5;

/// Outside the layer an implicit step is tried early where it may become this many times as long as would pay: after so
/// many steps of the series in the same contacts, of which the last one has grown by no more than this. It begins with
/// this multiple of the length that would pay, to which the one that it may become adds its part: their mean, in
/// logarithms, with this weight.
constexpr double kEarlyGain = 6.0, kSteady = 1.02, kEarlyLength = 2.5, kEarlyReach = 0.3;
constexpr int kEarlyAfter = 4;

/// A trial that was given up is tried again with this share of the length at which it was, or with this multiple of
/// the pace.
constexpr double kRetriedShare = 0.5, kLeastRetried = 1.25;

/// Series steps before a step that goes on after a ring is tried again where it was given up; after each further time
/// twice as many, until an ordinary trial comes sooner. After a trial that was given up for another reason than its
/// length these take twice as many as well, up to the second.
constexpr int kWait = 4, kMostWait = 160;

/// Series steps to come that grow as the last one did, and how many times as long they become at most.
constexpr double kGrowingSteps = 4.0, kMostGrown = 4.0;

/// Series steps in one contact before an implicit one is tried; until their pace is known; and those whose mean it is.
constexpr int kTrialAfter = 10, kPaceKnown = 6, kPaceSteps = 32;

/// Evaluations of the forces after which an implicit step is given up: any, and a trial; in between, what there is
/// credit for. A trial in the layer, and the first one outside of it, which asks for less, is given up sooner.
constexpr long kMostEvaluations = 130, kMostTrialEvaluations = 80, kMostInLayer = 40, kMostEasyTrialEvaluations = 30;

/// Shortest trial, as a multiple of what the series go for a cost of 1.
constexpr double kShortestTrial = 1.2;

/// The same for a step that passes over a ring. It is tried where the normal forces change by this share at most in a
/// series step, and where the way that a step may go would cost the series as much as so many usual implicit steps, of
/// which it may take this share, but not less than the fewest evaluations; where next to nothing rings, so many series
/// steps are enough. A further length is tried within as much, but not after the most evaluations. For each time that
/// the way costs so many the forces may change by as much again, up to so many times; then none is after the fewest,
/// and where these cost no more than a series step they may change by any share.
constexpr double kShortestPassing = 3.0, kMostRing = 6e-2, kPassingWay = 9.0, kPassingShare = 0.2, kNoRing = 1e-9;
constexpr double kLongPassingWay = 20.0, kMostRings = 4.0;
constexpr long kFewestPassingEvaluations = 30, kMostPassingEvaluations = 100;

/// Implicit steps before the series are first asked how far they would go, and most from one such question to the next
/// (as many as before the last one).
constexpr int kFirstQuestion = 2, kMostUnasked = 32;

/// How many times as far the series go by themselves as from the end of an implicit step, whose error makes the base
/// ring; the share of a difference learned so that is believed.
constexpr double kUndisturbed = 1.25, kBelieved = 0.5;

std::size_t kind_of(const ContactStates& contacts) {
  int loaded = 0, stick = 0, in_layer = 0;
  for (const ContactState& contact : contacts) {
    if (contact.phase != Phase::loaded) continue;
    ++loaded;
    stick += contact.slip == Slip::stick;
    in_layer += contact.slip == Slip::regularized;
  }
  const std::size_t law = in_layer > 0 ? kInLayer : stick > 0 ? kStick : kSlide;
  return law + (loaded == 1 ? 0 : std::max(in_layer, stick) < 2 ? 1 : 2);
}

}  // namespace

MethodChoice::MethodChoice() { leave_to_series(kTrialAfter); }

double MethodChoice::series_cost() const { return kKind[kind_].series * (1.0 + kPower * more_powers_); }

/// 0 where it is not known. Kinds that have not been stepped yet have the one of others whose base rings alike.
double MethodChoice::pace() const {
  static_assert(kKind.size() == kKinds);
  if (paces_[kind_].steps >= kPaceKnown) return paces_[kind_].way;
  double way = 0.0;
  for (std::size_t kind = 0; kind < kKinds; ++kind)
    if (kKind[kind].ring == kKind[kind_].ring && paces_[kind].steps >= kPaceKnown)
      way = std::max(way, paces_[kind].way);
  return way;
}

/// The same for steps of the series to come: where a ring decays they grow, and go on to.
double MethodChoice::way_ahead() const {
  const double grown = way_before_ > 0.0 ? std::pow(last_way_ / way_before_, kGrowingSteps) : kUndisturbed;
  return std::max(pace(), std::clamp(grown, kUndisturbed, kMostGrown) * last_way_);
}

void MethodChoice::leave_to_series(int steps) {
  implicit_ = doubted_ = false;
  implicit_steps_ = 0;
  next_question_ = kFirstQuestion;
  series_steps_ = steps_alike_ = 0;
  last_way_ = 0.0;
  patience_ = steps;
}

void MethodChoice::look_at(const ContactStates& contacts) {
  const std::size_t kind = kind_of(contacts);
  if (kind != kind_) steps_alike_ = 0;
  kind_ = kind;
  if (implicit_ && pace() == 0.0) leave_to_series(kPaceKnown);
}

bool MethodChoice::passing_over_pays(double step, double longest, double change) const {
  if (!(step > 0.0)) return false;
  if (change <= kNoRing) return longest > kShortestPassing * step;
  // the tanh layer answers as fast as the base does, and N says nothing of that
  if (kind_ >= kInLayer) return false;
  const Kind& kind = kKind[kind_];
  const double way = longest / step * series_cost() / kind.usual_implicit();
  const bool is_cheap = kind.implicit(kFewestPassingEvaluations) <= kind.series;
  const double rings = is_cheap ? kNever : std::clamp(way / kLongPassingWay, 1.0, kMostRings);
  return way > kPassingWay && change <= rings * kMostRing;
}

void MethodChoice::start_passing_over(double step, double longest, double change) {
  paces_[kind_] = {step / series_cost(), kPaceKnown};
  constexpr double kFewest = kFewestPassingEvaluations, kMost = std::numeric_limits<int>::max();
  const double share = kPassingShare * longest / pace() / kKind[kind_].evaluation;
  most_passing_cost_ = static_cast<long>(std::clamp(share, kFewest, kMost));
  passing_cost_ =
      change > kMostRing ? kFewestPassingEvaluations : std::min(most_passing_cost_, kMostPassingEvaluations);
  implicit_ = true;
  attempt_ = Attempt::passes_over;
}

/// True when there is credit for an ordinary trial, and the series have gone for long enough.
bool MethodChoice::trial_is_due() const {
  const double needed = (kind_ < kInLayer ? kTrial : kTrialInLayer) * kKind[kind_].usual_implicit();
  return pace() > 0.0 && credit_ >= needed && ((paid_ && series_steps_ >= wait_) || series_steps_ >= patience_);
}

/// Of an ordinary trial.
double MethodChoice::shortest_trial() const {
  return trial_is_due() && series_steps_ >= patience_ ? kShortestTrial * pace() : kNever;
}

double MethodChoice::shortest_resumed() const {
  const bool may_resume = trial_is_due() && paid_ && series_steps_ >= wait_;
  return may_resume ? kResumeGain * kKind[kind_].usual_implicit() * way_ahead() : kNever;
}

/// Of a step that is tried early, whether or not an ordinary trial is due.
double MethodChoice::shortest_early() const {
  const bool is_steady = steps_alike_ >= kEarlyAfter && last_way_ <= kSteady * way_before_;
  const bool is_worth_it = kind_ < kInLayer && is_steady && series_steps_ >= wait_ && credit_ >= 0.0;
  return is_worth_it ? kEarlyGain * kKind[kind_].usual_implicit() * way_ahead() : kNever;
}

double MethodChoice::shortest_start() const {
  // where events coincide the series go nowhere, and say nothing
  if (implicit_ || !(last_way_ > 0.0)) return kNever;
  return std::min({shortest_trial(), shortest_resumed(), shortest_early()});
}

bool MethodChoice::starts(double length_over_ring, double longest) {
  const double length = std::min(length_over_ring, longest);
  const auto is_worth = [length](double shortest) { return shortest < kNever && length >= shortest; };
  if (!is_worth(shortest_start())) return false;
  const bool resumes = is_worth(shortest_resumed()), is_early = !resumes && is_worth(shortest_early());
  const bool is_easy = !resumes && !tried_ && kind_ < kInLayer;
  attempt_ = is_early ? Attempt::early_trial : is_easy ? Attempt::easy_trial : Attempt::trial;
  implicit_ = tried_ = true;
  if (resumes || is_early) paces_[kind_] = {way_ahead(), std::max(paces_[kind_].steps, kPaceKnown)};
  resumed_length_ = resumes ? length_over_ring : 0.0;
  early_reach_ = is_early ? length : 0.0;
  return true;
}

double MethodChoice::trial_length() const {
  if (resumed_length_ > 0.0) return resumed_length_;
  const double pays = kKind[kind_].usual_implicit() * pace(), early = kEarlyLength * pays;
  const double length = attempt_ != Attempt::early_trial
                            ? kTrialGain * pays
                            : early * std::pow(std::max(early_reach_ / early, 1.0), kEarlyReach);
  return retried_length_ > 0.0 ? std::min(length, std::max(retried_length_, kLeastRetried * pace())) : length;
}

StepBounds MethodChoice::bounds(double longest) const {
  const auto paid =
      std::clamp(static_cast<long>(credit_ / kKind[kind_].evaluation), kMostTrialEvaluations, kMostEvaluations);
  const bool resumes = resumed_length_ > 0.0;
  const long most = kind_ < kInLayer ? kMostTrialEvaluations : kMostInLayer;
  const double shortest = kShortestTrial * pace();
  switch (attempt_) {
    case Attempt::easy_trial: return {longest, shortest, kMostEasyTrialEvaluations, true};
    case Attempt::early_trial: return {longest, shortest, most};
    case Attempt::trial: return {longest, shortest, resumes ? paid : most, false, resumes};
    case Attempt::passes_over:
      return {longest, kShortestPassing * pace(), StepBounds::kAny, false, true, passing_cost_, most_passing_cost_};
    case Attempt::ordinary: break;
  }
  return {longest, 0.0, paid};
}

bool MethodChoice::asks_series() {
  if (!implicit_ || implicit_steps_ < next_question_) return false;
  next_question_ += std::min(next_question_, kMostUnasked);
  return true;
}

/// Implicit steps that the series outrun lose their credit, and the series learn their pace when they go.
void MethodChoice::learn_pace(double step) {
  const double way = kUndisturbed * step / series_cost(), before = pace();
  if (!(way > before) || !std::isfinite(way)) return;  // where nothing moves the series go any way
  const double now = before + kBelieved * (way - before);
  paces_[kind_] = {now, std::max(paces_[kind_].steps, kPaceKnown)};
  credit_ *= before / now;
}

void MethodChoice::earn() {
  ++series_steps_;
  credit_ = std::min(credit_ + kTrialShare * series_cost(), kMostCredit);
}

void MethodChoice::settle_series(double gone, double longest, bool event) {
  if (gone > 0.0) may_pass_over_ = false;
  steps_alike_ = event ? 0 : steps_alike_ + 1;
  if (gone == longest) return;  // cut short by a kink or the limit, it says nothing
  way_before_ = last_way_;
  last_way_ = gone / series_cost();
  Pace& pace = paces_[kind_];
  pace.steps = std::min(pace.steps + 1, kPaceSteps);
  pace.way += (gone / series_cost() - pace.way) / pace.steps;
}

void MethodChoice::settle_implicit(double gone, double longest, long evaluations, bool follows_base) {
  if (gone > 0.0) may_pass_over_ = false;
  attempt_ = Attempt::ordinary;
  retried_length_ = 0.0;
  refused_ = 0;
  ++implicit_steps_;
  const double gain = gone / pace() - kKind[kind_].implicit(evaluations);
  if (gain > 0.0) {
    paid_ = true;
    wait_ = 0;
  }
  // cut short by a kink or the limit, it has not lost; nor where the events of the start come at once
  const bool is_start = gone == 0.0 && may_pass_over_;
  if (!(gone == longest && gain < 0.0) && !is_start) book_implicit(gain);
  // as long as the base rings the next one would lose as well, and what is doubted would find the same again
  if (implicit_ && (doubted_ || (follows_base && gain < 0.0))) leave_to_series(kTrialAfter);
}

void MethodChoice::give_up_implicit(long evaluations, double length) {
  // what the question whether a ring can be passed over has cost says nothing about implicit steps
  if (attempt_ != Attempt::passes_over) book_implicit(-kKind[kind_].implicit(evaluations));
  const bool resumed = attempt_ == Attempt::trial && resumed_length_ > 0.0;
  if (resumed) wait_longer();
  // over a ring any length may be too short
  if (!resumed && attempt_ != Attempt::passes_over) retried_length_ = kRetriedShare * length;
  attempt_ = Attempt::ordinary;
  // the next one would most likely be refused for the same
  refused_ = length > 0.0 ? 0 : std::clamp(2 * refused_, kTrialAfter, kMostWait);
  wait_ = std::max(wait_, refused_);
  leave_to_series(std::max(kTrialAfter, refused_));
}

void MethodChoice::book_implicit(double gain) {
  credit_ = std::min(credit_ + gain, kMostCredit);
  if (credit_ <= 0.0) leave_to_series(kTrialAfter);
}

void MethodChoice::ring() {
  if (implicit_) leave_to_series(kTrialAfter);
  cross_layer();
}

void MethodChoice::leave_to_ring(long evaluations) {
  book_implicit(-kKind[kind_].implicit(evaluations));
  attempt_ = Attempt::ordinary;
  ring();
}

void MethodChoice::distrust() {
  may_pass_over_ = false;
  if (!implicit_) return;
  wait_longer();
  leave_to_series(kTrialAfter);
}

void MethodChoice::wait_longer() { wait_ = std::clamp(2 * wait_, kWait, kMostWait); }

void MethodChoice::cross_layer() {
  may_pass_over_ = false;
  steps_alike_ = 0;
  last_way_ = 0.0;
}

void MethodChoice::leave_contact() {
  may_pass_over_ = false;
  retried_length_ = 0.0;
  wait_ = refused_ = 0;
  paces_ = {};
  leave_to_series(kTrialAfter);
}

}  // namespace vibratory_alignment
