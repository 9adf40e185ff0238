// What a trial ends in and what is reported of it (MODEL.md "Outcome of a trial"). Dimensionless; times since the
// start.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/contact.h"
#include "mechanics/state.h"
#include "solver/solver.h"

namespace vibratory_alignment {

enum class Outcome { running, aligned, inserted, jammed, stalled, time_limit, failed };
enum class Mode { none, impact, nonimpact, mixed };

const char* to_string(Outcome outcome);
const char* to_string(Mode mode);

/// The four points of the part and base of which impacts and peak forces are reported: a1, a2, b1, b2.
enum class Spot { a1, a2, b1, b2 };
constexpr int kSpotCount = 4;
Spot spot_of(Site site);
const char* to_string(Spot spot);

/// The first touch out of flight.
struct FirstContact {
  double time = 0.0;
  Spot spot = Spot::a1;
  State state;
  double approach_speed = 0.0;  ///< d' >= 0
  double slip_velocity = 0.0;   ///< V
};

/// Of the impacts at one spot.
struct ImpactTimes {
  double first = 0.0, last = 0.0;
};

/// From `time` on the motion is in `mode` (impact or nonimpact).
struct ModeChange {
  double time = 0.0;
  Mode mode = Mode::none;
};

/// Residual of the energy ledger beyond which a motion is not to be trusted. `event`, the default solver, stays below
/// 1e-6.
constexpr double kLargestResidual = 1e-3;

/// Energy since the start (MODEL.md "Energy ledger"): where the terms `_loss` are positive they are losses.
struct EnergyLedger {
  double initial = 0.0, final = 0.0;  ///< E
  double excitation_work = 0.0;
  double gripper_loss = 0.0, base_loss = 0.0, friction_loss = 0.0;
  double release_loss = 0.0;  ///< spring energy dropped at release or run-off, minus what reloading brings back
  double turning = 0.0;       ///< gain from 1/2 (dk/dphi) phi' d^2
  double exchanged = 0.0;     ///< sum of what went in and out, the measure of the residual
  double residual = 0.0;      ///< |balance| / exchanged
};

struct TrialResult {
  std::string scene;
  Outcome outcome = Outcome::running;
  std::string failure;  ///< why, when failed
  Mode mode = Mode::none;
  std::vector<ModeChange> mode_changes;
  std::optional<double> aligned_time;  ///< the alignment duration
  double final_time = 0.0;
  State final_state;
  std::array<long, kSpotCount> impacts{};
  std::array<std::optional<ImpactTimes>, kSpotCount> impact_times;  ///< none: no impact there
  std::array<double, kSpotCount> peak_force{};
  bool force_limit_exceeded = false;
  std::optional<FirstContact> first_contact;
  std::optional<EnergyLedger> energy;
  std::string solver_name;
  double solver_tolerance = 0.0;  ///< 0 for fixed-step solvers
  double solver_step = 0.0;       ///< 0 for error-controlled solvers
  double solver_accuracy = 0.0;   ///< that was asked for; 0: none
  SolverCounts counts;
  double cpu_seconds = 0.0;  ///< processor time of the thread since the trial began
};

}  // namespace vibratory_alignment
