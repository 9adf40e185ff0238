#include "verdict.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "../support/mirror.h"
#include "answer_checks.h"
#include "dice.h"
#include "mechanics/system.h"
#include "model/scene_loader.h"
#include "trace.h"

namespace vibratory_alignment::hunt {
namespace {

/// Starts that are tried: enough of them to meet a decision that rounding makes, if there is one.
constexpr int kNudges = 8;

/// A trial that makes this of its last digits says nothing of its mirror image, in which another touch may come or go.
constexpr double kChaos = 1e-5;

/// The start moved in its last digits, or by what the solver's tolerance cuts off; `part` of it, from -1 to 1.
Scene nudged(Scene s, double part) {
  const double share = part * (1e-13 + 1e-2 * s.solver.tolerance);
  s.initial.x += share * (std::abs(s.initial.x) + s.part.half_width);
  if (s.initial.y) *s.initial.y += share * (std::abs(*s.initial.y) + s.part.base_distance);
  if (s.initial.phi) *s.initial.phi += share;
  s.initial.vy += share * (std::abs(s.initial.vy) + 1.0);
  return s;
}

/// How far the trial answers to its last digits; infinite if a touch comes or goes.
double sensitivity(const System& system, const Scene& scene, const Trace& trace, Compared compared) {
  double largest = 0.0;
  for (int n = 1; n <= kNudges / 2; ++n)
    for (const double sign : {1.0, -1.0}) {
      const double part = sign * 2.0 * n / kNudges;
      largest = std::max(largest, difference(system, trace, run_trial(nudged(scene, part), false), compared));
    }
  return largest;
}

/// A trace that is to be the same as that of the trial, and how.
struct Counterpart {
  Trace trace;
  Compared compared;
  double allowed;       ///< difference
  Invariant invariant;  ///< that says so
};

/// A fault where the two are further apart than is allowed, and than starts that differ in the last digits make them.
void compare(const Scene& scene, const System& system, const Trace& trace, const Counterpart& other, Verdict& verdict) {
  const double apart = difference(system, trace, other.trace, other.compared);
  if (apart <= other.allowed) return;
  const double own = sensitivity(system, scene, trace, other.compared);
  if (own > kChaos || apart <= 100.0 * own)
    verdict.sensitive = true;
  else
    verdict.faults.push_back({other.invariant, "difference = " + std::to_string(apart)});
}

Counterpart mirror_image(const Scene& scene) {
  return {mirrored(run_trial(test::mirrored(scene), false)), Compared::places_and_rates, 1e-9 + scene.solver.tolerance,
          Invariant::mirror};
}

Counterpart by_event(Scene scene) {
  const double allowed = 1e-9 + kStepErrors * scene.solver.tolerance;
  scene.solver.name = "event";
  return {run_trial(scene, false, true), Compared::places, allowed, Invariant::methods_agree};
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
  compare(scene, system, trace, mirror_image(scene), verdict);
  if (takes_implicit_steps(scene)) compare(scene, system, trace, by_event(scene), verdict);
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
