// Bernstein coefficients against their definition in 113 bits, and what they say of ranges and zeros against
// polynomials whose values and zeros are known.
#include "solver/bernstein.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "../support/polynomials.h"

namespace vibratory_alignment {
namespace {

using test::exact_value;
using test::Float128;
using test::from_roots;
using test::noise;

BernsteinForm form_of(const Series& g, int order) {
  BernsteinForm form;
  set_bernstein(g, order, form);
  return form;
}

Series random_series(int order, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Series g{};
  for (int k = 0; k <= order; ++k) g[static_cast<std::size_t>(k)] = normal(random);
  return g;
}

/// cos(rate t + angle), to machine precision where the order allows.
Series cosine(double rate, double angle, int order) {
  Series g{};
  double term = 1.0;
  for (int k = 0; k <= order; ++k) {
    g[static_cast<std::size_t>(k)] = term * std::cos(angle + 0.5 * M_PI * k);
    term *= rate / (k + 1);
  }
  return g;
}

// sum b_j C(n, j) t^j (1 - t)^(n - j), from the left.
Float128 value_of(const BernsteinForm& form, double t) {
  std::vector<Float128> b(form.b.begin(), form.b.begin() + form.degree + 1);
  for (int r = form.degree; r > 0; --r)
    for (int j = 0; j < r; ++j)
      b[static_cast<std::size_t>(j)] =
          b[static_cast<std::size_t>(j)] * Float128(1.0 - t) + b[static_cast<std::size_t>(j) + 1] * Float128(t);
  return b[0];
}

TEST(Bernstein, coefficients_are_those_of_the_polynomial) {
  std::mt19937 random(11);
  for (int order = 0; order <= kMaxOrder; ++order) {
    const Series g = random_series(order, random);
    const BernsteinForm form = form_of(g, order);
    ASSERT_EQ(form.degree, order);
    for (const double t : {0.0, 0.125, 0.5, 0.8125, 1.0})
      EXPECT_NEAR(static_cast<double>(value_of(form, t) - exact_value(g, order, t)), 0.0, 20.0 * noise(g, order, 1.0))
          << order << " " << t;
    EXPECT_EQ(form.at_start(), g[0]);
    EXPECT_NEAR(form.at_end(), static_cast<double>(exact_value(g, order, 1.0)), 20.0 * noise(g, order, 1.0));
  }
}

TEST(Bernstein, halves_are_the_same_polynomial) {
  std::mt19937 random(12);
  for (int order = 0; order <= kMaxOrder; ++order) {
    const Series g = random_series(order, random);
    BernsteinForm left, right;
    halve(form_of(g, order), left, right);
    ASSERT_EQ(left.degree, order);
    ASSERT_EQ(right.degree, order);
    for (const double t : {0.0, 0.25, 0.625, 1.0}) {
      const double allowed = 40.0 * noise(g, order, 1.0);
      EXPECT_NEAR(static_cast<double>(value_of(left, t) - exact_value(g, order, 0.5 * t)), 0.0, allowed) << order;
      EXPECT_NEAR(static_cast<double>(value_of(right, t) - exact_value(g, order, 0.5 + 0.5 * t)), 0.0, allowed)
          << order;
    }
    EXPECT_EQ(left.at_end(), right.at_start());
  }
}

TEST(Bernstein, the_polynomial_lies_within_its_range) {
  std::mt19937 random(13);
  for (int i = 0; i < 400; ++i) {
    const int order = 1 + i % kMaxOrder;
    const Series g = random_series(order, random);
    const Range range = range_of(form_of(g, order));
    for (int k = 0; k <= 100; ++k) {
      const double value = static_cast<double>(exact_value(g, order, 0.01 * k)), allowed = 4.0 * noise(g, order, 1.0);
      EXPECT_GE(value, range.low - allowed) << i;
      EXPECT_LE(value, range.high + allowed) << i;
    }
  }
}

// b_j is near g(j/n), by max |g''|/(8 n) for a smooth g: cos of 6.5 rad, of which the powers grow to 100, is bounded to
// a quarter with 34.
TEST(Bernstein, the_range_of_a_ring_is_known_closely) {
  constexpr double kRate = 6.5;
  constexpr int kOrder = 34;
  const Range range = range_of(form_of(cosine(kRate, 0.3, kOrder), kOrder));
  EXPECT_LT(range.high, 1.0 + kRate * kRate / (5.0 * kOrder));
  EXPECT_GT(range.low, -1.0 - kRate * kRate / (5.0 * kOrder));
  EXPECT_GE(range.high, 1.0 - 1e-2);
  EXPECT_LE(range.low, -1.0 + 1e-2);
}

// Descartes: as many zeros in (0, 1) as changes of sign, or fewer by an even number; few enough parts of [0, 1] have
// the zeros alone.
TEST(Bernstein, changes_of_sign_count_zeros) {
  std::mt19937 random(14);
  std::uniform_real_distribution<double> u(-1.0, 2.0);
  int exact = 0;
  for (int i = 0; i < 500; ++i) {
    std::vector<double> roots;
    for (int k = 0; k < 1 + i % 7; ++k) roots.push_back(u(random));
    const auto inside = std::count_if(roots.begin(), roots.end(), [](double r) { return r > 0.0 && r < 1.0; });
    const BernsteinForm form = form_of(from_roots(roots), static_cast<int>(roots.size()));
    const int changes = sign_changes(form);
    EXPECT_GE(changes, inside) << i;
    EXPECT_EQ((changes - inside) % 2, 0) << i;
    exact += changes == inside;
    if (changes == 0) continue;
    const double zero = zero_of_coefficients(form);
    EXPECT_GE(zero, 0.0);
    EXPECT_LE(zero, 1.0);
  }
  EXPECT_GT(exact, 350);
}

TEST(Bernstein, coefficients_that_are_zero_change_no_sign) {
  BernsteinForm form;
  form.degree = 4;
  form.b = {1.0, 0.0, 2.0, 0.0, 0.0};
  EXPECT_EQ(sign_changes(form), 0);
  form.b = {0.0, 1.0, 0.0, 0.0, -1.0};
  EXPECT_EQ(sign_changes(form), 1);
  EXPECT_DOUBLE_EQ(zero_of_coefficients(form), 0.625);  // halfway from 1/4 to 4/4
  form.b = {0.0, -1.0, 0.0, 1.0, -1.0};
  EXPECT_EQ(sign_changes(form), 2);
  form.b = {-1.0, 0.0, -2.0, -0.0, 0.0};
  EXPECT_EQ(sign_changes(form), 0);
  form.b = {1.0, -0.0, -0.0, 2.0, 0.0};
  EXPECT_EQ(sign_changes(form), 0);
  form.b = {0.0, -0.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(sign_changes(form), 0);
}

// The line through the coefficients of a straight line is that line.
TEST(Bernstein, a_line_has_its_zero_where_its_coefficients_have) {
  for (const double root : {0.1, 0.5, 0.7}) {
    Series g{};
    g[0] = root;
    g[1] = -1.0;
    for (const int order : {1, 5, 16, 40}) EXPECT_NEAR(zero_of_coefficients(form_of(g, order)), root, 1e-15);
  }
}

}  // namespace
}  // namespace vibratory_alignment
