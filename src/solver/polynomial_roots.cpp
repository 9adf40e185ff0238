#include "solver/polynomial_roots.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "solver/bernstein.h"
#include "solver/solver.h"

namespace vibratory_alignment {
namespace {

/// What is undecided within the last digit of the time is decided by its ends; near zero, after so many halvings.
constexpr double kTimeRounding = std::numeric_limits<double>::epsilon();
constexpr int kMaxHalvings = 104;

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

/// Root of g in (low, high), where it falls below zero once: Halley's iteration from t, kept inside a shrinking
/// bracket. It converges with the third power, so a step this small leaves nothing to do.
VIBRATORY_ALIGNMENT_INLINE double find_falling_root(const Series& g, int order, double low, double high, double t) {
  constexpr double kLastStep = 1e-6;
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

/// The same. Its sums wait for one another, half as long where the processor multiplies and adds at once.
double falling_root(const Series& g, int order, double low, double high, double t) {
  double root = 0.0;
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA { root = find_falling_root(g, order, low, high, t); });
  return root;
}

/// Part of [0, 1], with what a polynomial is on it.
struct Part {
  double start = 0.0, width = 1.0;
  int halvings = 0;

  double end() const { return start + width; }
  /// Too narrow for anything to be told within it.
  bool is_instant() const { return width <= kTimeRounding * start || halvings == kMaxHalvings; }
  Part left() const { return {start, 0.5 * width, halvings + 1}; }
  Part right() const { return {start + 0.5 * width, 0.5 * width, halvings + 1}; }
};

/// First fall of g below zero on a part of [0, 1], on which it is `form` and starts above zero, or at zero and rises;
/// or kNoRoot.
double first_fall_on_part(const Series& g, int order, const BernsteinForm& form, const Part& part) {
  const int changes = sign_changes(form);
  if (changes == 0) return kNoRoot;
  if (changes == 1)
    return falling_root(g, order, part.start, part.end(), part.start + part.width * zero_of_coefficients(form));
  if (part.is_instant()) return form.at_end() < 0.0 ? part.end() : kNoRoot;
  BernsteinForm left, right;
  halve(form, left, right);
  const double fall = first_fall_on_part(g, order, left, part.left());
  if (fall != kNoRoot) return fall;
  if (right.at_start() <= 0.0) return part.right().start;
  return first_fall_on_part(g, order, right, part.right());
}

/// First fall below zero on [0, 1] of a polynomial with g(0) > 0, or kNoRoot.
double first_fall_on_unit(const Series& g, int order) {
  BernsteinForm form;
  set_bernstein(g, order, form);
  return first_fall_on_part(g, order, form, {});
}

/// Divides out `zeros` roots at t = 0.
int deflate(Series& g, int order, int zeros) {
  for (int k = 0; k + zeros <= order; ++k) g[k] = g[k + zeros];
  return order - zeros;
}

/// Conditions on a part of [0, 1].
using Forms = std::array<BernsteinForm, kMaxConditions>;

/// Time for which a condition that holds at the start has done so, by its rate there: none where it starts with zero,
/// however slowly it rises; one that does not rise has held before.
double held_for(const BernsteinForm& form) {
  if (form.at_start() == 0.0) return 0.0;
  const double rise = form.degree > 0 ? form.degree * (form.b[1] - form.b[0]) : 0.0;
  return rise > 0.0 ? form.at_start() / rise : std::numeric_limits<double>::infinity();
}

/// Of two conditions that start with zeros, whether the first rises more slowly beyond them: its face is the nearer
/// one.
bool rises_slower(const Conditions& conditions, int first, int second, int order) {
  const int zeros = conditions.zeros_at_start[first];
  if (zeros != conditions.zeros_at_start[second]) return zeros > conditions.zeros_at_start[second];
  const Series &a = conditions.g[first], &b = conditions.g[second];
  return std::lexicographical_compare(a.begin() + zeros, a.begin() + order + 1, b.begin() + zeros,
                                      b.begin() + order + 1);
}

/// Of two conditions that hold at the start, whether the first became true later; of two that begin to at once, whether
/// the first does so more slowly: its face is the nearer one from then on.
bool holds_for_less(const BernsteinForm& a, const BernsteinForm& b) {
  const double time_a = held_for(a), time_b = held_for(b);
  if (time_a != time_b) return time_a < time_b;
  return std::lexicographical_compare(a.b.begin(), a.b.begin() + a.degree + 1, b.b.begin(), b.b.begin() + b.degree + 1);
}

/// First rise of g above zero on a part of [0, 1], on which it is `form` and starts at or below zero, or kNoRoot.
double first_rise_on_part(const Series& g, int order, const BernsteinForm& form, const Part& part) {
  const auto* const first =
      std::find_if(form.b.begin(), form.b.begin() + form.degree + 1, [](double b) { return b != 0.0; });
  if (*first > 0.0) return part.start;
  Series negative;
  BernsteinForm negative_form;
  negative_form.degree = form.degree;
  for (int k = 0; k <= order; ++k) {
    negative[k] = -g[k];
    negative_form.b[k] = -form.b[k];
  }
  return first_fall_on_part(negative, order, negative_form, part);
}

/// `g`: the conditions on all of [0, 1], to these orders; `forms`: on this part.
Entry first_entry_on_part(const Conditions& g, const std::array<int, kMaxConditions>& orders, const Forms& forms,
                          const Part& part) {
  int undecided = 0, last = 0;
  for (int i = 0; i < g.count; ++i) {
    const Range range = range_of(forms[i]);
    if (range.high <= 0.0) return {};
    if (range.low <= 0.0) {
      ++undecided;
      last = i;
    }
  }
  if (undecided == 0) {
    // all hold from here on, the last of them by a last digit that it had not just before
    for (int i = 1; i < g.count; ++i)
      if (holds_for_less(forms[i], forms[last])) last = i;
    return {part.start, last};
  }
  if (undecided == 1) {
    const BernsteinForm& form = forms[last];
    if (form.at_start() > 0.0 && form.b[1] >= form.b[0]) return {part.start, last};
    // the first rise of the one undecided condition; one that starts true by a last digit, and falls, is halved away
    if (form.at_start() <= 0.0) return {first_rise_on_part(g.g[last], orders[last], form, part), last};
  }
  if (part.is_instant()) {
    for (int i = 0; i < g.count; ++i)
      if (forms[i].at_end() <= 0.0) return {};
    return {part.end(), last};
  }
  Forms left, right;
  for (int i = 0; i < g.count; ++i) halve(forms[i], left[i], right[i]);
  const Entry entry = first_entry_on_part(g, orders, left, part.left());
  return entry.time != kNoRoot ? entry : first_entry_on_part(g, orders, right, part.right());
}

double time_of(double root_on_unit, double h) { return root_on_unit == kNoRoot ? kNoRoot : root_on_unit * h; }

}  // namespace

double first_fall(const Series& g, int order, double h, int zeros_at_start) {
  Series unit;
  const double low = scale_to_unit(g, order, h, unit);
  if (low > 0.0 && zeros_at_start == 0) return kNoRoot;
  require_finite(unit, order);
  if (zeros_at_start > 0) order = deflate(unit, order, zeros_at_start);
  if (unit[0] <= 0.0 && zeros_at_start == 0) order = deflate(unit, order, 1);
  // what starts at an exact zero is judged by its first coefficient that is not
  while (order > 0 && unit[0] == 0.0) order = deflate(unit, order, 1);
  if (unit[0] < 0.0) return 0.0;
  if (order <= 0 || (zeros_at_start > 0 && range_on_unit(unit, order).low > 0.0)) return kNoRoot;
  return time_of(first_fall_on_unit(unit, order), h);
}

bool stays_above_zero(const Series& g, int order, double h) {
  Series unit;
  return scale_to_unit(g, order, h, unit) > 0.0;
}

bool stays_below(const Series& g, int order, double h, double level) {
  Series unit;
  scale_to_unit(g, order, h, unit);
  BernsteinForm form;
  set_bernstein(unit, order, form);
  return range_of(form).high <= level && form.at_end() <= level;  // what is not a number is not below
}

Entry first_entry(const Conditions& conditions, int order, double h) {
  Conditions unit;
  unit.count = conditions.count;
  std::array<int, kMaxConditions> orders{};
  Forms forms;
  for (int i = 0; i < conditions.count; ++i) {
    scale_to_unit(conditions.g[i], order, h, unit.g[i]);
    require_finite(unit.g[i], order);
    orders[i] = deflate(unit.g[i], order, conditions.zeros_at_start[i]);
  }
  // mostly the powers show that one of them fails throughout
  for (int i = 0; i < conditions.count; ++i)
    if (range_on_unit(unit.g[i], orders[i]).high <= 0.0) return {};
  for (int i = 0; i < conditions.count; ++i) set_bernstein(unit.g[i], orders[i], forms[i]);
  Entry entry = first_entry_on_part(unit, orders, forms, {});
  // inside from the start: through the face on which the point lies
  if (entry.time == 0.0) {
    for (int i = 0; i < conditions.count; ++i)
      if (holds_for_less(forms[i], forms[entry.last])) entry.last = i;
    int on_face = -1;
    for (int i = 0; i < conditions.count; ++i)
      if (conditions.zeros_at_start[i] > 0 && (on_face < 0 || rises_slower(conditions, i, on_face, order))) on_face = i;
    if (on_face >= 0) entry.last = on_face;
  }
  if (entry.time != kNoRoot) entry.time *= h;
  return entry;
}

}  // namespace vibratory_alignment
