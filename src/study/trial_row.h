// What a study keeps of one trial: plain data that is the same for every run of the trial, whatever the machine's load.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <limits>
#include <string>

#include "mechanics/state.h"
#include "model/scene.h"
#include "trial/outcome.h"

namespace vibratory_alignment {

/// In the scene's own units, as results of `align trial`. Arrays are over Spot: a1, a2, b1, b2.
struct TrialRow {
  template <class Value>
  using Spots = std::array<Value, kSpotCount>;

  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  std::size_t index = 0;  ///< of the trial in its study
  bool refused = false;   ///< its scene was refused: nothing was run, all below but `reason` is void
  Outcome outcome = Outcome::running;
  std::string reason;  ///< why, when refused or failed
  Mode mode = Mode::none;
  double duration = none;  ///< of the alignment; not a number unless the part aligned
  double end_time = 0.0;
  double nonimpact_time = 0.0;  ///< during which the mode was nonimpact
  State end;
  Spots<long> impacts{};                                  ///< touches out of flight
  Spots<double> first_impact = {none, none, none, none};  ///< times; not a number without an impact there
  Spots<double> last_impact = {none, none, none, none};
  Spots<double> peak_force{};              ///< largest N
  Spots<double> normal_impulse{};          ///< integral of N
  Spots<double> friction_impulse{};        ///< integral of T, along t (MODEL.md "Contact")
  Spots<double> impulse_x{}, impulse_y{};  ///< integral of the force on the part, x right, y up
  Spots<double> contact_time{};            ///< during which a contact lasted (d > 0)
};

/// "aligned" ... "failed" as of a trial's outcome, or "refused".
const char* outcome_word(const TrialRow& row);

/// Runs the scene, without the ledger of energy. What the trial throws becomes `refused` (it has no start, its solver
/// is not in this build) or `failed`. Once `stop` is set the trial is given up, as running.
TrialRow run_trial_row(const Scene& scene, std::size_t index, const std::atomic<bool>* stop = nullptr);

/// The row of a trial whose scene was refused.
TrialRow refused_row(std::size_t index, const std::exception& error);

}  // namespace vibratory_alignment
