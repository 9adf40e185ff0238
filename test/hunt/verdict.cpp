#include "verdict.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "../support/mirror.h"
#include "answer_checks.h"
#include "dice.h"
#include "mechanics/system.h"
#include "model/number_text.h"
#include "model/scene_loader.h"
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
Scene nudged(Scene s, double part) {
  s.solver.step_limit *= kMoreSteps;
  const double share = part * (1e-13 + 1e-2 * s.solver.tolerance);
  s.initial.x += share * (std::abs(s.initial.x) + s.part.half_width);
  if (s.initial.y) *s.initial.y += share * (std::abs(*s.initial.y) + s.part.base_distance);
  if (s.initial.phi) *s.initial.phi += share;
  s.initial.vy += share * (std::abs(s.initial.vy) + 1.0);
  return s;
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
double sensitivity(const System& system, const Scene& scene, const Pair& pair) {
  double largest = 0.0;
  for (int n = 1; n <= kNudges / 2; ++n)
    for (const double sign : {1.0, -1.0}) {
      const Trace moved = run_trial(nudged(scene, sign * 2.0 * n / kNudges), false, pair.uncertain);
      largest = std::max(largest, difference(system, pair.trace, moved, pair.compared));
    }
  return largest;
}

/// A fault where the two are further apart than is allowed, and than starts that differ in the last digits make them.
void compare(const Scene& scene, const System& system, const Pair& pair, Verdict& verdict) {
  const double apart = pair.apart(system);
  if (apart <= pair.allowed) return;
  const double own = sensitivity(system, scene, pair);
  if (own > kChaos || apart <= 100.0 * own)
    verdict.sensitive = true;
  else
    verdict.faults.push_back({pair.invariant, "difference = " + number_text(rounded(apart, 3))});
}

void compare_with_mirror_image(const Scene& scene, const System& system, const Trace& trace, Verdict& verdict) {
  const double uncertain = takes_implicit_steps(scene) ? 1.0 : 0.0;
  const Trace image = mirrored(run_trial(test::mirrored(scene), false));
  compare(scene, system,
          {trace, image, uncertain, Compared::places_and_rates, 1e-9 + scene.solver.tolerance, Invariant::mirror},
          verdict);
}

/// A difference counts where it is there as well when more is uncertain.
void compare_with_event(const Scene& scene, const System& system, const Trace& trace, Verdict& verdict) {
  Scene by_event = scene;
  by_event.solver.name = "event";
  by_event.solver.step_limit *= kMoreSteps;
  const double allowed = 1e-9 + kStepErrors * scene.solver.tolerance;
  const auto pair_with = [&](const Trace& own, double uncertain) {
    const Trace other = run_trial(by_event, false, uncertain);
    return Pair{own, other, uncertain, Compared::places, allowed, Invariant::methods_agree};
  };
  const Pair pair = pair_with(trace, 1.0);
  if (pair.apart(system) > allowed)
    compare(scene, system, pair_with(run_trial(scene, false, kUncertain), kUncertain), verdict);
}

/// Some rate that no two scenes share.
void compare_with_sampled(const Scene& scene, const Trace& trace, Verdict& verdict) {
  Dice dice(trace.result.counts.steps);
  const double interval = scene.trial.time_limit / dice.uniform(3.0, 100.0);
  if (const auto fault = check_same(trace.result, run_sampled(scene, interval, dice.chance(0.5))))
    verdict.faults.push_back(*fault);
}

void judge_trial(const Scene& scene, const System& system, Range range, Verdict& verdict) {
  const Trace trace = run_trial(scene, true);
  verdict.outcome = trace.result.outcome;
  verdict.digest = digest(trace.result);
  verdict.refusal = refusal(trace.result);
  if (trace.fault) verdict.faults.push_back(*trace.fault);
  if (const auto fault = check_ending(trace.result, range)) verdict.faults.push_back(*fault);
  if (const auto fault = check_finite(trace.result)) {
    verdict.faults.push_back(*fault);
    return;
  }
  if (const auto fault = check_energy(scene, trace)) verdict.faults.push_back(*fault);
  compare_with_sampled(scene, trace, verdict);
  compare_with_mirror_image(scene, system, trace, verdict);
  if (takes_implicit_steps(scene)) compare_with_event(scene, system, trace, verdict);
}

}  // namespace

bool Verdict::breaks(Invariant invariant) const {
  return std::any_of(faults.begin(), faults.end(), [&](const Fault& fault) { return fault.invariant == invariant; });
}

Verdict judge(const Scene& scene, Range range) {
  Verdict verdict;
  try {
    judge_trial(scene, make_system(scene), range, verdict);
  } catch (const SceneError&) {
    verdict.has_start = false;
  } catch (const std::exception& error) {
    verdict.faults.push_back({Invariant::ends, error.what()});
  }
  return verdict;
}

}  // namespace vibratory_alignment::hunt
