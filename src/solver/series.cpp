#include "solver/series.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/polynomial_roots.h"

namespace vibratory_alignment {

double integral(const Series& series, int order, double from, double to) {
  double at_from = 0.0, at_to = 0.0;
  for (int k = order; k >= 0; --k) {
    const double c = series[k] * kInverse[static_cast<std::size_t>(k + 1)];
    at_from = at_from * from + c;
    at_to = at_to * to + c;
  }
  return at_to * to - at_from * from;
}

double largest_value(const Series& series, int order, double from, double to) {
  double largest = std::max(value_at(series, order, from), value_at(series, order, to));
  if (order < 2 || !(to > from)) return largest;
  // the series about `from`, then every interior maximum: the slope falls through zero there
  Series about = series;
  if (from != 0.0)
    for (int i = 0; i < order; ++i)
      for (int k = order - 1; k >= i; --k) about[k] += about[k + 1] * from;
  const double span = to - from;
  double bound = about[0], size = std::abs(about[0]), power = 1.0;
  for (int k = 1; k <= order; ++k) {
    power *= span;
    bound += std::max(about[k] * power, 0.0);
    size += std::abs(about[k] * power);
  }
  if (!(size < kNearOverflow)) return std::numeric_limits<double>::quiet_NaN();
  if (bound <= largest) return largest;
  Series slope;
  double start = 0.0;
  for (int i = 0; i < order; ++i) {
    for (int k = 0; k < order; ++k) slope[k] = (k + 1) * about[k + 1];
    const double left = span - start;
    // skip a falling stretch: its end is where the slope rises through zero
    if (slope[0] < 0.0) {
      Series negative;
      for (int k = 0; k < order; ++k) negative[k] = -slope[k];
      const double rise = first_fall(negative, order - 1, left, 0);
      if (rise == kNoRoot) return largest;
      start += rise;
      for (int m = 0; m < order; ++m)
        for (int k = order - 1; k >= m; --k) about[k] += about[k + 1] * rise;
      about[1] = std::max(about[1], 0.0);
      continue;
    }
    const double top = first_fall(slope, order - 1, left, 0);
    if (top == kNoRoot) return largest;
    largest = std::max(largest, value_at(about, order, top));
    start += top;
    for (int m = 0; m < order; ++m)
      for (int k = order - 1; k >= m; --k) about[k] += about[k + 1] * top;
    about[1] = std::min(about[1], -1e-300);
  }
  return largest;
}

}  // namespace vibratory_alignment
