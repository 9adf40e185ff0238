// tanh of four at once against the C library's in 64 bits; what is compiled for AVX against what is not. (Sines and
// decays: test_waves.cpp.)
#include "mechanics/quad_functions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "../support/numbers.h"

namespace vibratory_alignment {
namespace {

using test::kEps;

void fill_randomly(std::mt19937_64& random, Quad& x) {
  std::uniform_real_distribution<double> decade(-20.0, 3.0), sign(-1.0, 1.0);
  for (int i = 0; i < 4; ++i) x[i] = std::copysign(std::pow(10.0, decade(random)), sign(random));
}

TEST(QuadFunctions, tanh_is_good_to_two_digits_of_a_double) {
  std::mt19937_64 random(3);
  for (int k = 0; k < 20000; ++k) {
    Quad x, tanh, tanh_of_minus;
    fill_randomly(random, x);
    const Quad minus = -x;
    tanh_of(x, tanh);
    tanh_of(minus, tanh_of_minus);
    for (int i = 0; i < 4; ++i) {
      const double exact = static_cast<double>(std::tanh(static_cast<long double>(x[i])));
      ASSERT_NEAR(tanh[i], exact, 2.0 * kEps * std::abs(exact)) << x[i];
      ASSERT_EQ(tanh_of_minus[i], -tanh[i]) << x[i];
      ASSERT_LE(std::abs(tanh[i]), 1.0) << x[i];
    }
  }
}

TEST(QuadFunctions, are_the_same_to_the_bit_on_every_processor) {
  std::mt19937_64 random(5);
  for (int k = 0; k < 2000; ++k) {
    Quad x;
    fill_randomly(random, x);
    const Quad fall = x < 0.0 ? x : -x;
    const auto all = [&](Quad(&values)[5]) VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
      tanh_of(x, values[0]);
      sin_cos(x, values[1], values[2]);
      exp_change(fall, values[3], values[4]);
    };
    Quad widely[5], narrowly[5];
    run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA { all(widely); });
    all(narrowly);
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 4; ++i) ASSERT_EQ(widely[j][i], narrowly[j][i]) << x[i] << " " << j;
  }
}

}  // namespace
}  // namespace vibratory_alignment
