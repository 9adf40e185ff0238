#include "solver/flight.h"

namespace vibratory_alignment {

void Flight::begin(const State& state, const DriveForms& drives, const Instant& now) {
  start_ = now;
  drives_ = drives;
  motion_.begin(state);
  for (int i = 0; i < drives.count; ++i) motion_.add(drives.direction[i], drives.form[i]);
  motion_.settle();
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
