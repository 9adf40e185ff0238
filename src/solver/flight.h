// A flight: the part moves freely, in closed form, from release to the next touch.
#pragma once

#include "mechanics/free_motion.h"
#include "solver/motion_series.h"

namespace vibratory_alignment {

class Flight {
 public:
  explicit Flight(std::size_t drive_count) : x_(drive_count), y_(drive_count), phi_(drive_count) {}

  void begin(const System& system, const State& state, const DriveForms& drives, const Instant& now);

  const Instant& start() const { return start_; }
  /// True where the closed form holds to roundoff in every coordinate.
  bool exact() const { return x_.exact() && y_.exact() && phi_.exact(); }

  /// State at time t since the start of the flight. Coordinates without exact closed form are left as they are in
  /// `state`.
  void at(double t, State& state) const;

  /// Forces of the excitations at time t since the start of the flight.
  Load3 drive_at(double t) const;

  /// Fastest rate in the motion, rad per unit of time.
  double rate() const { return rate_; }

  /// Largest absolute values of the derivatives of the coordinates from the start of the flight to `end`.
  struct Bounds {
    FreeMotion::Bounds x, y, phi;
  };
  Bounds bounds(double end) const { return {x_.bounds(end), y_.bounds(end), phi_.bounds(end)}; }

 private:
  Instant start_;
  FreeMotion x_, y_, phi_;
  DriveForms drives_;
  double rate_ = 1.0;
};

}  // namespace vibratory_alignment
