// The functions that a flight is made of, at one time: sines and cosines of all its oscillations and how far its decays
// have fallen, four at once. Their results are good to the last digit or two.
#pragma once

#include <array>

namespace vibratory_alignment {

class Waves {
 public:
  static constexpr int kMaxOscillations = 20, kMaxDecays = 8;

  struct Values {
    std::array<double, kMaxOscillations> half_sin, half_cos;  ///< of half the angle: 1 - cos a = 2 sin^2(a/2) is exact
    std::array<double, kMaxDecays> change;                    ///< exp(-rate t) - 1
    std::array<double, kMaxDecays> left;                      ///< exp(-rate t), whose digits change loses

    double sin(int i) const { return 2.0 * half_sin[i] * half_cos[i]; }
    double cos(int i) const { return 1.0 - 2.0 * half_sin[i] * half_sin[i]; }
  };

  void clear() {
    oscillations_ = decays_ = 0;
    largest_half_rate_ = 0.0;
  }

  /// The place of sin(rate t / 2) and cos(rate t / 2) among the values. Throws std::length_error when there is none.
  int add_oscillation(double rate);
  /// The place of exp(-rate t) and of exp(-rate t) - 1, rate >= 0.
  int add_decay(double rate);

  /// Values at time t >= 0.
  void at(double t, Values& values) const;

 private:
  void evaluate(double t, Values& values) const;

  int oscillations_ = 0, decays_ = 0;
  double largest_half_rate_ = 0.0;
  std::array<double, kMaxOscillations> half_rate_{};
  std::array<double, kMaxDecays> decay_rate_{};
};

}  // namespace vibratory_alignment
