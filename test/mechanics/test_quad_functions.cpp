// Sines, decays and tanh of four at once against the C library's in 64 bits, compiled for AVX2 and FMA and without.
#include "mechanics/quad_functions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "../support/numbers.h"

namespace vibratory_alignment {
namespace {

using test::kEps;

/// Powers of ten from anywhere between these, with a random sign.
void fill_randomly(std::mt19937_64& random, double least_decade, double largest_decade, Quad& x) {
  std::uniform_real_distribution<double> decade(least_decade, largest_decade), sign(-1.0, 1.0);
  for (int i = 0; i < 4; ++i) x[i] = std::copysign(std::pow(10.0, decade(random)), sign(random));
}

/// Results of a function of four, compiled as widely as the processor allows, and not.
struct Results {
  Quad wide[2], narrow[2];
};
template <typename Function>
Results results_of(const Function& function) {
  Results results;
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA { function(results.wide[0], results.wide[1]); });
  function(results.narrow[0], results.narrow[1]);
  return results;
}

TEST(QuadFunctions, sin_and_cos_are_good_to_a_digit_of_a_double) {
  std::mt19937_64 random(7);
  for (int k = 0; k < 50000; ++k) {
    Quad x;
    fill_randomly(random, -12.0, 7.0, x);
    const Quad angle = x < 0.0 ? -x : x;
    const Results results = results_of([&](Quad& sin, Quad& cos)
                                           VIBRATORY_ALIGNMENT_INLINE_LAMBDA { sin_cos_of_any(angle, 1e7, sin, cos); });
    for (const auto& sin_and_cos : {results.wide, results.narrow})
      for (int i = 0; i < 4; ++i) {
        const double sin = static_cast<double>(std::sin(static_cast<long double>(angle[i])));
        const double cos = static_cast<double>(std::cos(static_cast<long double>(angle[i])));
        // what is small keeps its own digits
        ASSERT_NEAR(sin_and_cos[0][i], sin, kEps * (angle[i] < 0.7 ? angle[i] : 1.0)) << angle[i];
        ASSERT_NEAR(sin_and_cos[1][i], cos, kEps) << angle[i];
      }
  }
}

TEST(QuadFunctions, decays_are_good_to_two_digits_of_a_double) {
  std::mt19937_64 random(11);
  for (int k = 0; k < 50000; ++k) {
    Quad x;
    fill_randomly(random, -16.0, 3.0, x);
    const Quad exponent = x < 0.0 ? x : -x;
    const Results results = results_of([&](Quad& change, Quad& left)
                                           VIBRATORY_ALIGNMENT_INLINE_LAMBDA { exp_change(exponent, change, left); });
    for (const auto& change_and_left : {results.wide, results.narrow})
      for (int i = 0; i < 4; ++i) {
        const auto at = static_cast<long double>(exponent[i]);
        const double change = static_cast<double>(std::expm1(at)), left = static_cast<double>(std::exp(at));
        ASSERT_NEAR(change_and_left[0][i], change, 2.0 * kEps * std::abs(change)) << exponent[i];
        // what is left keeps its own digits
        if (exponent[i] > -700.0) {
          ASSERT_NEAR(change_and_left[1][i], left, 2.0 * kEps * left) << exponent[i];
        } else {
          ASSERT_LT(change_and_left[1][i], 1e-300) << exponent[i];
        }
      }
  }
}

TEST(QuadFunctions, tanh_is_good_to_two_digits_of_a_double) {
  std::mt19937_64 random(3);
  for (int k = 0; k < 20000; ++k) {
    Quad x;
    fill_randomly(random, -20.0, 3.0, x);
    const Quad minus = -x;
    const Results results = results_of([&](Quad& tanh, Quad& tanh_of_minus) VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
      tanh_of(x, tanh);
      tanh_of(minus, tanh_of_minus);
    });
    for (const auto& tanh_and_minus : {results.wide, results.narrow})
      for (int i = 0; i < 4; ++i) {
        const double tanh = static_cast<double>(std::tanh(static_cast<long double>(x[i])));
        ASSERT_NEAR(tanh_and_minus[0][i], tanh, 2.0 * kEps * std::abs(tanh)) << x[i];
        ASSERT_EQ(tanh_and_minus[1][i], -tanh_and_minus[0][i]) << x[i];
        ASSERT_LE(std::abs(tanh_and_minus[0][i]), 1.0) << x[i];
      }
  }
}

TEST(QuadFunctions, start_at_nothing) {
  const Quad nothing{}, long_ago = nothing - 1e9;
  Quad sin, cos, change, left;
  sin_cos_of_any(nothing, 0.0, sin, cos);
  exp_change(nothing, change, left);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(sin[i], 0.0);
    EXPECT_EQ(cos[i], 1.0);
    EXPECT_EQ(change[i], 0.0);
    EXPECT_EQ(left[i], 1.0);
  }
  exp_change(long_ago, change, left);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(change[i], -1.0);
}

}  // namespace
}  // namespace vibratory_alignment
