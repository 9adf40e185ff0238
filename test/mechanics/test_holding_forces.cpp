// The forces that hold sticking contacts: they take out V' whatever the inertia, share where contacts hold the same
// motion, and leave a load only the motion that the contacts allow.
#include "mechanics/holding_forces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vibratory_alignment {
namespace {

using Vector = HoldingForces::Vector;

System part(double inertia) {
  System system;
  system.half_width = 1.0;
  system.base_distance = 80.0;
  system.x.inverse_inertia = system.y.inverse_inertia = 1.0;
  system.phi.inverse_inertia = 1.0 / inertia;
  return system;
}

HoldingForces holding_of(const System& system, const HoldingForces::Rows& rows, int count) {
  HoldingForces holding;
  holding.set(system, rows, count);
  return holding;
}

/// G T, from the definition.
double rate_of(const System& s, const TangentRow& row, const HoldingForces::Rows& rows, const Vector& force,
               int count) {
  double rate = 0.0;
  for (int j = 0; j < count; ++j) {
    const TangentRow& other = rows[static_cast<std::size_t>(j)];
    rate += force[static_cast<std::size_t>(j)] *
            (s.x.inverse_inertia * row.x * other.x + s.y.inverse_inertia * row.y * other.y +
             s.phi.inverse_inertia * row.moment * other.moment);
  }
  return rate;
}

TEST(HoldingForces, take_out_what_they_are_asked_to) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    const System system = part(std::pow(10.0, number(random)));
    const int count = 1 + trial % 2;
    HoldingForces::Rows rows;
    Vector rhs{};
    for (int i = 0; i < count; ++i) {
      const double angle = 3.0 * number(random);
      rows[static_cast<std::size_t>(i)] = {std::cos(angle), std::sin(angle), 40.0 * number(random)};
      rhs[static_cast<std::size_t>(i)] = number(random);
    }
    const HoldingForces holding = holding_of(system, rows, count);
    if (!holding.regular()) continue;
    const HoldingForces::Answer answer = holding.hold(rhs, {});
    for (int i = 0; i < count; ++i) {
      const auto index = static_cast<std::size_t>(i);
      EXPECT_LE(std::abs(holding.left_over(i, rhs, answer)), 1e-13 * 40.0 / holding.spread({1.0})[0]) << trial;
      EXPECT_NEAR(rate_of(system, rows[index], rows, answer.force, count), rhs[index], 1e-6) << trial;
    }
  }
}

// In G = J M^-1 J^T the mass is below the last digit of the turning, and G is singular.
TEST(HoldingForces, tell_motions_apart_whose_mobilities_differ_by_far) {
  const System system = part(1e-8);
  const HoldingForces holding = holding_of(system, {{{1.0, 0.0, 74.18}, {1.0, 0.0, 73.41}}}, 2);
  EXPECT_TRUE(holding.regular());
  EXPECT_TRUE(holding.delicate());
  // a part that flies along x and does not turn: the answer must stop it and not turn it
  const HoldingForces::Answer answer = holding.hold({-3.0, -3.0}, {});
  EXPECT_NEAR(answer.x, -3.0, 1e-12);
  EXPECT_NEAR(answer.phi, 0.0, 1e-13);
  // M x'' = T1 + T2, and no moment: T1 r1 + T2 r2 = 0
  EXPECT_NEAR(answer.force[0] + answer.force[1], -3.0, 1e-11);
  EXPECT_NEAR(answer.force[0] * 74.18 + answer.force[1] * 73.41, 0.0, 1e-8);
}

TEST(HoldingForces, share_equally_where_contacts_hold_the_same_motion) {
  for (const double inertia : {1e-8, 1e-2, 1e6}) {
    const HoldingForces holding = holding_of(part(inertia), {{{1.0, 0.0, 80.0}, {1.0, 0.0, 80.0}}}, 2);
    EXPECT_FALSE(holding.regular());
    const HoldingForces::Answer answer = holding.hold({0.4, 0.4}, {});
    EXPECT_NEAR(answer.force[0], answer.force[1], 1e-14 * std::abs(answer.force[0]));
    EXPECT_NEAR(holding.left_over(0, {0.4, 0.4}, answer), 0.0, 1e-15);
    // what differs between them cannot be held
    const HoldingForces::Answer none = holding.hold({0.5, -0.5}, {});
    EXPECT_NEAR(std::abs(holding.left_over(0, {0.5, -0.5}, none)), 0.5, 1e-14);
  }
}

TEST(HoldingForces, of_nearly_equal_levers_differ_only_where_noise_does_not_cover_it) {
  const double near = 80.0 * (1.0 + 1e-6);
  const HoldingForces holding = holding_of(part(1.0), {{{1.0, 0.0, 80.0}, {1.0, 0.0, near}}}, 2);
  const Vector rhs{0.4, 0.4 - 1e-9};
  const HoldingForces::Answer shared = holding.hold(rhs, {1e-6, 1e-6}), resolved = holding.hold(rhs, {1e-12, 1e-12});
  EXPECT_NEAR(shared.force[0], shared.force[1], 1e-5 * std::abs(shared.force[0]));
  EXPECT_GT(std::abs(resolved.force[0] - resolved.force[1]), 0.1);
  for (int i = 0; i < 2; ++i) EXPECT_LE(std::abs(holding.left_over(i, rhs, resolved)), 1e-15);
}

TEST(HoldingForces, leave_a_load_only_the_motion_that_contacts_allow) {
  for (const double inertia : {1e-8, 0.3}) {
    const System system = part(inertia);
    const HoldingForces one = holding_of(system, {{{1.0, 0.0, 73.41}}}, 1);
    const HoldingForces::Answer turned = one.respond({0.0, 0.0, 1.0});
    // about the held point: x'' = -r phi'', (mu + r^2) phi'' = 1
    const double expected = 1.0 / (inertia + 73.41 * 73.41);
    EXPECT_NEAR(turned.phi, expected, 1e-4 * expected);
    EXPECT_NEAR(turned.x, -73.41 * expected, 1e-4 * 73.41 * expected);
    const HoldingForces::Answer free = holding_of(system, {}, 0).respond({0.0, 2.0, 1.0});
    EXPECT_EQ(free.y, 2.0);
    EXPECT_EQ(free.phi, 1.0 / inertia);
  }
}

TEST(HoldingForces, of_a_point_that_cannot_be_moved_are_none) {
  System system = part(1.0);
  system.x.inverse_inertia = 0.0;  // locked; the point is straight below the mass centre
  const HoldingForces holding = holding_of(system, {{{1.0, 0.0, 1e-12}}}, 1);
  EXPECT_FALSE(holding.regular());
  EXPECT_EQ(holding.hold({1.0}, {}).force[0], 0.0);
}

}  // namespace
}  // namespace vibratory_alignment
