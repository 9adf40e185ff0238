// Sine and cosine, exponential and hyperbolic tangent, four at once, good to the last digit or two.
#pragma once

#include <array>
#include <cmath>

#include "mechanics/quad.h"

namespace vibratory_alignment {

/// Angles up to which sin_cos() is that exact.
constexpr double kLargestAngle = 1e5;

namespace quad_functions {

using Bits = QuadMask;

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
  // in pairs and fours: a product need not wait for all before it
  const Quad z2 = z * z, z4 = z2 * z2;
  const Quad odd =
      r - r * z * ((c[3] - z * c[5] + z2 * (c[7] - z * c[9])) + z4 * (c[11] - z * c[13] + z2 * (c[15] - z * c[17])));
  const Quad half = 0.5 * z, one = 1.0 - half;
  const Quad rest = z2 * ((c[4] - z * c[6] + z2 * (c[8] - z * c[10])) + z4 * (c[12] - z * c[14] + z2 * c[16]));
  const Quad even = one + (((1.0 - one) - half) + rest);
  const Bits quarter = reinterpret_cast<Bits>(rounded), swap = -(quarter & 1);
  const Bits sin_sign = (quarter & 2) << 62, cos_sign = ((quarter + 1) & 2) << 62;
  const Quad unsigned_sin = swap ? even : odd, unsigned_cos = swap ? odd : even;
  sin = reinterpret_cast<Quad>(reinterpret_cast<Bits>(unsigned_sin) ^ sin_sign);
  cos = reinterpret_cast<Quad>(reinterpret_cast<Bits>(unsigned_cos) ^ cos_sign);
}

/// The library's for angles beyond kLargestAngle.
[[gnu::cold, gnu::noinline]] inline void replace_large(const Quad& angle, Quad& sin, Quad& cos) {
  for (int i = 0; i < 4; ++i) {
    if (!(angle[i] > kLargestAngle)) continue;
    sin[i] = std::sin(angle[i]);
    cos[i] = std::cos(angle[i]);
  }
}

/// sin_cos() of angles >= 0 of any size, of which none is above `largest`.
VIBRATORY_ALIGNMENT_INLINE void sin_cos_of_any(const Quad& angle, double largest, Quad& sin, Quad& cos) {
  sin_cos(angle, sin, cos);
  if (!(largest > kLargestAngle)) return;
  Quad exact_sin = sin, exact_cos = cos;
  replace_large(angle, exact_sin, exact_cos);
  sin = exact_sin;
  cos = exact_cos;
}

/// exp(x) - 1 and exp(x) for x <= 0: 2^n exp(r) with |r| <= log(2)/2, Taylor's series of exp(r) - 1.
VIBRATORY_ALIGNMENT_INLINE void exp_change(const Quad& exponent, Quad& change, Quad& left) {
  using namespace quad_functions;
  const Quad least = Quad{} + kFallen, x = exponent > least ? exponent : least;
  const Quad rounded = x * (1.0 / (kLog2[0] + kLog2[1])) + kRounder, n = rounded - kRounder;
  const Quad r = (x - n * kLog2[0]) - n * kLog2[1];
  constexpr auto& c = kInverseFactorial;
  const Quad r2 = r * r, r4 = r2 * r2;
  const Quad series = (c[2] + r * c[3] + r2 * (c[4] + r * c[5])) +
                      r4 * ((c[6] + r * c[7] + r2 * (c[8] + r * c[9])) +
                            r4 * ((c[10] + r * c[11] + r2 * (c[12] + r * c[13])) + r4 * c[14]));
  const Quad power = reinterpret_cast<Quad>((reinterpret_cast<Bits>(rounded) + 1023) << 52);
  const Quad rest = power * (r + r2 * series);
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
