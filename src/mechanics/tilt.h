// cos and sin of the part's tilt.
#pragma once

#include <cmath>

#include "mechanics/quad.h"

namespace vibratory_alignment {

struct Tilt {
  double cos, sin;
};

/// Largest tilt, rad, at which Taylor's series to the 14th power are good to the last digit or two. Parts tilt by less;
/// the library's functions take several times as long.
constexpr double kSmallTilt = 0.5;

/// What the series of cos and sin are made of, z the square of a small tilt: cos = 1 - (z/2 - even),
/// sin = phi - phi odd.
template <typename Number>
struct TiltSeries {
  Number even, odd;
};
template <typename Number>
VIBRATORY_ALIGNMENT_INLINE TiltSeries<Number> small_tilt_series(const Number& z) {
  // in pairs: a product need not wait for all before it
  const Number z2 = z * z;
  return {z2 * ((1.0 / 24 - z * (1.0 / 720)) +
                z2 * ((1.0 / 40320 - z * (1.0 / 3628800)) + z2 * (1.0 / 479001600 - z * (1.0 / 87178291200)))),
          z * ((1.0 / 6 - z * (1.0 / 120)) +
               z2 * ((1.0 / 5040 - z * (1.0 / 362880)) + z2 * (1.0 / 39916800 - z * (1.0 / 6227020800))))};
}

/// cos phi and sin phi, even and odd to the last bit.
inline Tilt tilt_of(double phi) {
  if (!(std::abs(phi) <= kSmallTilt)) return {std::cos(phi), std::sin(phi)};
  const double z = phi * phi;
  const auto [even, odd] = small_tilt_series(z);
  return {1.0 - (0.5 * z - even), phi - phi * odd};
}

}  // namespace vibratory_alignment
