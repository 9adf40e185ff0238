// Lasting contact on a stiff, overdamped base (hard/lasting_contact): the limit is a rigid base, on which the motion is
// made of integrals of sines; the cost does not depend on the base.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "../support/hard_scene.h"
#include "../support/known_answers.h"
#include "../support/runs.h"

namespace vibratory_alignment {
namespace {

/// The block on a rigid base: N = f0 - A sin(nu t), x'' = B sin(nu_x t) - f N sgn V, with the instants of stick and
/// slip found by steps of 1e-3 and bisection.
struct RigidBlock {
  double press = 2.0, lift = 1.0, lift_rate = 7.0, push = 0.6, push_rate = 3.0, friction = 0.2;

  double limit(double t) const { return friction * (press - lift * std::sin(lift_rate * t)); }
  double drive(double t) const { return push * std::sin(push_rate * t); }
  /// Integrals of x'' from t0 to t, for a slip that starts at t0 at rest.
  double speed(double t0, double t, double side) const {
    return push / push_rate * (std::cos(push_rate * t0) - std::cos(push_rate * t)) -
           side * friction *
               (press * (t - t0) - lift / lift_rate * (std::cos(lift_rate * t0) - std::cos(lift_rate * t)));
  }
  double way(double t0, double t, double side) const {
    const double s = t - t0;
    const auto twice = [&](double amplitude, double rate) {  // double integral of amplitude sin(rate t)
      return amplitude / rate * (std::cos(rate * t0) * s - (std::sin(rate * t) - std::sin(rate * t0)) / rate);
    };
    return twice(push, push_rate) - side * friction * (0.5 * press * s * s - twice(lift, lift_rate));
  }

  template <class Holds>
  static double last_instant(double from, double end, const Holds& holds) {
    const double step = 1e-3;
    double low = from;
    while (low < end && holds(low + step)) low += step;
    double high = low + step;
    for (int i = 0; i < 60; ++i) (holds(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
    return high;
  }

  /// x(end) - x(0) and the number of slips.
  double run(double end, int& slips) const {
    double x = 0.0;
    slips = 0;
    for (double t = 0.0;;) {
      t = last_instant(t, end, [&](double s) { return std::abs(drive(s)) <= limit(s); });
      if (t >= end) return x;
      const double side = drive(t) > 0.0 ? 1.0 : -1.0, t0 = t;
      ++slips;
      t = last_instant(t0 + 1e-9, end, [&](double s) { return side * speed(t0, s, side) > 0.0; });
      x += way(t0, std::min(t, end), side);
      if (t >= end) return x;
    }
  }
};

TrialResult run_with(const std::string& solver, double stiffness, double damping_ratio) {
  Scene scene = test::hard_scene("lasting_contact");
  test::set_base(scene, stiffness, damping_ratio);
  scene.solver.name = solver;
  return test::run(scene);
}

TEST(LastingContact, known_answer_is_the_rigid_block) {
  int slips = 0;
  const double x = 0.3 + RigidBlock().run(10.0, slips);
  EXPECT_GT(slips, 5);
  EXPECT_NEAR(test::known_answers("lasting_contact")["rigid_x"].as<double>(), x, 1e-12);
}

// N differs from the rigid one by the inertia of the block on its base, nu^2 d, and by the spring, d, with d about A/k;
// on an overdamped base d lags by h/k = 2 zeta/sqrt(k). The rest is the tolerance, 1e-6 a step.
TEST(LastingContact, tends_to_the_rigid_block) {
  int slips = 0;
  const double rigid = 0.3 + RigidBlock().run(10.0, slips);
  for (const char* solver : {"implicit", "auto"})
    for (const double zeta : {1.0, 10.0, 100.0})
      for (const double k : {1e6, 1e8, 1e10}) {
        const TrialResult result = run_with(solver, k, zeta);
        ASSERT_EQ(result.outcome, Outcome::time_limit) << result.failure;
        EXPECT_NEAR(result.final_state.x, rigid, 100.0 * zeta / k + 1e-5) << solver << " " << zeta << " " << k;
      }
}

TEST(LastingContact, cost_depends_neither_on_stiffness_nor_on_damping) {
  for (const char* solver : {"implicit", "auto"}) {
    long least = 0, most = 0;
    for (const double zeta : {1.0, 10.0, 100.0})
      for (const double k : {1e4, 1e6, 1e8, 1e10}) {
        const long steps = run_with(solver, k, zeta).counts.steps;
        least = least == 0 ? steps : std::min(least, steps);
        most = std::max(most, steps);
      }
    EXPECT_LE(most, 4 * least) << solver;
  }
}

}  // namespace
}  // namespace vibratory_alignment
