// The friction problem at V = 0: whatever solve_friction() answers must fulfil the conditions of its header, and V' must
// be that of another method (projected Gauss-Seidel on the quadratic in a box), since V' is unique.
#include "mechanics/friction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace vibratory_alignment {
namespace {

using Vector = std::array<double, kSiteCount>;

/// G = J M^-1 J^T with three motions, so that more than three contacts make G singular.
FrictionProblem random_problem(std::mt19937& random, int count, int rank) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  std::array<std::array<double, 3>, kSiteCount> j{};
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < rank; ++k) j[i][k] = u(random) * (k == 2 ? 3.0 : 1.0);
  FrictionProblem p;
  p.count = count;
  Vector cause{};  // drift within the range of J in half of the cases, as physics has it without V' of its own
  for (int k = 0; k < 3; ++k) cause[k] = u(random);
  const bool in_range = u(random) > 0.0;
  for (int i = 0; i < count; ++i) {
    for (int n = 0; n < count; ++n)
      for (int k = 0; k < 3; ++k) p.mobility[i][n] += j[i][k] * j[n][k];
    p.drift[i] = 0.0;
    for (int k = 0; k < 3; ++k) p.drift[i] += j[i][k] * cause[k];
    if (!in_range) p.drift[i] += u(random);
    p.limit[i] = u(random) > 0.8 ? 0.0 : 0.6 * std::abs(u(random));
  }
  return p;
}

Vector rates(const FrictionProblem& p, const Vector& force) {
  Vector rate{};
  for (int i = 0; i < p.count; ++i) {
    rate[i] = p.drift[i];
    for (int j = 0; j < p.count; ++j) rate[i] += p.mobility[i][j] * force[j];
  }
  return rate;
}

/// Minimum of 1/2 T.G.T + g.T in the box, one coordinate at a time until nothing moves.
Vector gauss_seidel_rates(const FrictionProblem& p) {
  Vector force{};
  for (int sweep = 0; sweep < 200000; ++sweep) {
    double change = 0.0;
    for (int i = 0; i < p.count; ++i) {
      const double g = p.mobility[i][i];
      if (g <= 0.0) continue;
      double residual = p.drift[i];
      for (int j = 0; j < p.count; ++j) residual += p.mobility[i][j] * force[j];
      const double next = std::clamp(force[i] - residual / g, -p.limit[i], p.limit[i]);
      change = std::max(change, std::abs(next - force[i]));
      force[i] = next;
    }
    if (change < 1e-16) break;
  }
  return rates(p, force);
}

void expect_conditions(const FrictionProblem& p, const FrictionSolution& s) {
  const Vector rate = rates(p, s.force);
  for (int i = 0; i < p.count; ++i) {
    double scale = std::abs(p.drift[i]);
    for (int j = 0; j < p.count; ++j) scale += std::abs(p.mobility[i][j] * s.force[j]);
    const double nothing = 1e-10 * (scale + 1e-3);
    EXPECT_LE(std::abs(s.force[i]), p.limit[i] * (1.0 + 1e-9) + 1e-12);
    switch (s.slip[i]) {
      case Slip::stick:
        EXPECT_NEAR(rate[i], 0.0, nothing);
        break;
      case Slip::plus:
        EXPECT_EQ(s.force[i], -p.limit[i]);
        EXPECT_GE(rate[i], -nothing);
        break;
      case Slip::minus:
        EXPECT_EQ(s.force[i], p.limit[i]);
        EXPECT_LE(rate[i], nothing);
        break;
      default:
        ADD_FAILURE() << "neither stick nor slip";
    }
  }
}

class FrictionOf : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(contacts, FrictionOf, testing::Range(1, 6));

TEST_P(FrictionOf, conditions_hold) {
  std::mt19937 random(21);
  for (int i = 0; i < 300; ++i) {
    const FrictionProblem p = random_problem(random, GetParam(), 3);
    expect_conditions(p, solve_friction(p));
  }
}

TEST_P(FrictionOf, acceleration_is_that_of_another_method) {
  std::mt19937 random(22);
  for (int i = 0; i < 60; ++i) {
    const FrictionProblem p = random_problem(random, GetParam(), 3);
    const Vector rate = rates(p, solve_friction(p).force), expected = gauss_seidel_rates(p);
    for (int j = 0; j < p.count; ++j) EXPECT_NEAR(rate[j], expected[j], 1e-7) << "problem " << i;
  }
}

// Fewer motions than contacts: a locked tilt, or only one motion at all.
TEST_P(FrictionOf, conditions_hold_with_locked_motions) {
  std::mt19937 random(23);
  for (int i = 0; i < 200; ++i) {
    const FrictionProblem p = random_problem(random, GetParam(), 1 + i % 2);
    expect_conditions(p, solve_friction(p));
  }
}

// With friction enough for all nobody slips; the order of the contacts does not matter.
TEST(Friction, enough_of_it_holds_everything) {
  std::mt19937 random(24);
  for (int i = 0; i < 100; ++i) {
    FrictionProblem p = random_problem(random, 2, 3);
    p.limit = {1e6, 1e6};
    const FrictionSolution s = solve_friction(p);
    EXPECT_EQ(s.slip[0], Slip::stick);
    EXPECT_EQ(s.slip[1], Slip::stick);
  }
}

TEST(Friction, none_of_it_holds_nothing) {
  std::mt19937 random(25);
  for (int i = 0; i < 100; ++i) {
    FrictionProblem p = random_problem(random, 3, 3);
    p.limit = {};
    const FrictionSolution s = solve_friction(p);
    for (int j = 0; j < 3; ++j) EXPECT_EQ(s.slip[j], p.drift[j] > 0.0 ? Slip::plus : Slip::minus);
  }
}

TEST(Friction, it_opposes_the_motion_about_to_start) {
  FrictionProblem p;
  p.count = 1;
  p.mobility[0][0] = 2.0;
  p.limit[0] = 0.3;
  p.drift[0] = 1.0;  // more than G f N = 0.6
  EXPECT_EQ(solve_friction(p).slip[0], Slip::plus);
  EXPECT_EQ(solve_friction(p).force[0], -0.3);
  p.drift[0] = -1.0;
  EXPECT_EQ(solve_friction(p).slip[0], Slip::minus);
  p.drift[0] = 0.5;
  EXPECT_EQ(solve_friction(p).slip[0], Slip::stick);
  EXPECT_NEAR(solve_friction(p).force[0], -0.25, 1e-13);
}

// Two contacts that hold the same motion twice (a flat part on both of its corners): the header says that they share.
TEST(Friction, a_singular_mobility_shares_equally) {
  for (const double g : {1.0, 7.3, 1e-3, 1e4}) {
    std::array<std::array<double, kSiteCount>, kSiteCount> mobility{};
    mobility[0][0] = mobility[0][1] = mobility[1][0] = mobility[1][1] = g;
    Vector force{};
    solve_mobility(mobility, 2, {0.37, 0.37}, force);
    EXPECT_NEAR(g * (force[0] + force[1]), 0.37, 1e-12);
    EXPECT_NEAR(force[0] / force[1], 1.0, 1e-3) << "g = " << g;
  }
}

TEST(Friction, equal_contacts_hold_up_to_the_sum_of_their_limits) {
  FrictionProblem p;
  p.count = 2;
  for (int i = 0; i < 2; ++i) {
    p.mobility[i] = {1.0, 1.0};
    p.drift[i] = 0.999;
    p.limit[i] = 0.5;
  }
  FrictionSolution s = solve_friction(p);
  EXPECT_EQ(s.slip[0], Slip::stick);
  EXPECT_EQ(s.slip[1], Slip::stick);
  p.drift = {1.001, 1.001};
  s = solve_friction(p);
  EXPECT_EQ(s.slip[0], Slip::plus);
  EXPECT_EQ(s.slip[1], Slip::plus);
  // unequal limits: the strong one takes what the weak one cannot
  p.limit = {0.2, 0.9};
  p.drift = {1.0, 1.0};
  s = solve_friction(p);
  EXPECT_NEAR(rates(p, s.force)[0], 0.0, 1e-12);
  EXPECT_LE(std::abs(s.force[0]), 0.2 + 1e-12);
}

TEST(Friction, regular_mobility_is_solved) {
  std::mt19937 random(26);
  for (int count = 1; count <= 3; ++count)
    for (int i = 0; i < 100; ++i) {
      FrictionProblem p = random_problem(random, count, 3);
      for (int j = 0; j < count; ++j) p.mobility[j][j] += 0.1;
      Vector force{};
      solve_mobility(p.mobility, count, p.drift, force);
      for (int j = 0; j < count; ++j) {
        double sum = 0.0;
        for (int k = 0; k < count; ++k) sum += p.mobility[j][k] * force[k];
        EXPECT_NEAR(sum, p.drift[j], 1e-11);
      }
    }
}

}  // namespace
}  // namespace vibratory_alignment
