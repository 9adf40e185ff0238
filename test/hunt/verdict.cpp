#include "verdict.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "../support/mirror.h"
#include "answer_checks.h"
#include "dice.h"
#include "mechanics/system.h"
#include "model/number_text.h"
#include "model/scene.h"
#include "model/scene_error.h"
#include "trace.h"

namespace vibratory_alignment::hunt {
namespace {

/// Starts that are tried: enough of them to meet a decision that rounding makes, if there is one.
constexpr int kNudges = 8;

/// Steps of what a trial is compared with, beside those that the hunt allows.
constexpr long kMoreSteps = 20;

/// A trial that makes this of its last digits says nothing of its mirror image, in which another touch may come or go.
constexpr double kChaos = 1e-5;

/// What is seen in one method's answer and not in the other's may be so many tolerances long or high.
constexpr double kUncertain = 10.0;

/// The start moved in its last digits, or by what the solver's tolerance cuts off; `part` of it, from -1 to 1. It may
/// take more steps: a trial that is refused says nothing of how far its end has moved.
Trial nudged(Trial trial, double part) {
  Scene& s = trial.scene;
  s.solver.step_limit *= kMoreSteps;
  const double share = part * (1e-13 + 1e-2 * s.solver.tolerance);
  s.initial.x += share * (std::abs(s.initial.x) + s.part.half_width);
  if (s.initial.y) *s.initial.y += share * (std::abs(*s.initial.y) + s.part.base_distance);
  if (s.initial.phi) *s.initial.phi += share;
  s.initial.vy += share * (std::abs(s.initial.vy) + 1.0);
  return trial;
}

/// Answers that are to be the same, and how.
struct Pair {
  Trace trace, other;
  double uncertain;  ///< that both were run with
  Compared compared;
  double allowed;       ///< difference
  Invariant invariant;  ///< that says so

  double apart(const System& system) const { return difference(system, trace, other, compared); }
};

/// How far the trial answers to its last digits; infinite if a touch comes or goes.
double sensitivity(const System& system, const Trial& trial, const Pair& pair) {
  double largest = 0.0;
  for (int n = 1; n <= kNudges / 2; ++n)
    for (const double sign : {1.0, -1.0}) {
      const Trace moved = run_trial(nudged(trial, sign * 2.0 * n / kNudges), false, pair.uncertain);
      largest = std::max(largest, difference(system, pair.trace, moved, pair.compared));
    }
  return largest;
}

/// A fault where the two are further apart than is allowed, and than starts that differ in the last digits make them.
void compare(const Trial& trial, const System& system, const Pair& pair, Verdict& verdict) {
  const double apart = pair.apart(system);
  if (apart <= pair.allowed) return;
  const double own = sensitivity(system, trial, pair);
  if (own > kChaos || apart <= 100.0 * own)
    verdict.sensitive = true;
  else
    verdict.faults.push_back({pair.invariant, "difference = " + number_text(rounded(apart, 3))});
}

void compare_with_mirror_image(const Trial& trial, const System& system, const Trace& trace, Verdict& verdict) {
  const bool coarse = takes_implicit_steps(trial.scene);
  const double uncertain = coarse ? 1.0 : 0.0;
  // once all motion has died out rounding says how long implicit steps are, and when that is noticed
  const Compared compared = coarse && has_settled(trace) ? Compared::places : Compared::places_and_rates;
  const Trace image = mirrored(run_trial(mirrored(trial), false));
  compare(trial, system, {trace, image, uncertain, compared, 1e-9 + trial.scene.solver.tolerance, Invariant::mirror},
          verdict);
}

/// Another way to the same motion, by other steps. A difference counts where it is there as well when more is
/// uncertain. `trace`: of the trial, run with 1 of it.
void compare_by_places(const Trial& trial, const System& system, const Trace& trace, const Trial& other,
                       Invariant invariant, Verdict& verdict) {
  const double allowed = 1e-9 + kStepErrors * trial.scene.solver.tolerance;
  const Compared compared = invariant == Invariant::same_settings ? Compared::places_but_settling : Compared::places;
  const auto pair_with = [&](const Trace& own, double uncertain) {
    return Pair{own, run_trial(other, false, uncertain), uncertain, compared, allowed, invariant};
  };
  const Pair pair = pair_with(trace, 1.0);
  if (pair.apart(system) > allowed)
    compare(trial, system, pair_with(run_trial(trial, false, kUncertain), kUncertain), verdict);
}

void compare_with_event(const Trial& trial, const System& system, const Trace& trace, Verdict& verdict) {
  Trial by_event = trial;
  by_event.scene.solver.name = "event";
  by_event.scene.solver.step_limit *= kMoreSteps;
  compare_by_places(trial, system, trace, by_event, Invariant::methods_agree, verdict);
}

/// The trial cut where it is changed, and set to what it is, is the one that is left alone; and so is it where changes
/// are made late, and cut again, the one where they are not.
void compare_with_cut(const Trial& trial, const System& system, Verdict& verdict) {
  Trial cut = trial, set = trial, late = trial;
  for (Change& change : cut.changes) change.excitations = {}, change.pressing_force = {};
  for (Change& change : set.changes) {
    change.excitations = trial.scene.excitations;
    change.pressing_force = trial.scene.gripper.pressing_force;
  }
  compare_by_places(cut, system, run_trial(cut, false, 1.0), trial.scene, Invariant::cuts, verdict);
  for (Change& change : late.changes) change.cut_late = !change.cut_late;
  compare_by_places(late, system, run_trial(late, false, 1.0), trial, Invariant::cuts, verdict);
  compare_by_places(set, system, run_trial(set, false, 1.0), trial.scene, Invariant::same_settings, verdict);
}

/// Some rate that no two scenes share.
void compare_with_sampled(const Trial& trial, const Trace& trace, Verdict& verdict) {
  Dice dice(trace.result.counts.steps);
  const double interval = trial.scene.trial.time_limit / dice.uniform(3.0, 100.0);
  if (const auto fault = check_same(trace.result, run_sampled(trial, interval, dice.chance(0.5))))
    verdict.faults.push_back(*fault);
}

void judge_trial(const Trial& trial, const System& system, Range range, Verdict& verdict) {
  const Trace trace = run_trial(trial, true);
  verdict.outcome = trace.result.outcome;
  verdict.digest = digest(trace.result);
  verdict.refusal = refusal(trace.result);
  if (trace.fault) verdict.faults.push_back(*trace.fault);
  if (const auto fault = check_ending(trace.result, range)) verdict.faults.push_back(*fault);
  if (const auto fault = check_finite(trace.result)) {
    verdict.faults.push_back(*fault);
    return;
  }
  if (const auto fault = check_energy(trial.scene, trace)) verdict.faults.push_back(*fault);
  compare_with_sampled(trial, trace, verdict);
  compare_with_mirror_image(trial, system, trace, verdict);
  if (takes_implicit_steps(trial.scene)) compare_with_event(trial, system, trace, verdict);
  if (!trial.changes.empty()) compare_with_cut(trial, system, verdict);
}

}  // namespace

bool Verdict::breaks(Invariant invariant) const {
  return std::any_of(faults.begin(), faults.end(), [&](const Fault& fault) { return fault.invariant == invariant; });
}

Verdict judge(const Trial& trial, Range range) {
  Verdict verdict;
  try {
    judge_trial(trial, make_system(trial.scene), range, verdict);
  } catch (const SceneError&) {
    verdict.has_start = false;
  } catch (const std::exception& error) {
    verdict.faults.push_back({Invariant::ends, error.what()});
  }
  return verdict;
}

}  // namespace vibratory_alignment::hunt
