// Closed-form motion of one gripper axis without contact (MODEL.md "Free motion"):
//     m q'' + h q' + k (q - anchor) = constant + slope t + sum of amplitude_i sin(nu_i t + phase_i)
// for under-, critically and over-damped axes, k = 0 and h = 0 included.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "mechanics/drive.h"
#include "mechanics/system.h"
#include "mechanics/waves.h"

namespace vibratory_alignment {

class FreeMotion {
 public:
  /// Room for `drive_count` drives; nothing is allocated later.
  explicit FreeMotion(std::size_t drive_count = 0) { sines_.reserve(drive_count); }

  /// Begins a flight at t = 0 with position q and velocity v. Add the drives next, then call settle().
  void begin(const Axis& axis, double q, double v, double constant_force);
  void add(const DriveForm& form);
  /// Fixes the constants of the motion and adds what it is made of to `waves`. After it, exact() tells whether the
  /// closed form holds to roundoff: it does not during a chirp and where two of its terms cancel (a nearly undamped
  /// axis driven near resonance, a nearly vanishing stiffness); the power series of the segment is then as exact.
  void settle(Waves& waves);
  bool exact() const { return exact_; }

  /// Bounds on the absolute values of q', q'', q'''.
  struct Bounds {
    double rate = 0.0, second = 0.0, third = 0.0;

    /// Adds those of an oscillation, or of a decay at this rate.
    void add(double amplitude, double frequency) {
      rate += amplitude * frequency;
      second += amplitude * frequency * frequency;
      third += amplitude * frequency * frequency * frequency;
    }
  };

  /// The acceleration at time t after begin(), and bounds from then until `end`, from the waves at time t.
  struct Outlook {
    double acceleration = 0.0;
    Bounds bounds;
  };
  Outlook outlook(double t, double end, const Waves::Values& waves) const {
    return axis_.moves ? moving_outlook(t, end, waves) : Outlook{};
  }

  /// Fastest rate of the motion from time t on, rad per unit of time: of all that has not decayed.
  double rate(double t) const { return axis_.moves ? moving_rate(t) : 0.0; }

  /// Fastest rate of the equation of motion, which a power series has to follow also where no such motion is left.
  double series_rate() const { return std::max(own_rate_, driven_rate_); }

  /// Position and velocity at time t >= 0 after begin(), from the waves at that time.
  void at(double t, const Waves::Values& waves, double& q, double& v) const {
    q = start_q_;
    v = 0.0;
    if (axis_.moves) move(t, waves, q, v);
  }

 private:
  /// The response to one drive.
  struct Sine {
    double frequency, sin_amplitude, cos_amplitude;
    int wave = 0;
  };

  void move(double t, const Waves::Values& waves, double& q, double& v) const;
  Outlook moving_outlook(double t, double end, const Waves::Values& waves) const;
  double moving_rate(double t) const;
  double slow_rate() const;
  void find_modes();
  /// A part of the motion, at most amplitude exp(-decay t): its rate, and until when, roughly, it counts.
  struct Fading {
    double rate = 0.0, until = 0.0;
  };
  static Fading fading(double amplitude, double rate, double decay);
  void add_modes(const Waves::Values& waves, Outlook& outlook) const;
  void add_free(double t, const Waves::Values& waves, Outlook& outlook) const;
  void homogeneous(double t, const Waves::Values& waves, double& c_change, double& s) const;
  void add_particular(double t, const Waves::Values& waves, double& q, double& v) const;

  Axis axis_;
  double start_q_ = 0.0, start_v_ = 0.0;
  double constant_ = 0.0, slope_ = 0.0;
  bool exact_ = true;
  double pull_ = 0.0, frequency_ = 0.0;               ///< k/m and its root
  double decay_ = 0.0, square_ = 0.0, root_ = 0.0;    ///< h/2m, (h/2m)^2 - k/m, sqrt of its absolute value
  double p0_ = 0.0, p1_ = 0.0, p2_ = 0.0, p3_ = 0.0;  ///< polynomial part of the particular solution
  bool apart_ = false;                                ///< far enough from critical damping to be bounded mode by mode
  double slow_ = 0.0, fast_ = 0.0;                    ///< amplitudes of the two exponentials of an overdamped axis
  double swing_ = 0.0;                                ///< amplitude of the oscillation of an underdamped one
  Bounds driven_;                                     ///< of the response to the drives
  double own_rate_ = 0.0, driven_rate_ = 0.0;         ///< fastest rates of the axis itself and of its drives
  std::array<Fading, 2> fading_;                      ///< of its own motion
  double c_factor_ = 0.0, s_factor_ = 0.0;
  int oscillation_ = 0, fall_ = 0, ratio_ = 0;  ///< places of its own oscillation and decays among the waves
  std::vector<Sine> sines_;
};

}  // namespace vibratory_alignment
