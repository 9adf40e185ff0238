// Values, integrals and maxima of truncated series, against 113-bit evaluation.
#include "solver/series.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "../support/polynomials.h"

namespace vibratory_alignment {
namespace {

using test::exact_value;
using test::Float128;
using test::noise;

Series random_series(std::mt19937& random, int order) {
  std::normal_distribution<double> normal;
  Series g{};
  for (int k = 0; k <= order; ++k) g[k] = normal(random);
  return g;
}

/// sin(frequency t + phase).
Series sine_series(int order, double frequency, double phase) {
  Series g{};
  double factor = 1.0;
  for (int k = 0; k <= order; ++k) {
    g[k] = factor * std::sin(phase + 0.5 * 3.14159265358979323846 * k);
    factor *= frequency / (k + 1);
  }
  return g;
}

TEST(Series, value) {
  std::mt19937 random(61);
  for (int order = 0; order <= kMaxOrder; ++order) {
    const Series g = random_series(random, order);
    for (const double t : {0.0, 0.3, -0.7, 1.0})
      EXPECT_NEAR(value_at(g, order, t), static_cast<double>(exact_value(g, order, t)),
                  2.0 * noise(g, order, std::abs(t)));
  }
}

TEST(Series, product) {
  std::mt19937 random(62);
  const Series a = random_series(random, 12), b = random_series(random, 12);
  Series product{};
  for (int k = 0; k <= 24; ++k) {
    for (int j = 0; j <= 12; ++j)
      if (k - j >= 0 && k - j <= 12) product[k] += a[j] * b[k - j];
    EXPECT_NEAR(product_term(a, b, k), product[k], 1e-14);
  }
}

TEST(Series, integral) {
  std::mt19937 random(63);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    const int order = i % (kMaxOrder + 1);
    const Series g = random_series(random, order);
    const double from = u(random), to = u(random);
    Float128 exact = 0, power_from = 1, power_to = 1;
    double size = 0.0;
    for (int k = 0; k <= order; ++k) {
      power_from *= Float128(from);
      power_to *= Float128(to);
      exact += Float128(g[k]) * (power_to - power_from) / Float128(k + 1);
      size += std::abs(g[k]) / (k + 1);
    }
    EXPECT_NEAR(integral(g, order, from, to), static_cast<double>(exact), 1e-15 * size);
  }
}

/// The maximum on [from, to] by sampling and, about the best sample, by ternary search.
double sampled_maximum(const Series& g, int order, double from, double to) {
  const int samples = 1000;
  Float128 best = exact_value(g, order, from);
  double at = from;
  for (int i = 1; i <= samples; ++i) {
    const double t = from + (to - from) * i / samples;
    const Float128 value = exact_value(g, order, t);
    if (value > best) {
      best = value;
      at = t;
    }
  }
  double low = std::max(from, at - (to - from) / samples), high = std::min(to, at + (to - from) / samples);
  for (int i = 0; i < 80; ++i) {
    const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
    (exact_value(g, order, a) < exact_value(g, order, b) ? low : high) =
        exact_value(g, order, a) < exact_value(g, order, b) ? a : b;
  }
  return static_cast<double>(std::max(best, exact_value(g, order, 0.5 * (low + high))));
}

TEST(LargestValue, of_random_series) {
  std::mt19937 random(64);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (int i = 0; i < 400; ++i) {
    const int order = i % (kMaxOrder + 1);
    const Series g = random_series(random, order);
    double from = u(random), to = u(random);
    if (from > to) std::swap(from, to);
    if (i % 2 == 0) from = 0.0;
    EXPECT_NEAR(largest_value(g, order, from, to), sampled_maximum(g, order, from, to), 20.0 * noise(g, order, 1.0))
        << i;
  }
}

// Several maxima of different height: an oscillation on a slope.
TEST(LargestValue, of_series_with_many_maxima) {
  for (const double slope : {0.3, -0.3, 0.0})
    for (const double phase : {0.0, 1.0, 2.5, 4.0}) {
      Series g = sine_series(24, 9.0, phase);
      g[1] += slope;
      for (const double from : {0.0, 0.2, 0.45})
        EXPECT_NEAR(largest_value(g, 24, from, 1.0), sampled_maximum(g, 24, from, 1.0), 20.0 * noise(g, 24, 1.0))
            << slope << " " << phase << " " << from;
    }
}

TEST(LargestValue, at_the_ends) {
  Series rising{};
  rising[0] = 1.0;
  rising[1] = 2.0;
  rising[3] = 0.5;
  EXPECT_NEAR(largest_value(rising, 3, 0.0, 0.7), 1.0 + 1.4 + 0.5 * 0.343, 1e-15);
  for (double& c : rising) c = -c;
  EXPECT_NEAR(largest_value(rising, 3, 0.0, 0.7), -1.0, 1e-15);
  EXPECT_NEAR(largest_value(rising, 3, 0.7, 0.7), -(1.0 + 1.4 + 0.5 * 0.343), 1e-15);
}

// A start with zero slope, as every contact begins that touches without base damping.
TEST(LargestValue, out_of_a_level_start) {
  Series g{};
  g[2] = 3.0;
  g[4] = -4.0;  // 3 t^2 - 4 t^4: largest 9/16 at t^2 = 3/8
  EXPECT_NEAR(largest_value(g, 4, 0.0, 1.0), 0.5625, 1e-15);
  for (double& c : g) c = -c;
  EXPECT_NEAR(largest_value(g, 4, 0.0, 1.0), 1.0, 1e-15);
  EXPECT_NEAR(largest_value(g, 4, 0.0, 0.5), 0.0, 1e-15);
}

// A force whose terms cannot be added has no peak; that ends a trial elsewhere, not where it is looked at.
TEST(LargestValue, of_terms_near_overflow_is_not_a_number) {
  Series g{};
  g[0] = 1.0;
  g[1] = 1e300;
  g[2] = -1e300;
  EXPECT_TRUE(std::isnan(largest_value(g, 2, 0.0, 1e10)));
  EXPECT_TRUE(std::isnan(largest_value(g, 2, 1e10, 1e11)));
  EXPECT_NEAR(largest_value(g, 2, 0.0, 1e-300), 2.0, 1e-15);
}

}  // namespace
}  // namespace vibratory_alignment
