// A running excitation: amplitude * waveform(theta), theta = frequency * tau + phase, with its kinks as events.
//
//   sine      sin theta
//   square    +1 for theta in (0, pi), -1 for theta in (pi, 2 pi); jumps at 0 and pi
//   triangle  2/pi asin(sin theta); kinks at pi/2 and 3 pi/2
//   chirp     sin theta, where the frequency moves linearly to end_frequency in sweep_time; one event at the end
// The phase is kept modulo 2 pi from a reference instant in double-double arithmetic: no drift over 1e6 periods.
#pragma once

#include <cmath>

#include "mechanics/instant.h"
#include "model/scene.h"

namespace vibratory_alignment {

/// What a drive contributes during a segment, as a function of the time t since its start:
/// constant + slope t + amplitude sin(frequency t + rate t^2/2 + phase).
struct DriveForm {
  double constant = 0.0, slope = 0.0;
  double amplitude = 0.0, frequency = 0.0, rate = 0.0;
  double sin_phase = 0.0, cos_phase = 1.0;

  double at_start() const { return constant + amplitude * sin_phase; }

  double at(double t) const {
    double value = constant + slope * t;
    if (amplitude != 0.0) {
      const double angle = (frequency + 0.5 * rate * t) * t;
      value += amplitude * (sin_phase * std::cos(angle) + cos_phase * std::sin(angle));
    }
    return value;
  }
};

/// A force and a moment on the part, or sums of such.
struct Load3 {
  double x = 0.0, y = 0.0, phi = 0.0;
};

/// True for two chirps over the same frequencies in the same time: a change from one to the other leaves the sweep.
bool same_sweep(const Excitation& a, const Excitation& b);

class Drive {
 public:
  Drive(const Excitation& excitation, const Instant& now);

  Direction direction() const { return excitation_.direction; }

  /// theta at `t`, in [0, 2 pi).
  double phase_at(const Instant& t) const;

  /// The smooth law that holds from `t` to the next kink.
  DriveForm form_at(const Instant& t) const;

  /// Time from `t` to the next kink; infinity for a sine.
  double time_to_kink(const Instant& t) const;

  /// Goes on to the law after the kink.
  void pass_kink();

  /// Goes on to the law that holds at `t`, past any number of kinks of a square or a triangle.
  void go_to(const Instant& t) { choose_branch(t); }

  /// New settings from `now` on. The phase goes on from where it is, plus the difference of the two `phase` settings.
  /// So does a sweep of the same frequencies and time; another one begins.
  void change(const Excitation& excitation, const Instant& now);

 private:
  void choose_branch(const Instant& now);

  Excitation excitation_;
  Instant reference_;  ///< instant of reference_phase_, start of the sweep
  double reference_phase_ = 0.0;
  int branch_ = 0;  ///< square: 0 high, 1 low; triangle: 0 rising, 1 falling; chirp: 0 sweeping, 1 after
};

}  // namespace vibratory_alignment
