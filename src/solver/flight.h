// A flight: the part moves freely, in closed form, from release to the next touch.
#pragma once

#include <algorithm>

#include "mechanics/free_motion.h"
#include "solver/motion_series.h"

namespace vibratory_alignment {

class Flight {
 public:
  explicit Flight(std::size_t drive_count) : x_(drive_count), y_(drive_count), phi_(drive_count) {}

  [[gnu::noinline]] void begin(const System& system, const State& state, const DriveForms& drives, const Instant& now);

  const Instant& start() const { return start_; }
  /// True where the closed form holds to roundoff in every coordinate.
  bool exact() const { return x_.exact() && y_.exact() && phi_.exact(); }

  /// State at time t since the start of the flight. Coordinates without exact closed form are left as they are in
  /// `state`.
  [[gnu::noinline]] void at(double t, State& state) const;

  /// State and accelerations x'', y'', phi'' at a time since the start of an exact flight, and bounds on the absolute
  /// values of the derivatives of the coordinates from then on.
  struct Motion {
    State state;
    FreeMotion::Outlook x, y, phi;
  };
  /// The motion at time t, with bounds until `end`.
  Motion motion_at(double t, double end) const;

  /// Forces of the excitations at time t since the start of the flight.
  Load3 drive_at(double t) const;

  /// Fastest rate in the motion from time t since the start of the flight on, rad per unit of time.
  double rate(double t) const { return std::max({x_.rate(t), y_.rate(t), phi_.rate(t)}); }

  /// Rate that a power series of the flight has to follow.
  double series_rate() const { return std::max({x_.series_rate(), y_.series_rate(), phi_.series_rate()}); }

 private:
  void at(double t, const Waves::Values& waves, State& state) const;

  Instant start_;
  FreeMotion x_, y_, phi_;
  Waves waves_;
  DriveForms drives_;
};

}  // namespace vibratory_alignment
