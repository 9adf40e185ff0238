#include "solver/flight.h"

namespace vibratory_alignment {

void Flight::begin(const State& state, const DriveForms& drives, const Instant& now) {
  start_ = now;
  drives_ = drives;
  motion_.begin(state);
  for (int i = 0; i < drives.count; ++i) motion_.add(drives.direction[i], drives.form[i]);
  motion_.settle();
}

Load3 Flight::drive_at(double t) const { return load_at(drives_, t); }

}  // namespace vibratory_alignment
