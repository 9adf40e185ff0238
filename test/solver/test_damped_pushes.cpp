// Normal forces of several contacts in an implicit step: the conditions themselves, and closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "solver/damped_pushes.h"

namespace vibratory_alignment {
namespace {

/// What contact i would push with, could it pull.
double asked(const DampedPushes& p, int i, const Mobility::Vector& n) {
  double sum = p.offered[i];
  for (int j = 0; j < p.count; ++j) sum -= p.damping[i] * p.mobility[i][j] * n[j];
  return sum;
}

// Random normals with levers, alike ones among them, without damping and with one 1e6 times as large as the mass.
TEST(DampedPushes, pushes_are_what_is_asked_for_and_nothing_pulls) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int n = 0; n < 5000; ++n) {
    DampedPushes p;
    p.count = 1 + n % kSiteCount;
    std::array<std::array<double, 3>, kSiteCount> normal{};
    for (int i = 0; i < p.count; ++i) {
      const double angle = 3.0 * any(random);
      normal[i] = {std::cos(angle), std::sin(angle), 2.0 * any(random)};
      if (i > 0 && any(random) > 0.5) normal[i] = normal[i - 1];
      p.damping[i] = any(random) > 0.8 ? 0.0 : std::pow(10.0, 6.0 * any(random));
      p.offered[i] = any(random);
    }
    double largest = 0.0;
    for (int i = 0; i < p.count; ++i)
      for (int j = 0; j < p.count; ++j)
        p.mobility[i][j] = normal[i][0] * normal[j][0] + normal[i][1] * normal[j][1] + normal[i][2] * normal[j][2];
    const Mobility::Vector pushes = solve_damped_pushes(p);
    for (int i = 0; i < p.count; ++i) largest = std::max(largest, pushes[i]);
    for (int i = 0; i < p.count; ++i) {
      const double noise = 1e-13 * (1.0 + p.damping[i]) * (1.0 + 10.0 * largest);
      EXPECT_GE(pushes[i], 0.0);
      EXPECT_NEAR(pushes[i], std::max(0.0, asked(p, i, pushes)), noise) << n << " contact " << i;
    }
  }
}

// Two contacts that the same motion presses: N_1 - N_2 = a_1 - a_2 however strong the damper is, and the sum is that of
// one contact with both springs and dampers.
TEST(DampedPushes, contacts_that_move_alike_differ_by_their_springs) {
  for (const double damping : {0.1, 10.0, 1e3, 1e6}) {
    DampedPushes p;
    p.count = 2;
    p.mobility[0] = p.mobility[1] = {1.0, 1.0};
    p.damping = {damping, damping};
    p.offered = {damping + 1.5, damping + 0.5};
    const Mobility::Vector n = solve_damped_pushes(p);
    EXPECT_NEAR(n[0] - n[1], 1.0, 1e-15 * damping + 1e-12);
    EXPECT_NEAR(n[0] + n[1], (2.0 * damping + 2.0) / (1.0 + 2.0 * damping), 1e-12);
  }
}

}  // namespace
}  // namespace vibratory_alignment
