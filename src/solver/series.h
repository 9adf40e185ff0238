// Truncated power series in the time since the start of a segment: c[0] + c[1] t + c[2] t^2 + ...
#pragma once

#include <array>

#include "mechanics/quad.h"

namespace vibratory_alignment {

/// Highest power kept anywhere; two more places serve positions, which are known two orders ahead of forces, and one
/// makes room for four at a time.
constexpr int kMaxOrder = 40;
using Series = std::array<double, kMaxOrder + 4>;

/// Coefficients and terms this large leave no room for what is computed from them.
constexpr double kNearOverflow = 1e250;

/// Two series side by side, for what comes in pairs: x and y, cos and sin. Summed two at a time by the processor.
struct PairSeries {
  Pair coefficient[kMaxOrder + 3];

  Pair& operator[](int k) { return coefficient[k]; }
  const Pair& operator[](int k) const { return coefficient[k]; }
};

/// Four series side by side: force along x and y, moment, and one that is free.
struct QuadSeries {
  Quad coefficient[kMaxOrder + 3];

  Quad& operator[](int k) { return coefficient[k]; }
  const Quad& operator[](int k) const { return coefficient[k]; }
};

/// 1/k.
inline constexpr std::array<double, kMaxOrder + 4> kInverse = [] {
  std::array<double, kMaxOrder + 4> inverse{};
  for (std::size_t k = 1; k < inverse.size(); ++k) inverse[k] = 1.0 / static_cast<double>(k);
  return inverse;
}();

/// Adds terms of coefficient k of the products of several series with one or as many: those that have no power 0 of
/// either. Two sums, so that additions do not wait for one another.
template <typename SeveralSeries, typename OtherSeries, typename Sum>
VIBRATORY_ALIGNMENT_INLINE void add_inner_product_term(const SeveralSeries& a, const OtherSeries& b, int k, Sum& sum) {
  if (k < 2) return;
  Sum other{};
  const auto* left = &a[1];
  const auto* right = &b[k - 1];
  const auto* const last = &a[k - 1];
  for (; left < last; left += 2, right -= 2) {
    sum += left[0] * right[0];
    other += left[1] * right[-1];
  }
  if (left == last) sum += left[0] * right[0];
  sum += other;
}

/// Adds coefficient k of the products of several series with one. What may have been found last is added last.
template <typename SeveralSeries, typename Sum>
VIBRATORY_ALIGNMENT_INLINE void add_product_term(const SeveralSeries& a, const Series& b, int k, Sum& sum) {
  add_inner_product_term(a, b, k, sum);
  if (k != 0) sum += a[k] * b[0];
  sum += a[0] * b[k];
}

/// Coefficient k of the product of a pair of series with a series.
VIBRATORY_ALIGNMENT_INLINE Pair product_term(const PairSeries& a, const Series& b, int k) {
  Pair sum{};
  add_product_term(a, b, k, sum);
  return sum;
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
