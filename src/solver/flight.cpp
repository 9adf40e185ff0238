#include "solver/flight.h"

namespace vibratory_alignment {

void Flight::begin(const System& system, const State& state, const DriveForms& drives, const Instant& now) {
  start_ = now;
  drives_ = drives;
  x_.begin(system.x, state.x, state.vx, 0.0);
  y_.begin(system.y, state.y, state.vy, -system.weight);
  phi_.begin(system.phi, state.phi, state.omega, 0.0);
  for (int i = 0; i < drives.count; ++i) {
    FreeMotion& axis = drives.direction[i] == Direction::x ? x_ : drives.direction[i] == Direction::y ? y_ : phi_;
    axis.add(drives.form[i]);
  }
  waves_.clear();
  FreeMotion* const axes[] = {&x_, &y_, &phi_};
  for (FreeMotion* axis : axes) axis->settle(waves_);
}

/// Inlined in both: a call costs more than axes that do not move.
VIBRATORY_ALIGNMENT_INLINE void Flight::at(double t, const Waves::Values& waves, State& state) const {
  if (x_.exact()) x_.at(t, waves, state.x, state.vx);
  if (y_.exact()) y_.at(t, waves, state.y, state.vy);
  if (phi_.exact()) phi_.at(t, waves, state.phi, state.omega);
}

void Flight::at(double t, State& state) const {
  Waves::Values waves;
  waves_.at(t, waves);
  at(t, waves, state);
}

Flight::Motion Flight::motion_at(double t, double end) const {
  Waves::Values waves;
  waves_.at(t, waves);
  State state;
  at(t, waves, state);
  return {state, x_.outlook(t, end, waves), y_.outlook(t, end, waves), phi_.outlook(t, end, waves)};
}

Load3 Flight::drive_at(double t) const {
  Load3 load;
  for (int i = 0; i < drives_.count; ++i) {
    const DriveForm& form = drives_.form[i];
    const double value = form.at(t);
    (drives_.direction[i] == Direction::x ? load.x : drives_.direction[i] == Direction::y ? load.y : load.phi) += value;
  }
  return load;
}

}  // namespace vibratory_alignment
