// Truncated power series in the time since the start of a segment: c[0] + c[1] t + c[2] t^2 + ...
#pragma once

#include <array>

#include "mechanics/quad.h"

namespace vibratory_alignment {

/// Highest power kept anywhere; two more places serve positions, which are known two orders ahead of forces, and one
/// makes room for four at a time.
constexpr int kMaxOrder = 40;
using Series = std::array<double, kMaxOrder + 4>;

/// Two series side by side, for what comes in pairs: x and y, cos and sin. Summed two at a time by the processor.
struct PairSeries {
  Pair coefficient[kMaxOrder + 3];

  Pair& operator[](int k) { return coefficient[k]; }
  const Pair& operator[](int k) const { return coefficient[k]; }
};

/// 1/k.
inline constexpr std::array<double, kMaxOrder + 4> kInverse = [] {
  std::array<double, kMaxOrder + 4> inverse{};
  for (std::size_t k = 1; k < inverse.size(); ++k) inverse[k] = 1.0 / static_cast<double>(k);
  return inverse;
}();

/// Coefficient k of the product of a pair of series with a series. Two sums, so that additions do not wait for one
/// another.
inline Pair product_term(const PairSeries& a, const Series& b, int k) {
  Pair even = a[0] * b[k], odd{};
  int j = 1;
  for (; j < k; j += 2) {
    odd += a[j] * b[k - j];
    even += a[j + 1] * b[k - j - 1];
  }
  if (j == k) odd += a[k] * b[0];
  return even + odd;
}

/// Coefficient k of the product of two series.
inline double product_term(const Series& a, const Series& b, int k) {
  double sum = 0.0;
  for (int j = 0; j <= k; ++j) sum += a[j] * b[k - j];
  return sum;
}

/// Value at t of the series up to power `order` (Horner).
inline double value_at(const Series& series, int order, double t) {
  double value = series[order];
  for (int k = order - 1; k >= 0; --k) value = value * t + series[k];
  return value;
}

/// Integral over [from, to] of the series up to power `order`.
double integral(const Series& series, int order, double from, double to);

/// Largest value on [from, to] of the series up to power `order`; not a number where its terms are near overflow.
double largest_value(const Series& series, int order, double from, double to);

}  // namespace vibratory_alignment
