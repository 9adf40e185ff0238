// A flight: the part moves freely, in closed form, from release to the next touch.
#pragma once

#include "mechanics/free_motion.h"
#include "solver/motion_series.h"

namespace vibratory_alignment {

class Flight {
 public:
  Flight(const System& system, std::size_t drive_count) : motion_(system, drive_count) {}

  [[gnu::noinline]] void begin(const State& state, const DriveForms& drives, const Instant& now);

  const Instant& start() const { return start_; }
  /// True where the closed form holds to roundoff in every coordinate.
  bool exact() const { return motion_.exact(); }

  /// State at time t since the start of the flight. Coordinates without exact closed form are left as they are in
  /// `state`.
  [[gnu::noinline]] void at(double t, State& state) const { motion_.at(t, state); }

  /// State and accelerations x'', y'', phi'' at a time since the start of an exact flight, and bounds on the absolute
  /// values of the derivatives of the coordinates from then on.
  struct Motion {
    State state;
    FreeMotion::Outlook outlook;
  };
  /// The motion at time t, with bounds until `end`.
  [[gnu::noinline]] void motion_at(double t, double end, Motion& motion) const {
    motion_.at(t, end, motion.state, motion.outlook);
  }

  /// Forces of the excitations at time t since the start of the flight.
  Load3 drive_at(double t) const;

  /// Fastest rate in the motion from time t since the start of the flight on, rad per unit of time.
  double rate(double t) const { return motion_.rate(t); }

  /// Rate that a power series of the flight has to follow.
  double series_rate() const { return motion_.series_rate(); }

 private:
  Instant start_;
  FreeMotion motion_;
  DriveForms drives_;
};

}  // namespace vibratory_alignment
