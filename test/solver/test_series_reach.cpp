// How far series hold, and when they are made longer, on motions whose series and events are known: V, N or T goes as
// a cosine.
#include "solver/series_reach.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../support/scenes.h"
#include "solver/step_size.h"

namespace vibratory_alignment {
namespace {

constexpr double kTolerance = 1e-8, kHalfPi = 1.5707963267948966, kForever = std::numeric_limits<double>::infinity();
constexpr int kOrder = 14;

/// Order of a step that nothing ends.
const int kWithoutEnd = series_order(kTolerance) + 4;

/// size cos(angle + t).
Series cosine(double size, double angle) {
  Series series{};
  double factorial = 1.0;
  for (int k = 0; k <= kMaxOrder; ++k) {
    if (k > 0) factorial *= k;
    series[static_cast<std::size_t>(k)] = size * std::cos(angle + k * kHalfPi) / factorial;
  }
  return series;
}

Series constant(double value) {
  Series series{};
  series[0] = value;
  return series;
}

/// One contact of a part that moves along x by cos(angle + t) and turns, with what limits it at zero when that is.
struct Motion {
  System system = make_system(test::scene_of(test::plain));
  Segment segment;

  Motion(Slip slip, double angle) {
    const double f = system.friction;
    segment.order = kOrder;
    segment.vx = cosine(1.0, angle);
    segment.omega = constant(1e-3);
    segment.contacts[0] = {Phase::loaded, Face::bottom, slip};
    segment.loaded_count = 1;
    ContactSeries& contact = segment.loaded[0];
    contact.normal_force = constant(1.0);
    contact.slip_velocity = constant(slip == Slip::stick ? 0.0 : slip == Slip::minus ? -1.0 : 1.0);
    if (slip == Slip::plus) contact.slip_velocity = cosine(1.0, angle);
    if (slip == Slip::minus) contact.slip_velocity = cosine(-1.0, angle);
    if (slip == Slip::none) contact.normal_force = cosine(1.0, angle);
    if (slip == Slip::stick) {
      contact.tangential_force = cosine(-f, angle);
      contact.tangential_force[0] += f;  // T = f (1 - cos), of which the power asked last is not known
      contact.tangential_force[kOrder] = 0.0;
    }
  }
};

/// Angles from which the cosine is zero at `share` times the time over which its series hold, which depends on them.
double angle_for(Slip slip, double share) {
  double angle = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Motion motion(slip, angle);
    const SeriesReach reach(motion.system, kTolerance, kTolerance);
    angle = 0.5 * (angle + kHalfPi - share * reach.time(motion.segment));
  }
  return angle;
}

int next_order(const Motion& motion, double longest) {
  SeriesReach reach(motion.system, kTolerance, kTolerance);
  reach.begin(longest);
  return reach.next_order(motion.segment);
}

// The terms k of a cosine are t^k/k! or nothing: the last two, between which one has the power `order`, fall to the
// tolerance where t^order = order! times it, but for the estimate of the logarithms.
TEST(SeriesReach, a_cosine_holds_until_its_last_terms_are_due) {
  const Motion motion(Slip::none, 0.3);
  const SeriesReach reach(motion.system, kTolerance, kTolerance);
  const double time = reach.time(motion.segment), due = std::pow(kTolerance * std::tgamma(kOrder), 1.0 / (kOrder - 1));
  EXPECT_NEAR(time, due, 0.15 * due);
}

// Steps of a scene with the tanh law: in the layer, here with a V that stays at zero, far from the poles, they hold to
// the tolerance, outside of it to a tenth.
TEST(SeriesReach, outside_the_tanh_layer_a_step_holds_to_a_tenth_of_the_tolerance) {
  Motion motion(Slip::none, 0.3);
  const auto time = [&](double tolerance) {
    return SeriesReach(motion.system, tolerance, kTolerance).time(motion.segment);
  };
  const double to_all_of_it = time(kTolerance), to_a_tenth = time(0.1 * kTolerance);
  motion.system.regularization = 1e-3;
  EXPECT_EQ(time(kTolerance), to_a_tenth);
  motion.segment.contacts[0].slip = Slip::regularized;
  motion.segment.loaded[0].slip_velocity = constant(0.0);
  EXPECT_EQ(time(kTolerance), to_all_of_it);
  EXPECT_LT(to_a_tenth, 0.9 * to_all_of_it);
}

class SeriesReachOf : public testing::TestWithParam<Slip> {};
INSTANTIATE_TEST_SUITE_P(every_law, SeriesReachOf, testing::Values(Slip::none, Slip::plus, Slip::minus));

// An event within reach needs no more powers; one that is far is not near that of a step which nothing ends.
TEST_P(SeriesReachOf, powers_are_added_for_what_is_just_beyond) {
  for (const double share : {0.8, 0.97}) {
    const Motion motion(GetParam(), angle_for(GetParam(), share));
    EXPECT_EQ(next_order(motion, kForever), kOrder) << share;
  }
  for (const double share : {1.4, 2.0}) {
    const Motion motion(GetParam(), angle_for(GetParam(), share));
    EXPECT_EQ(next_order(motion, kForever), kWithoutEnd) << share;
  }
  for (const double share : {1.03, 1.15, 1.3}) {
    const Motion motion(GetParam(), angle_for(GetParam(), share));
    EXPECT_EQ(next_order(motion, kForever), kOrder + 2) << share;
  }
}

// T = f (1 - cos) reaches f N when the cosine is zero.
TEST(SeriesReach, powers_are_added_for_a_limit_of_friction) {
  for (const double sign : {1.0, -1.0})
    for (const double share : {0.9, 1.15, 2.0}) {
      Motion motion(Slip::stick, 0.0);
      SeriesReach reach(motion.system, kTolerance, kTolerance);
      const double event = share * reach.time(motion.segment);
      motion = Motion(Slip::stick, kHalfPi - event);
      for (double& term : motion.segment.loaded[0].tangential_force) term *= sign;
      const double time = reach.time(motion.segment), actual = event / time;
      EXPECT_EQ(next_order(motion, kForever), actual < 1.0    ? kOrder
                                              : actual < 1.35 ? kOrder + 2
                                                              : kWithoutEnd)
          << actual;
    }
}

TEST(SeriesReach, powers_are_added_for_the_end_of_the_step) {
  const Motion motion(Slip::none, -1.5);
  const double time = SeriesReach(motion.system, kTolerance, kTolerance).time(motion.segment);
  for (const double share : {0.5, 0.99}) EXPECT_EQ(next_order(motion, share * time), kOrder) << share;
  for (const double share : {1.4, 3.0}) EXPECT_EQ(next_order(motion, share * time), kWithoutEnd) << share;
  for (const double share : {1.01, 1.3}) EXPECT_EQ(next_order(motion, share * time), kOrder + 2) << share;
}

TEST(SeriesReach, four_powers_at_most_are_added_in_a_step) {
  Motion motion(Slip::plus, angle_for(Slip::plus, 1.33));
  SeriesReach reach(motion.system, kTolerance, kTolerance);
  for (int step = 0; step < 2; ++step) {
    reach.begin(kForever);
    motion.segment.order = kOrder;
    // the same series, as if they did not reach farther: nothing but the number of powers ends this
    for (const int expected : {kOrder + 2, kOrder + 2, kOrder}) {
      EXPECT_EQ(reach.next_order(motion.segment), expected) << step;
    }
  }
  motion.segment.loaded[0].slip_velocity = constant(1.0);
  for (const int order : {kMaxOrder - 4, kMaxOrder - 3}) {
    motion.segment.order = order;
    reach.begin(1.1 * reach.time(motion.segment));
    EXPECT_EQ(reach.next_order(motion.segment), order + 2 <= kMaxOrder - 2 ? order + 2 : order);
  }
}

/// The same, but it does not turn.
Motion straight(Slip slip, double angle) {
  Motion motion(slip, angle);
  motion.segment.omega = constant(0.0);
  return motion;
}

/// Time over which the series of a cosine hold, to the power `order`.
double reach_of(double tolerance, int order) { return std::pow(tolerance * std::tgamma(order + 1.0), 1.0 / order); }

TEST(SeriesReach, straight_orders_follow_a_ring_so_far) {
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12})
    for (const double radians : {3.0, 4.0, 6.5}) {
      const int order = straight_series_order(tolerance, radians);
      EXPECT_GE(reach_of(tolerance, order), radians) << tolerance;
      EXPECT_TRUE(order == series_order(tolerance) || reach_of(tolerance, order - 1) < radians) << tolerance;
    }
  // terms of exp(radians) leave 1e-16 of that, which has to be below the tolerance
  for (const double tolerance : {1e-13, 1e-14, 1e-15}) {
    const int order = straight_series_order(tolerance, 6.5);
    EXPECT_GE(order, series_order(tolerance));
    if (order > series_order(tolerance)) {
      EXPECT_LT(1e-16 * std::exp(reach_of(tolerance, order - 1)), tolerance);
    }
  }
}

// A motion without a turn gets the powers that go over an impact, and those that go over a ring where nothing is near.
TEST(SeriesReach, straight_motion_goes_farther) {
  const int impact = straight_series_order(kTolerance, 4.0), ring = straight_series_order(kTolerance, 6.5);
  ASSERT_GT(impact, kOrder + 4);
  ASSERT_GT(ring, impact + 4);
  Motion motion = straight(Slip::none, 0.0);
  motion.segment.loaded[0].normal_force[0] += 2.0;  // N = 2 + cos
  SeriesReach reach(motion.system, kTolerance, kTolerance);
  reach.begin(kForever);
  EXPECT_EQ(reach.next_order(motion.segment), impact);
  motion.segment.order = impact;
  EXPECT_EQ(reach.next_order(motion.segment), ring);
  motion.segment.order = ring;
  EXPECT_EQ(reach.next_order(motion.segment), ring);
  EXPECT_GT(reach.last_time(), 6.0);
  // the next step begins with that
  reach.begin(kForever);
  motion.segment.order = kOrder;
  EXPECT_EQ(reach.next_order(motion.segment), ring);
  // an end of contact that is near takes no more powers than it needs
  motion = straight(Slip::none, 0.0);
  motion.segment.order = impact;
  SeriesReach other(motion.system, kTolerance, kTolerance);
  other.begin(kForever);
  EXPECT_EQ(other.next_order(motion.segment), impact);
}

// In a scene with the tanh law as well, where it is held to a tenth of the tolerance, but never to less than rounding.
TEST(SeriesReach, straight_motion_outside_the_tanh_layer_goes_as_far) {
  for (const double tolerance : {kTolerance, 1e-15, 1e-16}) {
    Motion motion = straight(Slip::none, 0.0);
    motion.system.regularization = 1e-3;
    motion.segment.loaded[0].normal_force[0] += 2.0;
    motion.segment.order = series_order(tolerance);
    SeriesReach reach(motion.system, tolerance, tolerance);
    reach.begin(kForever);
    EXPECT_EQ(reach.next_order(motion.segment), straight_series_order(std::max(0.1 * tolerance, 1e-16), 4.0));
  }
}

// A part that turns at all, several contacts, the tanh layer, rates whose powers overflow.
TEST(SeriesReach, what_makes_powers_dear_or_useless_gets_fewer) {
  for (const double omega : {1e-3, 1e-50}) {
    Motion motion = straight(Slip::none, 0.0);
    motion.segment.loaded[0].normal_force[0] += 2.0;
    motion.segment.omega[2] = omega;
    EXPECT_EQ(next_order(motion, kForever), kWithoutEnd) << omega;
  }
  Motion two = straight(Slip::none, 0.0);
  two.segment.contacts[1] = two.segment.contacts[0];
  two.segment.loaded[1] = two.segment.loaded[0];
  two.segment.loaded_count = 2;
  EXPECT_EQ(next_order(two, kForever), kOrder);
  Motion layer = straight(Slip::plus, 0.0);
  layer.system.regularization = 10.0;
  layer.segment.contacts[0].slip = Slip::regularized;
  EXPECT_EQ(next_order(layer, kForever), kOrder);
  Motion fast = straight(Slip::none, 0.0);
  for (double& term : fast.segment.vx) term *= 1e120;
  EXPECT_EQ(next_order(fast, kForever), kOrder);
}

TEST(SeriesReach, nothing_is_added_in_the_tanh_layer) {
  Motion motion(Slip::plus, angle_for(Slip::plus, 1.15));
  motion.system.regularization = 10.0;
  motion.segment.contacts[0].slip = Slip::regularized;
  const double time = SeriesReach(motion.system, kTolerance, kTolerance).time(motion.segment);
  EXPECT_EQ(next_order(motion, 1.1 * time), kOrder);
}

// Rates so high that more powers of them would overflow.
TEST(SeriesReach, nothing_is_added_to_terms_that_are_nearly_too_large) {
  for (const double size : {1e140, 1e160}) {
    Motion motion(Slip::none, -1.5);
    for (double& term : motion.segment.vx) term *= size;
    const double time = SeriesReach(motion.system, kTolerance, kTolerance).time(motion.segment);
    const double last = std::abs(motion.segment.vx[kOrder]);
    EXPECT_EQ(next_order(motion, 1.1 * time), last < 1e150 ? kOrder + 2 : kOrder) << size;
  }
}

// Outside the layer V ends at its edge.
TEST(SeriesReach, the_edge_of_the_tanh_layer_is_an_event) {
  Motion motion(Slip::plus, 0.0);
  motion.system.regularization = 1e-3;
  SeriesReach reach(motion.system, kTolerance, kTolerance);
  const double time = reach.time(motion.segment);
  for (const double share : {1.15, 2.0}) {
    const double angle = 0.4, edge = std::cos(angle + share * time);
    ASSERT_GT(edge, -1.0);
    motion = Motion(Slip::plus, angle);
    motion.segment.loaded[0].slip_velocity[0] += 1.0;  // V = 1 + cos, which falls all the way
    motion.system.regularization = 1e-3;
    motion.system.tanh_saturation = 1e3 * (1.0 + edge);
    const double actual = share * time / reach.time(motion.segment);
    EXPECT_EQ(next_order(motion, kForever), actual < 1.0 ? kOrder : actual < 1.35 ? kOrder + 2 : kWithoutEnd) << actual;
  }
}

// x = -5 t + 2 t^2 beside a direction 4 t^7 loses 8 t^9, and keeps 20 t^8.
TEST(TurnedPlaceStep, ends_where_the_power_above_the_order_is_due) {
  Segment segment;
  segment.order = 8;
  segment.x = {0.0, -5.0, 2.0};
  PairSeries direction{};
  direction[7] = Pair{0.0, 4.0};
  const double due = std::pow(kTolerance / 8.0, 1.0 / 9.0);
  for (const double share : {1.5, 10.0})
    EXPECT_NEAR(turned_place_step(segment, direction, share * due, kTolerance) / due, 1.0, 1e-12) << share;
  EXPECT_EQ(turned_place_step(segment, direction, 0.9 * due, kTolerance), 0.9 * due);
}

// What the bound is for: the products lose no more than the tolerance, and where steps are shortened a good part of it.
TEST(TurnedPlaceStep, keeps_places_beside_a_part_that_turns_to_the_tolerance) {
  for (const double reach : {1.0, 100.0})
    for (const double rate : {0.3, 3.0}) {
      Segment segment;
      segment.order = 8;
      segment.x = cosine(reach, 0.3);
      segment.y = cosine(-0.5 * reach, 1.1);
      PairSeries direction{};
      const Series cos = cosine(1.0, 0.8), sin = cosine(1.0, 0.8 - kHalfPi);
      double power = 1.0;
      for (int k = 0; k <= 8; ++k, power *= rate) {
        const auto index = static_cast<std::size_t>(k);
        direction[k] = Pair{cos[index] * power, sin[index] * power};
      }
      const double step = turned_place_step(segment, direction, 5.0, kTolerance);
      ASSERT_LT(step, 5.0);
      // u = x cos + y sin, its powers up to the order beside all of them
      const auto lost = [&](double t) {
        double all = 0.0, kept = 0.0;
        for (int i = 0; i <= 8; ++i)
          for (int j = 0; j <= 8; ++j) {
            const auto index = static_cast<std::size_t>(i);
            const double term =
                (segment.x[index] * direction[j][0] + segment.y[index] * direction[j][1]) * std::pow(t, i + j);
            all += term;
            if (i + j <= 8) kept += term;
          }
        return std::abs(all - kept);
      };
      EXPECT_LE(lost(step), kTolerance) << reach << ", " << rate;
      EXPECT_GT(lost(2.0 * step), kTolerance) << reach << ", " << rate;
    }
}

}  // namespace
}  // namespace vibratory_alignment
