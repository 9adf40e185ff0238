// Set-valued friction of several contacts in a step: the conditions themselves, and V by another method.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "solver/box_friction.h"

namespace vibratory_alignment {
namespace {

/// V of a problem for given T.
double slip(const BoxFriction& p, int i, const Mobility::Vector& t) {
  double v = p.slip_free[i];
  for (int j = 0; j < p.count; ++j) v += p.mobility[i][j] * t[j];
  return v;
}

/// Rounding in V.
double noise(const BoxFriction& p, int i) {
  double sum = std::abs(p.slip_free[i]);
  for (int j = 0; j < p.count; ++j) sum += std::abs(p.mobility[i][j]) * p.limit[j];
  return 1e-12 * sum;
}

/// A part with mass 1 and the given inertia, and contacts with random directions and levers.
BoxFriction random_problem(std::mt19937& random, int count, double inertia) {
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  BoxFriction p;
  p.count = count;
  p.typical = 2.0 + 1.0 / inertia;
  std::array<std::array<double, 3>, kSiteCount> direction{};
  for (int i = 0; i < count; ++i) {
    const double angle = 3.0 * any(random);
    direction[i] = {std::cos(angle), std::sin(angle), any(random)};
    // contacts that hold the same motion
    if (i > 0 && any(random) > 0.5) direction[i] = direction[i - 1];
    p.limit[i] = any(random) > 0.8 ? 0.0 : std::abs(any(random));
    p.slip_free[i] = any(random);
  }
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j)
      p.mobility[i][j] = direction[i][0] * direction[j][0] + direction[i][1] * direction[j][1] +
                         direction[i][2] * direction[j][2] / inertia;
  return p;
}

TEST(BoxFriction, obeys_its_law) {
  std::mt19937 random(11);
  for (const double inertia : {0.02, 0.3, 5.0})
    for (int count = 1; count <= 4; ++count)
      for (int n = 0; n < 200; ++n) {
        const BoxFriction p = random_problem(random, count, inertia);
        const Mobility::Vector t = solve_box_friction(p);
        for (int i = 0; i < count; ++i) {
          const double v = slip(p, i, t);
          EXPECT_LE(std::abs(t[i]), p.limit[i]);
          if (std::abs(t[i]) < p.limit[i])
            EXPECT_NEAR(v, 0.0, noise(p, i));
          else
            EXPECT_LE(v * t[i], noise(p, i) * p.limit[i]);
        }
      }
}

// V is unique: projected Gauss-Seidel, one contact after the other, comes to the same.
TEST(BoxFriction, gives_the_same_motion_as_gauss_seidel) {
  std::mt19937 random(12);
  for (int n = 0; n < 100; ++n) {
    const BoxFriction p = random_problem(random, 1 + n % 4, 0.3);
    Mobility::Vector t{};
    for (int sweep = 0; sweep < 20000; ++sweep)
      for (int i = 0; i < p.count; ++i)
        t[i] = std::clamp(t[i] - slip(p, i, t) / p.mobility[i][i], -p.limit[i], p.limit[i]);
    const Mobility::Vector found = solve_box_friction(p);
    for (int i = 0; i < p.count; ++i) EXPECT_NEAR(slip(p, i, found), slip(p, i, t), 1e-6);
  }
}

TEST(BoxFriction, shares_alike_where_contacts_hold_the_same_motion) {
  BoxFriction p;
  p.count = 2;
  p.typical = 1.0;
  p.mobility[0] = {1.5, 1.5};
  p.mobility[1] = {1.5, 1.5};
  p.slip_free = {0.3, 0.3};
  p.limit = {1.0, 1.0};
  const Mobility::Vector t = solve_box_friction(p);
  EXPECT_NEAR(t[0], -0.1, 1e-14);
  EXPECT_NEAR(t[1], -0.1, 1e-14);
}

// Two contacts that hold the same motion, one of which has to slide a little: the stronger one sticks.
TEST(BoxFriction, lets_one_of_two_slide_that_cannot_both_stick) {
  BoxFriction p;
  p.count = 2;
  p.typical = 1.0;
  p.mobility[0] = {1.0, 1.0};
  p.mobility[1] = {1.0, 1.0};
  p.slip_free = {1e-6, -1e-6};
  p.limit = {0.5, 0.2};
  const Mobility::Vector t = solve_box_friction(p);
  EXPECT_EQ(t[1], 0.2);
  EXPECT_NEAR(slip(p, 0, t), 0.0, 1e-13);
  EXPECT_LT(slip(p, 1, t), 0.0);
}

TEST(BoxFriction, along_a_locked_motion_is_sliding_friction) {
  BoxFriction p;
  p.count = 1;
  p.typical = 1.0;
  p.limit = {0.5};
  p.slip_free = {0.1};
  EXPECT_EQ(solve_box_friction(p)[0], -0.5);
  p.slip_free = {-0.1};
  EXPECT_EQ(solve_box_friction(p)[0], 0.5);
  p.slip_free = {0.0};
  EXPECT_EQ(solve_box_friction(p)[0], 0.0);
}

}  // namespace
}  // namespace vibratory_alignment
