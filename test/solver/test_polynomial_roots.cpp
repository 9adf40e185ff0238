// Roots against polynomials whose roots are known, and against 113-bit samples of random ones. The claim to test is
// that nothing is sampled: double, clustered and grazing roots are decided by the polynomial down to its last digit.
#include "solver/polynomial_roots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "../support/polynomials.h"
#include "solver/solver.h"

namespace vibratory_alignment {
namespace {

using test::exact_value;
using test::from_roots;
using test::noise;

Series times_rising(Series g, int order, double root) {
  // (t + root) g
  for (int k = order + 1; k > 0; --k) g[k] = g[k] * root + g[k - 1];
  g[0] *= root;
  return g;
}

TEST(FirstFall, finds_a_simple_root) {
  for (const double root : {1e-12, 1e-3, 0.25, 0.6180339887, 0.999999})
    for (const double h : {1e-9, 1.0, 1e7}) {
      Series g{};
      g[0] = root * h;
      g[1] = -1.0;
      EXPECT_NEAR(first_fall(g, 1, h, 0), root * h, 4e-16 * root * h);
    }
}

TEST(FirstFall, sees_nothing_beyond_the_interval_or_rising) {
  const Series g = from_roots({0.7});
  EXPECT_EQ(first_fall(g, 1, 0.69, 0), kNoRoot);
  EXPECT_EQ(first_fall(from_roots({-0.2}, -1.0), 1, 1.0, 0), kNoRoot);
  Series constant{};
  constant[0] = 1e-300;
  EXPECT_EQ(first_fall(constant, 10, 1.0, 0), kNoRoot);
}

// Wherever it is among the coefficients, also of a polynomial that would stay far above zero without it.
TEST(FirstFall, refuses_what_is_not_a_number) {
  for (const int order : {1, 2, 3, 6, 17, kMaxOrder})
    for (int k = 0; k <= order; ++k) {
      Series g{};
      g[0] = 1.0;
      g[k] = std::nan("");
      EXPECT_THROW(first_fall(g, order, 1.0, 0), SolverFailure) << "coefficient " << k << " of " << order;
    }
}

// The first fall is the least root; the allowed error is the polynomial's last digit over its slope there.
TEST(FirstFall, takes_the_first_of_many_roots) {
  std::mt19937 random(51);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    const int count = 1 + i % 9;
    std::vector<double> roots;
    for (int k = 0; k < count; ++k) roots.push_back(1.6 * u(random) + 0.01);
    std::sort(roots.begin(), roots.end());
    const Series g = from_roots(roots);
    double slope = 1.0;
    for (int k = 1; k < count; ++k) slope *= roots[static_cast<std::size_t>(k)] - roots[0];
    const double error = 8.0 * noise(g, count, roots[0]) / slope;
    const double found = first_fall(g, count, 1.0, 0);
    if (error > 1e-3) continue;  // a cluster that the rounded coefficients do not resolve
    if (roots[0] < 1.0 - error) {
      EXPECT_NEAR(found, roots[0], error) << "case " << i;
    } else if (roots[0] > 1.0 + error) {
      EXPECT_EQ(found, kNoRoot) << "case " << i;
    }
  }
}

// Nothing below zero before the answer, and a sign change at it: in 113 bits, whatever the polynomial.
TEST(FirstFall, agrees_with_dense_samples_of_random_polynomials) {
  std::mt19937 random(52);
  std::normal_distribution<double> normal;
  int with_root = 0;
  for (int i = 0; i < 1500; ++i) {
    const int order = 2 + i % 21;
    Series g{};
    for (int k = 0; k <= order; ++k) g[k] = normal(random);
    g[0] = std::abs(g[0]) * (i % 3 == 0 ? 0.03 : 1.0);
    const double found = first_fall(g, order, 1.0, 0);
    const double end = found == kNoRoot ? 1.0 : found;
    for (int k = 0; k <= 400; ++k) {
      const double t = end * k / 400.0;
      const bool last = k == 400 && found != kNoRoot;
      ASSERT_GE(static_cast<double>(exact_value(g, order, t)), last ? -1.0 : -4.0 * noise(g, order, t)) << "case " << i;
    }
    if (found == kNoRoot) continue;
    ++with_root;
    EXPECT_LE(std::abs(static_cast<double>(exact_value(g, order, found))), 16.0 * noise(g, order, found))
        << "case " << i;
    EXPECT_LT(static_cast<double>(exact_value(g, order, found * (1.0 + 1e-6) + 1e-9)), noise(g, order, found))
        << "case " << i;
  }
  EXPECT_GT(with_root, 500);
}

// (t - 3/8)^2 + gap, all coefficients exact in binary: the sign of the gap decides, however small.
TEST(FirstFall, decides_a_grazing_root_by_the_last_digit) {
  for (const double size : {1e-6, 1e-9, 1e-12, 1e-15, 1.2e-16}) {
    Series g{};
    g[1] = -0.75;
    g[2] = 1.0;
    g[0] = 0.140625 + size;
    EXPECT_EQ(first_fall(g, 2, 1.0, 0), kNoRoot) << size;
    g[0] = 0.140625 - size;
    const double gap = 0.140625 - g[0];  // what is left of it in g
    EXPECT_NEAR(first_fall(g, 2, 1.0, 0), 0.375 - std::sqrt(gap), 3e-17 / std::sqrt(gap) + 1e-16) << size;
  }
}

// The same hidden in a polynomial of high order, off every binary place: two roots 2 sqrt(gap) apart, or none.
TEST(FirstFall, sees_grazing_roots_of_high_order_polynomials) {
  for (const double gap : {1e-9, 1e-11, 1e-13})
    for (const double r : {0.1234567, 0.3333333, 0.71, 0.937}) {
      for (const double sign : {1.0, -1.0}) {
        Series g{};
        g[0] = r * r + sign * gap;
        g[1] = -2.0 * r;
        g[2] = 1.0;
        int order = 2;
        for (const double root : {1.7, 2.3, 1.1, 3.9, 1.3, 5.0}) g = times_rising(g, order++, root);
        const double found = first_fall(g, order, 1.0, 0);
        if (sign > 0.0) {
          EXPECT_EQ(found, kNoRoot) << r << " " << gap;
        } else {
          EXPECT_NEAR(found, r - std::sqrt(gap), 1e-15 / std::sqrt(gap)) << r;
        }
      }
    }
}

TEST(FirstFall, sees_a_short_dip_between_two_roots) {
  for (const double width : {1e-2, 1e-4, 1e-6, 1e-7})
    for (const double r : {0.1, 0.37, 0.5, 0.75, 0.9}) {
      const Series g = from_roots({r, r + width, 1.5, 2.0, -1.0}, -1.0);
      const double found = first_fall(g, 5, 1.0, 0);
      const double slope = width * (1.5 - r) * (2.0 - r) * (1.0 + r);
      ASSERT_NE(found, kNoRoot);
      EXPECT_NEAR(found, r, 8.0 * noise(g, 5, r) / slope) << width;
    }
}

TEST(FirstFall, follows_a_triple_root_through) {
  const Series g = from_roots({0.25, 0.25, 0.25});
  EXPECT_NEAR(first_fall(g, 3, 1.0, 0), 0.25, 1e-5);  // cube root of the last digit
}

TEST(FirstFall, pinned_zeros_are_left_out) {
  // t (0.3 - t), t^2 (0.3 - t)
  Series once{}, twice{};
  once[1] = twice[2] = 0.3;
  once[2] = twice[3] = -1.0;
  EXPECT_NEAR(first_fall(once, 2, 1.0, 1), 0.3, 1e-16);
  EXPECT_NEAR(first_fall(twice, 3, 1.0, 2), 0.3, 1e-16);
  // whatever rounding left in the pinned places
  for (const double rest : {1e-17, -1e-17}) {
    once[0] = twice[0] = rest;
    twice[1] = -rest;
    EXPECT_NEAR(first_fall(once, 2, 1.0, 1), 0.3, 1e-16);
    EXPECT_NEAR(first_fall(twice, 3, 1.0, 2), 0.3, 1e-16);
  }
  // what falls out of its pin falls at once
  once[1] = -0.3;
  EXPECT_EQ(first_fall(once, 2, 1.0, 1), 0.0);
}

TEST(FirstFall, starts_below_zero_for_want_of_the_last_digit) {
  Series g{};
  g[0] = -1e-18;
  g[1] = 1.0;
  g[2] = -2.0;
  EXPECT_NEAR(first_fall(g, 2, 1.0, 0), 0.5, 1e-15);
  g[1] = -1.0;
  EXPECT_EQ(first_fall(g, 2, 1.0, 0), 0.0);
}

// What it says to stay above zero has no fall; with a first term above the sum of the others it says so.
TEST(StaysAboveZero, is_never_said_of_what_falls) {
  std::mt19937 random(83);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  int said = 0;
  for (int i = 0; i < 4000; ++i) {
    const int order = 1 + i % kMaxOrder;
    const double h = std::pow(10.0, 2.0 * u(random));
    Series g{};
    double sum = 0.0;
    for (int k = 1; k <= order; ++k) {
      g[k] = u(random) * std::pow(h, -k);
      sum += std::abs(g[k]) * std::pow(h, k);
    }
    g[0] = sum * (1.0 + u(random));
    const bool stays = stays_above_zero(g, order, h);
    EXPECT_TRUE(!stays || first_fall(g, order, h, 0) == kNoRoot) << i;
    EXPECT_TRUE(stays || g[0] <= 1.0001 * sum) << i;
    EXPECT_FALSE(stays && exact_value(g, order, h) < 0) << i;
    said += stays;
  }
  EXPECT_GT(said, 2000);
}

TEST(StaysAboveZero, is_not_said_of_what_is_not_a_number) {
  for (const int order : {1, 2, 3, 17})
    for (int k = 0; k <= order; ++k) {
      Series g{};
      g[0] = 1.0;
      g[k] = std::nan("");
      EXPECT_FALSE(stays_above_zero(g, order, 1.0)) << "coefficient " << k << " of " << order;
    }
}

// N of a ring: what it says to stay below has no value above, and it says so where the level is a quarter beyond.
TEST(StaysBelow, bounds_a_ring_closely) {
  constexpr int kOrder = 34;
  constexpr double kTime = 6.5;
  for (const double angle : {0.0, 1.0, 2.5, 4.0}) {
    Series ring{};
    double term = 0.5;  // 1 + cos(t + angle)/2
    for (int k = 0; k <= kOrder; ++k) {
      ring[static_cast<std::size_t>(k)] = term * std::cos(angle + 0.5 * M_PI * k);
      term /= k + 1;
    }
    ring[0] += 1.0;
    EXPECT_TRUE(stays_below(ring, kOrder, kTime, 1.65)) << angle;
    EXPECT_FALSE(stays_below(ring, kOrder, kTime, 1.49)) << angle;
    ring[20] = std::nan("");
    EXPECT_FALSE(stays_below(ring, kOrder, kTime, 1e9)) << angle;
  }
}

/// Where a polynomial with these sorted roots and this sign before the first is positive within [0, 1].
std::vector<std::pair<double, double>> positive_parts(const std::vector<double>& roots, bool positive) {
  std::vector<std::pair<double, double>> parts;
  double from = 0.0;
  for (const double root : roots) {
    if (positive) parts.emplace_back(from, root);
    from = root;
    positive = !positive;
  }
  if (positive) parts.emplace_back(from, 1.0);
  return parts;
}

// Conditions with known roots: the first instant at which all are positive, and which of them came last, from
// intervals.
TEST(FirstEntry, agrees_with_known_intervals) {
  std::mt19937 random(53);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  int entries = 0;
  for (int i = 0; i < 3000; ++i) {
    Conditions conditions;
    conditions.count = 1 + i % 4;
    std::vector<std::vector<std::pair<double, double>>> parts;
    bool resolved = true;
    for (int c = 0; c < conditions.count; ++c) {
      std::vector<double> roots;
      const int count = static_cast<int>(4.0 * u(random));
      for (int k = 0; k < count; ++k) roots.push_back(u(random));
      std::sort(roots.begin(), roots.end());
      for (std::size_t k = 1; k < roots.size(); ++k) resolved = resolved && roots[k] - roots[k - 1] > 1e-3;
      const bool positive = u(random) > (roots.empty() ? 0.1 : 0.6);
      conditions.g[static_cast<std::size_t>(c)] = from_roots(roots, positive ? 1.0 : -1.0);
      parts.push_back(positive_parts(roots, positive));
    }
    if (!resolved) continue;
    // first point of the intersection: it begins at a start of one of the parts
    double expected = kNoRoot;
    int last = -1;
    for (std::size_t c = 0; c < parts.size(); ++c)
      for (const auto& part : parts[c]) {
        const double t = part.first;
        const bool all = std::all_of(parts.begin(), parts.end(), [&](const auto& other) {
          return std::any_of(other.begin(), other.end(), [&](const auto& p) { return p.first <= t && t < p.second; });
        });
        if (all && (expected == kNoRoot || t < expected)) {
          expected = t;
          last = static_cast<int>(c);
        }
      }
    const Entry entry = first_entry(conditions, 6, 1.0);
    if (expected == kNoRoot) {
      EXPECT_EQ(entry.time, kNoRoot) << "case " << i;
      continue;
    }
    EXPECT_NEAR(entry.time, expected, 1e-9) << "case " << i;
    if (expected == 0.0) continue;
    ++entries;
    EXPECT_EQ(entry.last, last) << "case " << i;
  }
  EXPECT_GT(entries, 300);
}

// Crossings at the very points at which intervals are halved, where rounding may set the two halves at odds.
TEST(FirstEntry, names_the_condition_that_became_true_last) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  std::normal_distribution<double> normal;
  int entries = 0;
  for (int i = 0; i < 200'000; ++i) {
    Conditions conditions;
    conditions.count = 2 + i % 4;
    const int order = 2 + i % 23;
    for (int c = 0; c < conditions.count; ++c) {
      Series& g = conditions.g[c];
      g = {};
      for (int k = 1; k <= order; ++k) g[k] = normal(random) * std::pow(2.0, -k);
      g[0] = 0.7 * normal(random);
    }
    Series& crossing = conditions.g[i % conditions.count];
    crossing[0] = 0.0;
    crossing[0] = -value_at(crossing, order, (1 + i % 15) / 16.0);
    const Entry entry = first_entry(conditions, order, 1.0);
    if (!(entry.time > 0.0)) continue;
    ++entries;
    ASSERT_NEAR(value_at(conditions.g[entry.last], order, entry.time), 0.0, 1e-9) << i;
  }
  EXPECT_GT(entries, 20'000);
}

// An edge that clips a corner: inside both conditions for as short as 1e-12 of the time until then, or missing it by as
// little; early in a long step as well.
TEST(FirstEntry, a_clipped_corner_is_seen_and_a_missed_one_is_not_invented) {
  for (const double width : {1e-3, 1e-6, 1e-9, 1e-12})
    for (const double at : {1e-15, 1e-6, 0.1, 0.3, 0.55, 0.98})
      for (const double sign : {1.0, -1.0}) {
        Conditions conditions;
        conditions.count = 2;
        conditions.g[0] = from_roots({at}, -1.0);                     // t - at
        conditions.g[1] = from_roots({at + sign * width * at}, 1.0);  // at +- width at - t
        const Entry entry = first_entry(conditions, 1, 1.0);
        if (sign < 0.0) {
          EXPECT_EQ(entry.time, kNoRoot) << width;
        } else {
          EXPECT_NEAR(entry.time, at, 4e-16 * at);
          EXPECT_EQ(entry.last, 0);
        }
      }
}

// A point on its face (pinned) that leaves it is outside; one that comes back enters then.
TEST(FirstEntry, a_pinned_condition_starts_outside) {
  Conditions conditions;
  conditions.count = 2;
  conditions.zeros_at_start[0] = 1;
  conditions.g[0] = {};
  conditions.g[0][1] = -0.4;
  conditions.g[0][2] = 1.0;  // t (t - 0.4)
  conditions.g[1] = {};
  conditions.g[1][0] = 1.0;
  for (const double rest : {0.0, 1e-17, -1e-17}) {
    conditions.g[0][0] = rest;
    EXPECT_NEAR(first_entry(conditions, 2, 1.0).time, 0.4, 1e-16);
    EXPECT_EQ(first_entry(conditions, 2, 0.39).time, kNoRoot);
  }
}

// From the start inside all of them: through the one that holds for the shortest time, whatever becomes of another.
TEST(FirstEntry, inside_already_is_through_what_holds_for_the_shortest_time) {
  for (const double bend : {0.0, -20.0}) {
    Conditions conditions;
    conditions.count = 3;
    conditions.g[0] = {4e-14, 1.0};
    conditions.g[1] = {10.0, 1.0, bend};
    conditions.g[2] = {5.0};
    const Entry entry = first_entry(conditions, 4, 1.0);
    EXPECT_EQ(entry.time, 0.0);
    EXPECT_EQ(entry.last, 0) << bend;
  }
}

TEST(FirstEntry, inside_already_is_now) {
  Conditions conditions;
  conditions.count = 2;
  conditions.g[0] = {};
  conditions.g[1] = {};
  conditions.g[0][0] = conditions.g[1][0] = 0.1;
  conditions.g[1][1] = -1.0;
  EXPECT_EQ(first_entry(conditions, 1, 1.0).time, 0.0);
}

// One that starts with zero, and rises however slowly, becomes true now: not one that holds already.
TEST(FirstEntry, from_zero_is_by_the_condition_that_starts_there) {
  for (const int power : {1, 2, 5})
    for (const int first : {0, 1}) {
      Conditions conditions;
      conditions.count = 2;
      conditions.g[0] = conditions.g[1] = {};
      conditions.g[static_cast<std::size_t>(first)][static_cast<std::size_t>(power)] = 1e-3;
      Series& holds = conditions.g[static_cast<std::size_t>(1 - first)];
      holds[0] = 0.2;
      holds[1] = 1.0;
      const Entry entry = first_entry(conditions, 6, 1.0);
      EXPECT_EQ(entry.time, 0.0) << power;
      EXPECT_EQ(entry.last, first) << power;
    }
}

// Inside from the start, by what the step before was wrong by: through the face that was crossed last, however little
// another condition, which is about to fail, still holds by.
TEST(FirstEntry, inside_already_came_in_by_the_condition_that_has_held_for_the_shortest_time) {
  for (const double left : {1e-3, 1e-9, 1e-14})
    for (const int first : {0, 1}) {
      Conditions conditions;
      conditions.count = 3;
      for (Series& g : conditions.g) g = {};
      Series &leaves = conditions.g[static_cast<std::size_t>(first)],
             &entered = conditions.g[static_cast<std::size_t>(1 - first)], &before = conditions.g[2];
      leaves[0] = left;
      leaves[1] = -8.0;
      entered[0] = 40.0 * left;
      entered[1] = 0.2;
      before[0] = 10.0 * left;
      before[1] = 1e-3;
      const Entry entry = first_entry(conditions, 1, 1.0);
      EXPECT_EQ(entry.time, 0.0) << left;
      EXPECT_EQ(entry.last, 1 - first) << left;
    }
}

}  // namespace
}  // namespace vibratory_alignment
