// What is kept of one trial so that answers can be compared: the instants at which something was touched, where the
// part was at others, and the result.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "changes.h"
#include "fault.h"
#include "mechanics/system.h"
#include "model/scene.h"
#include "trial/outcome.h"

namespace vibratory_alignment::hunt {

struct Landmark {
  double time = 0.0;
  State state;
};

struct Trace {
  std::vector<Landmark> touches;  ///< the first ones, at most kMaxTouches
  bool all_touches = true;        ///< `touches` are all there were
  std::vector<State> places;      ///< at kInstants equal parts of the time limit, as long as touches are kept
  TrialResult result;
  double energy_noise = 0.0;   ///< what the ledger cannot know
  double fastest = 0.0;        ///< largest speed of the part's points: what the digits of its rates are those of
  std::optional<Fault> fault;  ///< the first breach in a segment
};

/// Largest speed of the part's points, at most.
double speed_of(const System& system, const State& state);

/// Later touches are not compared: each impact can make a difference ten times larger.
constexpr std::size_t kMaxTouches = 5;

constexpr std::size_t kInstants = 16;

/// True with the solvers whose steps leave errors up to the tolerance.
bool takes_implicit_steps(const Scene& scene);

/// Runs the trial; `checked`: every segment is held against the invariants. `uncertain` > 0: what is shorter or lower
/// than so many tolerances, times the part's size, is not seen: touches between which the part goes no farther count as
/// one, those after such a hop not at all.
Trace run_trial(const Trial& trial, bool checked, double uncertain);
inline Trace run_trial(const Trial& trial, bool checked) {
  return run_trial(trial, checked, takes_implicit_steps(trial.scene) ? 1.0 : 0.0);
}

/// Runs the trial while it is sampled at this interval, with or without its events.
TrialResult run_sampled(const Trial& trial, double interval, bool with_events);

/// All bits of the answer in one number.
std::uint64_t digest(const TrialResult& result);

}  // namespace vibratory_alignment::hunt
