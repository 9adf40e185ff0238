// Sine and cosine, exponential and hyperbolic tangent, four at once, good to the last digit or two.
#pragma once

#include <array>

#include "mechanics/quad.h"

namespace vibratory_alignment {

/// Angles up to which sin_cos() is that exact.
constexpr double kLargestAngle = 1e5;

namespace quad_functions {

using Bits = long long __attribute__((vector_size(32)));

/// Adding this rounds to a whole number, whose last bits are then those of the sum.
constexpr double kRounder = 0x1.8p52;

/// pi/2 and log 2 as sums whose first parts times a whole number of 20 digits are exact.
constexpr double kQuarter[] = {0x1.921fb544p0, 0x1.0b4611a6p-34, 0x1.3198a2e037073p-69};
constexpr double kLog2[] = {0x1.62e42feep-1, 0x1.a39ef35793c76p-33};

/// exp(-700) is nothing.
constexpr double kFallen = -700.0;

/// 1/k!.
constexpr auto kInverseFactorial = [] {
  std::array<double, 19> inverse{};
  double factorial = 1.0;
  for (std::size_t k = 0; k < inverse.size(); ++k) {
    if (k > 0) factorial *= static_cast<double>(k);
    inverse[k] = 1.0 / factorial;
  }
  return inverse;
}();

}  // namespace quad_functions

/// Taylor's series about the nearest multiple of pi/2.
VIBRATORY_ALIGNMENT_INLINE void sin_cos(const Quad& angle, Quad& sin, Quad& cos) {
  using namespace quad_functions;
  const Quad rounded = angle * (1.0 / (kQuarter[0] + kQuarter[1])) + kRounder, n = rounded - kRounder;
  const Quad r = ((angle - n * kQuarter[0]) - n * kQuarter[1]) - n * kQuarter[2], z = r * r;
  constexpr auto& c = kInverseFactorial;
  const Quad odd =
      r - r * z * (c[3] - z * (c[5] - z * (c[7] - z * (c[9] - z * (c[11] - z * (c[13] - z * (c[15] - z * c[17])))))));
  const Quad half = 0.5 * z, one = 1.0 - half;
  const Quad rest = z * z * (c[4] - z * (c[6] - z * (c[8] - z * (c[10] - z * (c[12] - z * (c[14] - z * c[16]))))));
  const Quad even = one + (((1.0 - one) - half) + rest);
  const Bits quarter = reinterpret_cast<Bits>(rounded), swap = -(quarter & 1);
  const Bits sin_sign = (quarter & 2) << 62, cos_sign = ((quarter + 1) & 2) << 62;
  const Quad unsigned_sin = swap ? even : odd, unsigned_cos = swap ? odd : even;
  sin = reinterpret_cast<Quad>(reinterpret_cast<Bits>(unsigned_sin) ^ sin_sign);
  cos = reinterpret_cast<Quad>(reinterpret_cast<Bits>(unsigned_cos) ^ cos_sign);
}

/// exp(x) - 1 and exp(x) for x <= 0: 2^n exp(r) with |r| <= log(2)/2, Taylor's series of exp(r) - 1.
VIBRATORY_ALIGNMENT_INLINE void exp_change(const Quad& exponent, Quad& change, Quad& left) {
  using namespace quad_functions;
  const Quad least = Quad{} + kFallen, x = exponent > least ? exponent : least;
  const Quad rounded = x * (1.0 / (kLog2[0] + kLog2[1])) + kRounder, n = rounded - kRounder;
  const Quad r = (x - n * kLog2[0]) - n * kLog2[1];
  constexpr auto& c = kInverseFactorial;
  Quad series = Quad{} + c[14];
  for (int k = 13; k >= 2; --k) series = series * r + c[static_cast<std::size_t>(k)];
  const Quad power = reinterpret_cast<Quad>((reinterpret_cast<Bits>(rounded) + 1023) << 52);
  const Quad rest = power * (r + r * r * series);
  change = rest + (power - 1.0);
  left = rest + power;
}

/// tanh |x| = (1 - exp(-2|x|))/(1 + exp(-2|x|)); odd to the last bit. What is no number is taken for a large one.
VIBRATORY_ALIGNMENT_INLINE void tanh_of(const Quad& x, Quad& tanh) {
  const Quad size = x < 0.0 ? -x : x;
  Quad change, left;
  exp_change(-2.0 * size, change, left);
  const Quad ratio = -change / (2.0 + change);
  tanh = x < 0.0 ? -ratio : ratio;
}

}  // namespace vibratory_alignment
