// How far a power series may be used, on functions of a power of the time: of their terms most vanish.
#include "solver/step_size.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

constexpr double kLoss = 1e-10, kQuarterTurn = 1.5707963267948966;

/// cos and sin of angle + t^power, up to t^kMaxOrder.
PairSeries turning(double angle, int power) {
  PairSeries series{};
  double factorial = 1.0;
  for (int k = 0; k * power <= kMaxOrder; ++k) {
    if (k > 0) factorial *= k;
    const double turned = angle + k * kQuarterTurn;
    series[k * power] = Pair{std::cos(turned) / factorial, std::sin(turned) / factorial};
  }
  return series;
}

/// What the series up to `order` lack at h.
double error_of(double angle, int power, int order, double h) {
  const PairSeries series = turning(angle, power);
  double c = 0.0, s = 0.0;
  for (int k = order; k >= 0; --k) {
    c = c * h + series[k][0];
    s = s * h + series[k][1];
  }
  const double turned = angle + std::pow(h, power);
  return std::max(std::abs(c - std::cos(turned)), std::abs(s - std::sin(turned)));
}

class StepSizeOf : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(power, StepSizeOf, testing::Values(1, 2, 3));

TEST_P(StepSizeOf, a_direction_keeps_the_tolerance_whatever_terms_vanish) {
  for (const double angle : {0.1, 0.7, 2.0})
    for (int order = 12; order <= 22; ++order) {
      const double step = pair_step(turning(angle, GetParam()), order, kLoss);
      ASSERT_LT(step, 10.0) << order;
      EXPECT_LT(error_of(angle, GetParam(), order, step), kLoss) << order;
      EXPECT_GT(error_of(angle, GetParam(), order, 3.0 * step), kLoss) << order;
    }
}

TEST_P(StepSizeOf, a_velocity_keeps_the_tolerance_whatever_terms_vanish) {
  const System system = make_system(test::scene_of(test::plain));
  for (const double angle : {0.1, 0.7, 2.0})
    for (int order = 12; order <= 22; ++order) {
      const PairSeries pair = turning(angle, GetParam());
      Segment segment;
      segment.order = order;
      for (int k = 0; k <= kMaxOrder; ++k) segment.vx[k] = pair[k][0];
      const double step = series_step(system, segment, kLoss);
      ASSERT_LT(step, 10.0) << order;
      EXPECT_LT(error_of(angle, GetParam(), order, step), kLoss) << order;
    }
}

}  // namespace
}  // namespace vibratory_alignment
