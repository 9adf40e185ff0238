#include "solver/polynomial_roots.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "solver/solver.h"

namespace vibratory_alignment {
namespace {

/// Halvings after which an undecided interval is narrower than the resolution of a double.
constexpr int kMaxHalvings = 52;

/// Bounds of a polynomial on [0, 1].
struct Range {
  double low, high;
};

/// Two coefficients at a time from an even power on, as scale_to_unit() leaves them: read as they were written they
/// need not wait in memory for one another. An odd last one alone.
template <typename TwoTerms, typename OneTerm>
void for_powers(int from, int order, const TwoTerms& two, const OneTerm& one) {
  int k = from;
  for (; k < order; k += 2) two(k);
  if (k == order) one(k);
}

Pair pair_at(const Series& g, int k) {
  Pair pair;
  std::memcpy(&pair, &g[static_cast<std::size_t>(k)], sizeof pair);
  return pair;
}

void set_pair(const Pair& pair, int k, Series& g) { std::memcpy(&g[static_cast<std::size_t>(k)], &pair, sizeof pair); }

/// Of each number, what it is below zero, and above; what is not a number stays so.
Pair negative_part(const Pair& pair) { return pair > Pair{} ? Pair{} : pair; }
Pair positive_part(const Pair& pair) { return pair < Pair{} ? Pair{} : pair; }

Range range_on_unit(const Series& g, int order) {
  const double first = order > 0 ? g[1] : 0.0;
  Pair low{0.0, std::min(first, 0.0)}, high{0.0, std::max(first, 0.0)};
  Range range{g[0], g[0]};
  for_powers(
      2, order,
      [&](int k) {
        const Pair term = pair_at(g, k);
        low += negative_part(term);
        high += positive_part(term);
      },
      [&](int k) { (g[k] < 0.0 ? range.low : range.high) += g[k]; });
  range.low += (low[0] + low[1]);
  range.high += (high[0] + high[1]);
  return range;
}

/// Bounds of the derivative on [0, 1].
Range slope_on_unit(const Series& g, int order) {
  Pair low{}, high{}, power{2.0, 3.0};
  Range range{g[1], g[1]};
  for_powers(
      2, order,
      [&](int k) {
        const Pair term = pair_at(g, k) * power;
        low += negative_part(term);
        high += positive_part(term);
        power += 2.0;
      },
      [&](int k) { (g[k] < 0.0 ? range.low : range.high) += k * g[k]; });
  range.low += (low[0] + low[1]);
  range.high += (high[0] + high[1]);
  return range;
}

/// Numbers that are not finite decide no bound: without this check every half would be halved again.
void require_finite(const Series& unit, int order) {
  double sum = 0.0;
  for (int k = 0; k <= order; ++k) sum += std::abs(unit[k]);
  if (!std::isfinite(sum)) throw SolverFailure("the motion is no longer finite");
}

/// g(t h) as a polynomial on [0, 1]; where g(0) > 0, the lower bound of range_on_unit().
double scale_to_unit(const Series& g, int order, double h, Series& unit) {
  Pair power{1.0, h}, low{};
  const double square = h * h;
  double alone = 0.0;
  for_powers(
      0, order,
      [&](int k) {
        const Pair term = pair_at(g, k) * power;
        set_pair(term, k, unit);
        low += negative_part(term);
        power *= square;
      },
      [&](int k) {
        unit[k] = g[k] * power[0];
        alone = std::min(unit[k], 0.0);
      });
  return (std::max(unit[0], 0.0) + alone) + (low[0] + low[1]);
}

/// The left and right half of [0, 1], each as a polynomial on [0, 1].
void left_half(const Series& g, int order, Series& half) { scale_to_unit(g, order, 0.5, half); }

/// g(1 + t) by repeated synthetic division.
template <int kOrder>
void shift_by_one(Series& g) {
  std::array<double, kOrder + 1> shifted;
  std::copy(g.begin(), g.begin() + kOrder + 1, shifted.begin());
  for (int i = 0; i < kOrder; ++i)
    for (int k = kOrder - 1; k >= i; --k) shifted[k] += shifted[k + 1];
  std::copy(shifted.begin(), shifted.end(), g.begin());
}

/// g((1 + t)/2). Loops of a length that is known beforehand take half the time.
void right_half(const Series& g, int order, Series& half) {
  scale_to_unit(g, order, 0.5, half);
  const int padded_order = (order + 3) / 4 * 4;
  std::fill(half.begin() + order + 1, half.begin() + padded_order + 1, 0.0);
  switch (padded_order) {
    case 4: return shift_by_one<4>(half);
    case 8: return shift_by_one<8>(half);
    case 12: return shift_by_one<12>(half);
    case 16: return shift_by_one<16>(half);
    case 20: return shift_by_one<20>(half);
    default: return shift_by_one<kMaxOrder>(half);
  }
}

/// Root of g on [0, 1], where g(0) > 0 > g(1) and g falls throughout: Halley's iteration kept inside a shrinking
/// bracket. It converges with the third power, so a step this small leaves nothing to do.
double falling_root(const Series& g, int order) {
  constexpr double kLastStep = 1e-6;
  double low = 0.0, high = 1.0;
  const double total = std::max(-value_at(g, order, 1.0), 0.0) + g[0];
  double t = g[0] / total;
  for (int i = 0; i < 100; ++i) {
    // value, slope and half the curvature
    double value = g[order], slope = 0.0, bend = 0.0;
    for (int k = order - 1; k >= 0; --k) {
      bend = bend * t + slope;
      slope = slope * t + value;
      value = value * t + g[k];
    }
    (value > 0.0 ? low : high) = t;
    const double newton = value / slope, turn = newton * bend / slope;
    double next = t - newton / (1.0 - turn);
    const bool inside = next >= low && next <= high;
    if (!inside) next = 0.5 * (low + high);
    const double step = std::abs(next - t);
    if (step <= 1e-16 * t || (inside && step <= kLastStep * t && std::abs(turn) <= kLastStep)) return next;
    t = next;
  }
  return t;
}

double first_fall_on_unit(const Series& g, int order, int halvings);

/// First fall below zero on [0, 1] of a polynomial with g(0) > 0 whose bounds leave room for one, or kNoRoot.
double first_fall_within_bounds(const Series& g, int order, int halvings) {
  const Range slope = slope_on_unit(g, order);
  if (slope.low >= 0.0) return kNoRoot;
  if (slope.high <= 0.0) return value_at(g, order, 1.0) < 0.0 ? falling_root(g, order) : kNoRoot;
  if (halvings == kMaxHalvings) return value_at(g, order, 1.0) < 0.0 ? 1.0 : kNoRoot;
  Series half;
  left_half(g, order, half);
  const double left = first_fall_on_unit(half, order, halvings + 1);
  if (left != kNoRoot) return 0.5 * left;
  right_half(g, order, half);
  if (half[0] <= 0.0) return 0.5;
  const double right = first_fall_on_unit(half, order, halvings + 1);
  return right == kNoRoot ? kNoRoot : 0.5 + 0.5 * right;
}

/// First fall below zero on [0, 1] of a polynomial with g(0) > 0, or kNoRoot.
double first_fall_on_unit(const Series& g, int order, int halvings) {
  return range_on_unit(g, order).low > 0.0 ? kNoRoot : first_fall_within_bounds(g, order, halvings);
}

/// Divides out `zeros` roots at t = 0.
int deflate(Series& g, int order, int zeros) {
  for (int k = 0; k + zeros <= order; ++k) g[k] = g[k + zeros];
  return order - zeros;
}

Entry first_entry_on_unit(const Conditions& conditions, const std::array<int, kMaxConditions>& orders, int halvings) {
  int undecided = 0, last = 0;
  for (int i = 0; i < conditions.count; ++i) {
    const Range range = range_on_unit(conditions.g[i], orders[i]);
    if (range.high <= 0.0) return {};
    if (range.low <= 0.0) {
      ++undecided;
      last = i;
    }
  }
  if (undecided == 0) {
    // all hold from here on, the last of them by a last digit that it had not just before
    for (int i = 1; i < conditions.count; ++i)
      if (conditions.g[i][0] < conditions.g[last][0]) last = i;
    return {0.0, last};
  }
  if (undecided == 1) {
    const Series& g = conditions.g[last];
    if (g[0] > 0.0 && g[1] >= 0.0) return {0.0, last};
    // the first rise of the one undecided condition; one that starts true by a last digit, and falls, is halved away
    if (g[0] <= 0.0) {
      Series negative = g;
      for (int k = 0; k <= orders[last]; ++k) negative[k] = -negative[k];
      return {first_fall(negative, orders[last], 1.0, 0), last};
    }
  }
  if (halvings == kMaxHalvings) {
    for (int i = 0; i < conditions.count; ++i)
      if (value_at(conditions.g[i], orders[i], 1.0) <= 0.0) return {};
    return {1.0, last};
  }
  Conditions half;
  half.count = conditions.count;
  for (int i = 0; i < conditions.count; ++i) left_half(conditions.g[i], orders[i], half.g[i]);
  Entry entry = first_entry_on_unit(half, orders, halvings + 1);
  if (entry.time != kNoRoot) {
    entry.time *= 0.5;
    return entry;
  }
  for (int i = 0; i < conditions.count; ++i) right_half(conditions.g[i], orders[i], half.g[i]);
  entry = first_entry_on_unit(half, orders, halvings + 1);
  if (entry.time != kNoRoot) entry.time = 0.5 + 0.5 * entry.time;
  return entry;
}

double time_of(double root_on_unit, double h) { return root_on_unit == kNoRoot ? kNoRoot : root_on_unit * h; }

}  // namespace

double first_fall(const Series& g, int order, double h, int zeros_at_start) {
  Series unit;
  const double low = scale_to_unit(g, order, h, unit);
  if (low > 0.0 && zeros_at_start == 0) return kNoRoot;
  require_finite(unit, order);
  if (unit[0] > 0.0 && order > 0 && zeros_at_start == 0) return time_of(first_fall_within_bounds(unit, order, 0), h);
  if (zeros_at_start > 0) order = deflate(unit, order, zeros_at_start);
  if (unit[0] <= 0.0 && zeros_at_start == 0) order = deflate(unit, order, 1);
  // what starts at an exact zero is judged by its first coefficient that is not
  while (order > 0 && unit[0] == 0.0) order = deflate(unit, order, 1);
  if (unit[0] < 0.0) return 0.0;
  if (order == 0) return kNoRoot;
  return time_of(first_fall_on_unit(unit, order, 0), h);
}

bool stays_above_zero(const Series& g, int order, double h) {
  Series unit;
  return scale_to_unit(g, order, h, unit) > 0.0;
}

Entry first_entry(const Conditions& conditions, int order, double h) {
  Conditions unit;
  unit.count = conditions.count;
  std::array<int, kMaxConditions> orders{};
  for (int i = 0; i < conditions.count; ++i) {
    scale_to_unit(conditions.g[i], order, h, unit.g[i]);
    require_finite(unit.g[i], order);
    orders[i] = deflate(unit.g[i], order, conditions.zeros_at_start[i]);
  }
  Entry entry = first_entry_on_unit(unit, orders, 0);
  // inside from the start: through the face on which the point lies
  if (entry.time == 0.0)
    for (int i = 0; i < conditions.count; ++i)
      if (conditions.zeros_at_start[i] > 0) entry.last = i;
  if (entry.time != kNoRoot) entry.time *= h;
  return entry;
}

}  // namespace vibratory_alignment
