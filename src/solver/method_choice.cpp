#include "solver/method_choice.h"

#include <algorithm>

namespace vibratory_alignment {
namespace {

/// Costs of an implicit step: its own, of one evaluation of the forces in it and of one factorization. 1 is the time of
/// a series step of one contact. Where a contact sticks, every evaluation finds its T.
struct Cost {
  double step, evaluation, factorization;
};
constexpr Cost kCost{3.9, 0.05, 4.5}, kStickCost{3.9, 0.12, 4.5}, kLayerCost{1.5, 0.27, 3.0};

/// A usual implicit step; a series step of several contacts.
constexpr double kImplicitCost = 6.0, kGeneralSeriesCost = 2.5;

/// What every series step in contact adds to what implicit steps may lose beside the series, and the most that gains
/// may be saved for later losses: the short steps after a slip event.
constexpr double kTrialShare = 0.15, kMostCredit = 150.0;

/// Series steps in one contact before an implicit one is tried, and after a ring that had been left to the series.
constexpr int kTrialAfter = 32, kTrialAfterRing = 6;

/// Implicit steps in a ring that do not pay before it is left to the series.
constexpr int kMostLosses = 2;

/// Shortest step worth trying, as a multiple of what the series go for a cost of 1, and most evaluations of the forces
/// in the attempt.
constexpr double kShortestTrial = 2.0;
constexpr long kMostTrialEvaluations = 50;

/// The same at the very start, where nothing is known yet. There, if no ring can be passed over, a step of the length
/// kFirst is tried; but only where the way to the next kink is worth the question, which takes as long as 80 series
/// steps.
constexpr double kShortestFirst = 24.0, kFirst = 96.0, kShortestWay = 500.0;

bool any_is(Slip slip, const ContactStates& contacts) {
  return std::any_of(contacts.begin(), contacts.end(),
                     [slip](const ContactState& c) { return c.phase == Phase::loaded && c.slip == slip; });
}

/// A single contact has a loop of its own in the series.
double series_cost(const ContactStates& contacts) {
  const auto loaded =
      std::count_if(contacts.begin(), contacts.end(), [](const ContactState& c) { return c.phase == Phase::loaded; });
  return loaded == 1 ? 1.0 : kGeneralSeriesCost;
}

double implicit_cost(const StepEffort& effort, const ContactStates& contacts) {
  const Cost& cost = any_is(Slip::regularized, contacts) ? kLayerCost
                     : any_is(Slip::stick, contacts)     ? kStickCost
                                                         : kCost;
  return cost.step + cost.evaluation * static_cast<double>(effort.evaluations) +
         cost.factorization * static_cast<double>(effort.factorizations);
}

}  // namespace

bool MethodChoice::starts_first(double step, double longest, const ContactStates& contacts) {
  step = std::min(step, longest);  // at rest it has no end
  pace_ = step / series_cost(contacts);
  implicit_ = step > 0.0 && longest >= kShortestWay * step;
  return implicit_;
}

StepBounds MethodChoice::first_bounds(double longest) const { return {longest, kShortestFirst * pace_}; }

double MethodChoice::moderate_first() const { return kFirst * pace_; }

bool MethodChoice::starts_trial() {
  // where events coincide the series go nowhere, and say nothing
  if (implicit_ || series_steps_ < patience_ || credit_ < kTrialShare * kTrialAfter || pace_ == 0.0) return false;
  implicit_ = true;
  return true;
}

StepBounds MethodChoice::trial_bounds(double longest) const {
  return {longest, kShortestTrial * pace_, kMostTrialEvaluations};
}

/// Twice the length that would pay.
double MethodChoice::trial_length() const { return 2.0 * kImplicitCost * pace_; }

void MethodChoice::earn() {
  ++series_steps_;
  credit_ = std::min(credit_ + kTrialShare, kMostCredit);
}

void MethodChoice::settle_series(double gone, double longest, const ContactStates& contacts) {
  if (gone == longest) return;  // cut short by a kink or the limit, it says nothing
  const double weight = 1.0 / std::clamp(series_steps_, 1, kTrialAfter);
  pace_ += weight * (gone / series_cost(contacts) - pace_);
}

void MethodChoice::settle_implicit(double gone, double longest, const StepEffort& effort,
                                   const ContactStates& contacts) {
  const double gain = gone / pace_ - implicit_cost(effort, contacts);
  if (gone == longest && gain < 0.0) return;  // cut short by a kink or the limit, it has not lost
  credit_ = std::min(credit_ + gain, kMostCredit);
  rings_ = rings_ && gain < 0.0;
  ++losses_;
  const bool leaves_ring = rings_ && losses_ >= kMostLosses;
  patience_ = leaves_ring ? kTrialAfterRing : kTrialAfter;
  implicit_ = gone > 0.0 && credit_ > 0.0 && !leaves_ring;
  if (leaves_ring) losses_ = 0;
  if (!implicit_) series_steps_ = 0;
}

void MethodChoice::ring() {
  rings_ = true;
  losses_ = 0;
}

void MethodChoice::leave_contact() {
  implicit_ = false;
  series_steps_ = 0;
  patience_ = kTrialAfter;
}

}  // namespace vibratory_alignment
