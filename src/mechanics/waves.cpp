#include "mechanics/waves.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "mechanics/quad_functions.h"

namespace vibratory_alignment {
namespace {

constexpr int kWidth = 4;

VIBRATORY_ALIGNMENT_INLINE void copy(const double* from, Quad& to) { std::memcpy(&to, from, sizeof to); }
VIBRATORY_ALIGNMENT_INLINE void copy(const Quad& from, double* to) { std::memcpy(to, &from, sizeof from); }

}  // namespace

int Waves::add_oscillation(double rate) {
  if (oscillations_ == kMaxOscillations) throw std::length_error("too many oscillations in one flight");
  half_rate_[static_cast<std::size_t>(oscillations_)] = 0.5 * rate;
  largest_half_rate_ = std::max(largest_half_rate_, 0.5 * rate);
  return oscillations_++;
}

int Waves::add_decay(double rate) {
  if (decays_ == kMaxDecays) throw std::length_error("too many decays in one flight");
  decay_rate_[static_cast<std::size_t>(decays_)] = rate;
  return decays_++;
}

VIBRATORY_ALIGNMENT_INLINE void Waves::evaluate(double t, Values& values) const {
  for (int i = 0; i < oscillations_; i += kWidth) {
    Quad rate, sin, cos;
    copy(&half_rate_[i], rate);
    sin_cos(rate * t, sin, cos);
    copy(sin, &values.half_sin[i]);
    copy(cos, &values.half_cos[i]);
  }
  for (int i = 0; i < decays_; i += kWidth) {
    Quad rate, change, left;
    copy(&decay_rate_[i], rate);
    exp_change(rate * -t, change, left);
    copy(change, &values.change[i]);
    copy(left, &values.left[i]);
  }
}

void Waves::at(double t, Values& values) const {
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA { evaluate(t, values); });
  if (!(largest_half_rate_ * t > kLargestAngle)) return;
  for (int i = 0; i < oscillations_; ++i) {
    const double angle = half_rate_[i] * t;
    if (!(angle > kLargestAngle)) continue;
    values.half_sin[i] = std::sin(angle);
    values.half_cos[i] = std::cos(angle);
  }
}

}  // namespace vibratory_alignment
