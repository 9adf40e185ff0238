// What is certain about a number that changes with time: held against curves whose third derivative is the bound, one
// way or the other, and against the first zero of the worst of them found by dense sampling.
#include "solver/bounded_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vibratory_alignment {
namespace {

constexpr int kSamples = 2000;

/// A curve of any kind: rates and bends of both signs, jerks from nothing to more than all else.
BoundedCurve random_curve(std::mt19937& random) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const auto any = [&] { return std::copysign(std::pow(10.0, 2.0 * u(random) - 1.0), u(random)); };
  BoundedCurve curve{-std::abs(any()), any(), any(), std::abs(any())};
  if (u(random) > 0.6) curve.jerk = 0.0;
  if (u(random) > 0.8) curve.jerk = 1e-20;
  if (u(random) > 0.8) curve.rate = 0.0;
  if (u(random) > 0.8) curve.acceleration = 0.0;
  return curve;
}

TEST(BoundedCurve, stays_below_zero_as_long_as_it_says) {
  std::mt19937 random(3);
  int cut = 0;
  for (int i = 0; i < 20'000; ++i) {
    const BoundedCurve curve = random_curve(random);
    const double longest = 5.0, time = curve.time_below(longest, false);
    ASSERT_GE(time, 0.0);
    ASSERT_LE(time, longest);
    const auto worst = [&](double s) {
      return curve.value + curve.rate * s + curve.acceleration * s * s / 2 + curve.jerk * s * s * s / 6;
    };
    double first = 0.0;  // sampled time before the first one above zero
    while (first < longest && worst(first + longest / kSamples) <= 0.0) first += longest / kSamples;
    ASSERT_LE(time, std::min(longest, first + 1.01 * longest / kSamples)) << i;
    EXPECT_GE(time, 0.9 * first) << i;
    cut += time < longest;
  }
  EXPECT_GT(cut, 5000);
}

// Up through zero and down again: by how little the third derivative may be anything must not matter.
TEST(BoundedCurve, a_parabola_that_comes_back_is_seen_to_cross) {
  const double crossing = 0.5 - std::sqrt(0.15);  // of -0.1 + s - s^2
  for (const double jerk : {0.0, 1e-300, 1e-20, 1e-12, 1e-6}) {
    const BoundedCurve curve{-0.1, 1.0, -2.0, jerk};
    EXPECT_LE(curve.time_below(10.0, false), crossing) << jerk;
    EXPECT_GE(curve.time_below(10.0, false), 0.9 * crossing) << jerk;
  }
}

// From zero on downwards it is judged by when it comes back; upwards it is above at once.
TEST(BoundedCurve, one_that_starts_at_zero_is_judged_by_what_follows) {
  const BoundedCurve back{0.0, -1.0, 2.0, 0.0};
  EXPECT_NEAR(back.time_below(10.0, true), 1.0, 1e-15);
  const BoundedCurve with_jerk{1e-17, -1.0, 2.0, 6.0};  // 6 s^2 / 6 + s - 1 = 0
  EXPECT_NEAR(with_jerk.time_below(10.0, true), 0.5 * (std::sqrt(5.0) - 1.0), 1e-15);
  const BoundedCurve bending_down{-1e-17, -1.0, -2.0, 6.0};
  EXPECT_NEAR(bending_down.time_below(10.0, true), 0.5 * (std::sqrt(5.0) + 1.0), 1e-15);
  for (const double bend : {0.0, -1.0}) EXPECT_EQ((BoundedCurve{0.0, -1.0, bend, 0.0}.time_below(10.0, true)), 10.0);
  EXPECT_EQ((BoundedCurve{0.0, 1.0, 2.0, 0.0}.time_below(10.0, true)), 0.0);
  EXPECT_EQ((BoundedCurve{0.0, -1.0, 2.0, 0.0}.time_below(10.0, false)), 0.0);
}

// What is no number, or beyond all numbers, is certain of nothing.
TEST(BoundedCurve, no_time_is_told_where_a_number_is_missing) {
  for (const double missing : {std::nan(""), HUGE_VAL})
    for (const double rate : {-1.0, 0.0, 1.0})
      for (const double acceleration : {-1.0, 0.0, 1.0}) {
        EXPECT_EQ((BoundedCurve{-1.0, rate, acceleration, missing}.time_below(10.0, false)), 0.0);
        EXPECT_EQ((BoundedCurve{-1.0, rate, missing, 1.0}.time_below(10.0, false)), 0.0);
      }
  for (const double missing : {std::nan(""), HUGE_VAL})
    for (const double acceleration : {-1.0, 0.0, 1.0}) {
      EXPECT_EQ((BoundedCurve{0.0, -1.0, acceleration, missing}.time_below(10.0, true)), 0.0);
      EXPECT_EQ((BoundedCurve{0.0, -1.0, missing, 1.0}.time_below(10.0, true)), 0.0);
      EXPECT_EQ((BoundedCurve{0.0, -1.0, -missing, 1.0}.time_below(10.0, true)), 0.0);
    }
  EXPECT_LE((BoundedCurve{0.0, -1e200, 0.0, 1e200}.time_below(10.0, true)), std::sqrt(6.0));
  // -1 + 1e200 (s - s^2 / 2) is above zero soon, but the square of a coefficient is no number
  EXPECT_LE((BoundedCurve{-1.0, 1e200, -1e200, 0.0}.time_below(10.0, false)), 1.01e-200);
  EXPECT_EQ((BoundedCurve{-1.0, NAN, 1.0, 1.0}.time_below(10.0, false)), 0.0);
  EXPECT_EQ((BoundedCurve{NAN, 1.0, 1.0, 1.0}.time_below(10.0, false)), 0.0);
}

TEST(BoundedCurve, what_is_told_of_its_sign_and_slope_holds_for_every_curve_within_the_bound) {
  std::mt19937 random(5);
  int above = 0, rising = 0, risen = 0;
  for (int i = 0; i < 20'000; ++i) {
    const BoundedCurve curve = random_curve(random), opposite = curve.negative();
    const double span = 0.3;
    const bool stays = opposite.stays_above(span), rises = curve.rises(span);
    above += stays;
    rising += rises;
    for (const double jerk : {-curve.jerk, curve.jerk})
      for (int k = 1; k <= 20; ++k) {
        const double s = span * k / 20;
        const double value = curve.value + curve.rate * s + curve.acceleration * s * s / 2 + jerk * s * s * s / 6;
        const double slope = curve.rate + curve.acceleration * s + jerk * s * s / 2;
        const double rounding =
            1e-14 * (std::abs(curve.value) + std::abs(curve.rate) + std::abs(curve.acceleration) + curve.jerk);
        ASSERT_TRUE(!stays || value < 0.0) << i;
        ASSERT_TRUE(!rises || slope > -rounding) << i;
        ASSERT_LE(curve.lowest(s), value + rounding) << i;
        ASSERT_GE(curve.highest(s), value - rounding) << i;
      }
    const double estimate = curve.estimated_rise();
    if (std::isinf(estimate)) continue;
    ++risen;
    const double s = estimate, terms = std::abs(curve.value) + std::abs(curve.rate * s) + curve.acceleration * s * s;
    EXPECT_GT(s, 0.0);
    EXPECT_NEAR(curve.value + curve.rate * s + curve.acceleration * s * s / 2, 0.0, 1e-12 * std::abs(terms)) << i;
    EXPECT_GE(curve.rate + curve.acceleration * s, -1e-6 * std::abs(curve.rate)) << i;
  }
  EXPECT_GT(above, 1000);
  EXPECT_GT(rising, 1000);
  EXPECT_GT(risen, 5000);
}

}  // namespace
}  // namespace vibratory_alignment
