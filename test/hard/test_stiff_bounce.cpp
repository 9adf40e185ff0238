// Bouncing on ever stiffer bases (hard/stiff_bounce): the steps an impact takes stay the same, and the motion tends to
// that of a rigid ball, from which it is a contact's duration, O(1/sqrt(k)), away.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/hard_scene.h"
#include "../support/restitution.h"
#include "../support/runs.h"

namespace vibratory_alignment {
namespace {

struct Height {
  double y, vy;
};

/// A rigid ball at the time t. With u = y - y_a: u = 0.6 cos t down to u = 0.3, then flights that start there with e
/// times the speed v of the landing, u = 0.3 cos s + v sin s, 2 atan(v/0.3) long.
Height rigid_ball(double t) {
  const double anchor = 0.6, ground = 0.3, drop = 0.6, e = test::linear_restitution(0.1);
  double begin = std::acos(ground / drop), v = e * std::sqrt(drop * drop - ground * ground);
  for (double length; begin + (length = 2.0 * std::atan(v / ground)) < t; v *= e) begin += length;
  const double s = t - begin;
  return {anchor + ground * std::cos(s) + v * std::sin(s), v * std::cos(s) - ground * std::sin(s)};
}

TEST(StiffBounce, steps_of_an_impact_do_not_depend_on_the_stiffness) {
  for (const char* solver : {"event", "implicit"}) {
    double first = 0.0;
    for (double k = 1e3; k < 2e12; k *= 10.0) {
      Scene scene = test::hard_scene("stiff_bounce");
      scene.solver.name = solver;
      test::set_base(scene, k, 0.1);
      const TrialResult result = test::run(scene);
      ASSERT_NE(result.outcome, Outcome::failed) << solver << ": " << result.failure;
      ASSERT_EQ(result.impacts[0], 2) << solver << ' ' << k;
      EXPECT_LT(result.energy->residual, 1e-9) << solver << ' ' << k;
      const double steps = static_cast<double>(result.counts.steps) / 2.0;
      if (first == 0.0) first = steps;
      EXPECT_LT(steps, 1.5 * first + 2.0) << solver << ' ' << k;
    }
  }
}

TEST(StiffBounce, tends_to_the_rigid_ball) {
  for (const char* solver : {"event", "implicit"})
    for (double k = 1e3; k < 2e12; k *= 10.0) {
      Scene scene = test::hard_scene("stiff_bounce");
      scene.solver.name = solver;
      test::set_base(scene, k, 0.1);
      const State end = test::run(scene).final_state;
      const Height rigid = rigid_ball(scene.trial.time_limit);
      // two contacts of about pi/sqrt(k) each, at speeds and accelerations below 1
      EXPECT_NEAR(end.y, rigid.y, 10.0 / std::sqrt(k)) << solver << ' ' << k;
      EXPECT_NEAR(end.vy, rigid.vy, 10.0 / std::sqrt(k)) << solver << ' ' << k;
    }
}

}  // namespace
}  // namespace vibratory_alignment
