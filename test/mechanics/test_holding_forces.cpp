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

// The turning of a light part drowns its pull along x in V': forces that follow from V' would be wrong by a tenth.
TEST(HoldingForces, follow_from_the_motion_that_they_hold) {
  const double inertia = 9e-8, arm_1 = 86.5, arm_2 = 86.4, pull = 2e8, moment = 3e9;
  const System system = part(inertia);
  const HoldingForces holding = holding_of(system, {{{1.0, 0.0, arm_1}, {1.0, 0.0, arm_2}}}, 2);
  const HoldingForces::Answer held = holding.hold_motion({{}, pull, 7.0, moment / inertia}, {});
  // T1 + T2 = -pull, T1 r1 + T2 r2 = -moment
  const double force_1 = (arm_2 * pull - moment) / (arm_1 - arm_2), force_2 = -pull - force_1;
  EXPECT_NEAR(held.force[0], force_1, 1e-9 * std::abs(force_1));
  EXPECT_NEAR(held.force[1], force_2, 1e-9 * std::abs(force_2));
  EXPECT_NEAR(held.x, 0.0, 1e-15 * pull);
  EXPECT_EQ(held.y, 7.0);
  EXPECT_NEAR(held.phi, 0.0, 1e-15 * moment / inertia);
}

// What the levers differ by is rounding of V' of the free part, but not of what is left of it: T that hold the one hold
// the other.
TEST(HoldingForces, of_nearly_equal_levers_are_those_of_the_motion_that_is_left) {
  const double inertia = 1e-6, arm_1 = 80.0, arm_2 = 80.0 + 4e-5, pull = 2.0, moment = 300.0;
  const System system = part(inertia);
  const HoldingForces holding = holding_of(system, {{{1.0, 0.0, arm_1}, {1.0, 0.0, arm_2}}}, 2);
  const HoldingForces::Answer held = holding.hold_motion({{}, pull, 0.0, moment / inertia}, {});
  EXPECT_TRUE(held.told_apart);
  EXPECT_NEAR(held.x, 0.0, 1e-9);
  EXPECT_NEAR(held.phi, 0.0, 1e-9);
  const double force_1 = (arm_2 * pull - moment) / (arm_1 - arm_2), force_2 = -pull - force_1;
  EXPECT_NEAR(held.force[0], force_1, 1e-6 * std::abs(force_1));
  EXPECT_NEAR(held.force[1], force_2, 1e-6 * std::abs(force_2));
}

TEST(HoldingForces, hold_a_motion_that_V_has_rates_of_its_own_beside) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (const double inertia : {1e-8, 0.3, 1e3})
    for (int count = 1; count <= 2; ++count) {
      const System system = part(inertia);
      HoldingForces::Rows rows;
      Vector own{};
      for (int i = 0; i < count; ++i) {
        const double angle = 3.0 * number(random);
        rows[static_cast<std::size_t>(i)] = {std::cos(angle), std::sin(angle), 40.0 * number(random)};
        own[static_cast<std::size_t>(i)] = number(random);
      }
      const HoldingForces::Answer free{{}, number(random), number(random), number(random)};
      const HoldingForces holding = holding_of(system, rows, count);
      const HoldingForces::Answer held = holding.hold_motion(free, own);
      for (int i = 0; i < count; ++i) {
        const auto index = static_cast<std::size_t>(i);
        EXPECT_NEAR(holding.left_over(i, {}, held) + own[index], 0.0, 1e-12) << inertia;
      }
      // what has changed is what the forces do, seen as energy: (change . M change) = T . J change
      const double x = held.x - free.x, y = held.y - free.y, phi = held.phi - free.phi;
      double power = 0.0;
      for (int i = 0; i < count; ++i) {
        const auto index = static_cast<std::size_t>(i);
        power += held.force[index] * holding.left_over(i, {}, {{}, x, y, phi});
      }
      const double energy = x * x + y * y + inertia * phi * phi;
      EXPECT_NEAR(power, energy, 1e-9 * energy) << inertia;
    }
}

TEST(HoldingForces, leave_a_part_that_is_wholly_held_at_rest) {
  System system = part(1.0);
  system.x.inverse_inertia = system.phi.inverse_inertia = 0.0;
  std::mt19937 random(9);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int trial = 0; trial < 100; ++trial) {
    const double angle = 3.0 * number(random);
    const HoldingForces holding = holding_of(system, {{{std::cos(angle), std::sin(angle), number(random)}}}, 1);
    EXPECT_EQ(holding.hold_motion({{}, 0.0, number(random), 0.0}, {}).y, 0.0) << trial;
  }
}

// Three contacts hold all three axes: what is left is what V' asks for by itself, however large what they hold.
TEST(HoldingForces, leave_nothing_of_a_motion_but_what_turning_asks_for) {
  const HoldingForces::Rows rows = {{{0.635, 0.773, 1.03}, {0.0, -1.0, 5.4}, {1.0, 0.0, 7.0}}};
  const HoldingForces holding = holding_of(part(0.018), rows, 3);
  ASSERT_TRUE(holding.regular());
  const HoldingForces::Answer large{{}, 3e10, -7e10, 1.1e12};
  const HoldingForces::Answer rest = holding.hold_motion(large, {});
  EXPECT_EQ(std::abs(rest.x) + std::abs(rest.y) + std::abs(rest.phi), 0.0);
  const Vector own{0.3, -0.2, 0.7};
  const HoldingForces::Answer held = holding.hold_motion(large, own);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(holding.left_over(i, {}, held) + own[static_cast<std::size_t>(i)], 0.0, 1e-14) << i;
}

TEST(HoldingForces, of_contacts_that_count_as_the_same_are_so_to_the_last_digit) {
  for (const double off : {0.0, 1e-9, 1e-6}) {
    const HoldingForces holding =
        holding_of(part(0.3), {{{1.0, 0.0, 80.0}, {0.0, 1.0, 1.0}, {1.0, 0.0, 80.0 + off}}}, 3);
    const HoldingForces::Answer answer = holding.hold({0.4, 0.1, 0.4}, {1e-3, 1e-3, 1e-3});
    EXPECT_EQ(answer.force[0], answer.force[2]) << off;
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(holding.left_over(i, {0.4, 0.1, 0.4}, answer), 0.0, off * std::abs(answer.phi) + 1e-14);
    }
  }
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

// A moment turns a part about what two contacts of nearly one lever hold in common; told apart they hold that too.
// Where the levers count as the same nothing does.
TEST(HoldingForces, leave_what_contacts_of_nearly_one_lever_differ_by) {
  const System system = part(1.0);
  for (const double off : {8e-5, 8e-7}) {
    const HoldingForces::Rows rows = {{{1.0, 0.0, 80.0}, {1.0, 0.0, 80.0 + off}}};
    const HoldingForces holding = holding_of(system, rows, 2);
    const auto apart = [&](const HoldingForces::Answer& a) {
      return std::abs(holding.left_over(1, {}, a) - holding.left_over(0, {}, a));
    };
    // (1 + 80^2) phi'' = 1 about the held points
    const double expected = off / (1.0 + 80.0 * 80.0);
    EXPECT_NEAR(apart(holding.respond({0.0, 0.0, 1.0})), expected, 1e-3 * expected) << off;
    const double told_apart = apart(holding.respond({0.0, 0.0, 1.0}, true));
    if (off > 4e-8 * 81.0)
      EXPECT_LT(told_apart, 1e-6 * expected) << off;
    else
      EXPECT_NEAR(told_apart, expected, 1e-3 * expected) << off;
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
