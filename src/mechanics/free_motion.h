// Closed-form motion of the part without contact (MODEL.md "Free motion"), every axis by itself:
//     m q'' + h q' + k (q - anchor) = constant + slope t + sum of amplitude_i sin(nu_i t + phase_i)
// for under-, critically and overdamped axes, k = 0 and h = 0 included. All axes are worked out at once, as lanes of a
// Quad, by the same operations: one that does not move costs nothing, and none has digits that depend on another.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "mechanics/drive.h"
#include "mechanics/free_axes.h"

namespace vibratory_alignment {

class FreeMotion {
 public:
  /// Of a system that outlives it, of which only anchors may change, from the next flight on. Room for `drive_count`
  /// drives; nothing is allocated later.
  FreeMotion(const System& system, std::size_t drive_count);

  /// Begins a flight at t = 0. Add the drives next, then call settle().
  void begin(const State& state);
  void add(Direction direction, const DriveForm& form);
  /// Fixes the constants of the motion. After it, exact() tells whether the closed form holds to roundoff on all axes:
  /// it does not during a chirp and where two of its terms cancel (a nearly undamped axis driven near resonance, a
  /// nearly vanishing stiffness); the power series of the segment is then as exact.
  void settle();
  bool exact() const { return exact_; }

  /// Fastest rate of the motion from time t on, rad per unit of time: of all that has not decayed.
  double rate(double t) const {
    double rate = driven_rate_;
    for (const Fading& part : fading_)
      for (int i = 0; i < FreeAxes::kCount; ++i)
        if (t < part.until[i]) rate = std::max(rate, part.rate[i]);
    return rate;
  }

  /// Fastest rate of the equations of motion, which a power series has to follow also where no such motion is left.
  double series_rate() const { return series_rate_; }

  /// Position and velocity at time t >= 0 after begin(). Coordinates without exact closed form are left as they are in
  /// `state`.
  void at(double t, State& state) const { evaluate(t, t, state, nullptr); }

  /// The accelerations at a time, and bounds on the absolute values of q', q'', q''' from then on. Lanes: FreeAxes.
  struct Outlook {
    Quad acceleration{}, rate{}, second{}, third{};
  };
  /// The same, and the outlook from time t with bounds until `end`, of an exact motion.
  void at(double t, double end, State& state, Outlook& outlook) const { evaluate(t, end, state, &outlook); }

 private:
  /// The response to one drive of each axis.
  struct Sines {
    Quad frequency{}, half_frequency{}, sin_amplitude{}, cos_amplitude{};
  };
  /// Parts of the motion, at most amplitude exp(-decay t): their rates, and until when, roughly, they count.
  struct Fading {
    Quad rate{}, until{};
    void set(int axis, double its_rate, double amplitude, double decay);
  };
  /// The axes' own motion: C - 1 and S, where S solves the free equation with S(0) = 0, S'(0) = 1 and C = S' + 2a S has
  /// C(0) = 1, C'(0) = 0; and what they are made of.
  struct Own {
    Quad c_change, s;
    Quad left, left_between{};  ///< exp(-fall t), exp(-between t)
    Quad cosine;                ///< cos(root t) of an underdamped axis, else 1
  };
  struct Motion {
    Quad q, v, driven_acceleration;
  };

  void settle_axis(int axis);
  void find_modes(int axis, double c_factor, double s_factor);
  void own_at(double t, Own& own) const;
  void move(double t, const Own& own, Motion& motion) const;
  void look(double end, const Own& own, const Motion& motion, Outlook& outlook) const;
  void put(const Motion& motion, State& state) const;
  void evaluate(double t, double end, State& state, Outlook* outlook) const;

  const System& system_;
  std::array<const Axis*, FreeAxes::kCount> axis_;
  FreeAxes free_axes_;

  // of the flight
  bool exact_ = true;
  std::array<bool, FreeAxes::kCount> axis_exact_{};
  std::array<double, FreeAxes::kCount> constant_{}, slope_{};  ///< forces
  Quad start_q_{}, start_v_{};
  Quad c_factor_{}, s_factor_{};
  Quad p1_{}, p2_{}, p3_{};                             ///< polynomial part of the particular solution, but for p0
  Quad mode_{}, fast_mode_{};                           ///< amplitudes of the modes
  Quad least_rate_{}, least_second_{}, least_third_{};  ///< bounds on what neither falls nor grows
  std::array<Fading, 2> fading_;                        ///< of the axes' own motion
  std::vector<Sines> sines_;
  std::array<std::size_t, FreeAxes::kCount> sine_count_{};
  double driven_rate_ = 0.0, series_rate_ = 0.0;  ///< fastest of the drives; of drives and axes
};

static_assert(alignof(FreeMotion) == alignof(Quad));

}  // namespace vibratory_alignment
