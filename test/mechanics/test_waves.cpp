// Sines, cosines and decays of four at once against the C library's in 64 bits.
#include "mechanics/waves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "../support/numbers.h"

namespace vibratory_alignment {
namespace {

using test::kEps;

TEST(Waves, are_good_to_two_digits_of_a_double) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> decade(-12.0, 7.0);
  for (int i = 0; i < 20000; ++i) {
    Waves waves;
    double rate[Waves::kMaxOscillations], decay[Waves::kMaxDecays];
    for (double& r : rate) waves.add_oscillation(r = std::pow(10.0, decade(random)));
    for (double& r : decay) waves.add_decay(r = std::pow(10.0, decade(random) - 4.0));
    const double t = 1.0 + 1e-3 * i;
    Waves::Values values;
    waves.at(t, values);
    for (std::size_t k = 0; k < Waves::kMaxOscillations; ++k) {
      const double angle = 0.5 * rate[k] * t;
      const double sin = static_cast<double>(std::sin(static_cast<long double>(angle)));
      const double cos = static_cast<double>(std::cos(static_cast<long double>(angle)));
      ASSERT_NEAR(values.half_sin[k], sin, kEps) << angle;
      ASSERT_NEAR(values.half_cos[k], cos, kEps) << angle;
      // what is small keeps its own digits
      if (angle < 0.7) {
        ASSERT_NEAR(values.half_sin[k], sin, kEps * angle);
      }
    }
    for (std::size_t k = 0; k < Waves::kMaxDecays; ++k) {
      const double exact = static_cast<double>(std::expm1(static_cast<long double>(-(decay[k] * t))));
      ASSERT_NEAR(values.change[k], exact, 2.0 * kEps * std::abs(exact)) << decay[k] * t;
      // what is left keeps its own digits, but for those of the exponent
      const double exponent = decay[k] * t, left = static_cast<double>(std::exp(static_cast<long double>(-exponent)));
      if (exponent < 700.0) {
        ASSERT_NEAR(values.left[k], left, (2.0 + exponent) * kEps * left) << exponent;
      } else {
        ASSERT_LT(values.left[k], 1e-300) << exponent;
      }
    }
  }
}

TEST(Waves, start_at_nothing) {
  Waves waves;
  const int oscillation = waves.add_oscillation(20.0), decay = waves.add_decay(3.0), still = waves.add_decay(0.0);
  Waves::Values values;
  waves.at(0.0, values);
  EXPECT_EQ(values.half_sin[static_cast<std::size_t>(oscillation)], 0.0);
  EXPECT_EQ(values.half_cos[static_cast<std::size_t>(oscillation)], 1.0);
  EXPECT_EQ(values.change[static_cast<std::size_t>(decay)], 0.0);
  waves.at(1e6, values);
  EXPECT_EQ(values.change[static_cast<std::size_t>(still)], 0.0);
  EXPECT_EQ(values.change[static_cast<std::size_t>(decay)], -1.0);
}

TEST(Waves, keep_their_places_when_begun_anew) {
  Waves waves;
  waves.add_oscillation(1e9);  // beyond what is reduced four at once
  waves.clear();
  EXPECT_EQ(waves.add_oscillation(2.0), 0);
  EXPECT_EQ(waves.add_oscillation(6.0), 1);
  Waves::Values values;
  waves.at(0.5, values);
  EXPECT_NEAR(values.half_sin[1], std::sin(1.5), kEps);
}

TEST(Waves, refuse_more_than_there_is_room_for) {
  Waves waves;
  for (int i = 0; i < Waves::kMaxOscillations; ++i) waves.add_oscillation(1.0);
  EXPECT_THROW(waves.add_oscillation(1.0), std::length_error);
  for (int i = 0; i < Waves::kMaxDecays; ++i) waves.add_decay(1.0);
  EXPECT_THROW(waves.add_decay(1.0), std::length_error);
}

}  // namespace
}  // namespace vibratory_alignment
