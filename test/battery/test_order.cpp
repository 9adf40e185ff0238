// Every solver: the error falls as its order or its tolerance says, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../support/runs.h"
#include "../support/scenes.h"
#include "../support/solver_battery.h"

namespace vibratory_alignment {
namespace {

using test::Oscillation;
using test::run;
using test::scene_of;

class BatteryOrder : public test::SolverBattery {
 protected:
  /// Holds errors at settings() to what is stated.
  void expect_order(const std::vector<double>& errors, double order) const {
    const std::vector<double> all = settings();
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
      if (fixed_step()) {
        const double found = std::log(errors[i] / errors[i + 1]) / std::log(all[i] / all[i + 1]);
        if (errors[i + 1] > 1e-12) {
          EXPECT_NEAR(found, order, 0.15) << all[i];
        }
      } else {
        // a tolerance is met, and a lower one is worth its digits until rounding is reached; `implicit` may step by
        // another method with it, or by series of another length, and then be as good as that is; where nothing shakes
        // the steps of `implicit_alone` are so long that rounding is larger
        EXPECT_LE(errors[i], all[i]);
        const std::string name = GetParam().name;
        const double floor = name == "implicit" ? 1e-3 * all[i + 1] : name == kImplicitAlone ? 3e-12 : 1e-12;
        EXPECT_LE(errors[i + 1], std::max({1e-12, floor, 10.0 * errors[i] * all[i + 1] / all[i]})) << all[i];
      }
    }
    EXPECT_LT(errors.back(), fixed_step() ? 1e-2 : 1e-10);
  }
};
INSTANTIATE_TEST_SUITE_P(solver, BatteryOrder, testing::ValuesIn(test::stated_solvers()), test::solver_test_name);

// Pressed on so hard that it oscillates on the base and never leaves it.
TEST_P(BatteryOrder, within_a_contact) {
  const double k = 400.0, c = 2.0, anchor = 0.6, surface = 0.9, end = 0.4;
  const Scene scene = scene_of(test::ball, {"gripper.damping.y=0.5", "base={stiffness: {y: 400}, damping: {y: 2}}",
                                            "initial={x: 0.2, y: 0.8988}"});
  const Oscillation exact{c + 0.5, 1.0 + k, anchor + k * surface, 0.8988, 0.0};
  std::vector<double> errors;
  for (double setting : settings()) {
    if (GetParam().order == 4.0) setting *= 10.0;  // above rounding
    long events = 0;
    const TrialResult result = run(
        with(scene, setting), [&](const Segment& g) { events += g.event_count; }, end);
    EXPECT_EQ(events, 0);
    errors.push_back(
        std::hypot(result.final_state.y - exact.y(end), (result.final_state.vy - exact.v(end)) / exact.rate()) /
        std::abs(exact.y0 - exact.f / exact.k));
  }
  expect_order(errors, GetParam().order);
}

// Three oscillators at once, of which one is driven: y = particular + homogeneous solution.
TEST_P(BatteryOrder, in_flight) {
  const double nu = 19.0, end = 0.8;
  const Scene scene = scene_of(
      test::plain, {"gripper={stiffness: {x: 2, phi: 11}, damping: {x: 0.3, phi: 0.4}, anchor: {x: 0.1, y: 3}}",
                    "initial={x: 0.2, y: 3.2, phi: 0.3, vx: 0.5, vy: 0.2, omega: -1}"});
  const double particular = 1.0 / (1.0 - nu * nu);  // of sin(nu t)
  const Oscillation x{0.3, 2.0, 0.2, 0.2, 0.5}, y{0.0, 1.0, 3.0, 3.2, 0.2 - nu * particular},
      phi{0.4 / 0.17, 11.0 / 0.17, 0.0, 0.3, -1.0};
  std::vector<double> errors;
  for (const double setting : settings()) {
    const State s = run(with(scene, setting), {}, end).final_state;
    errors.push_back(
        std::max({std::abs(s.x - x.y(end)), std::abs(s.vx - x.v(end)), std::abs(s.phi - phi.y(end)),
                  std::abs(s.omega - phi.v(end)), std::abs(s.y - y.y(end) - particular * std::sin(nu * end)),
                  std::abs(s.vy - y.v(end) - nu * particular * std::cos(nu * end))}));
    // no truncation in closed forms
    if (!fixed_step()) {
      EXPECT_LT(errors.back(), 1e-13);
    }
  }
  expect_order(errors, GetParam().order);
}

// Slides against constant friction, stops at v0^2/(2 f N) and stays: over the stop no method with a fixed step has more
// than order 1.
TEST_P(BatteryOrder, over_a_stop) {
  const double f = 0.25, force = 0.5, v0 = 0.1, end = 2.0;
  const Scene scene = scene_of(test::ball, {"gripper={anchor: {y: 0.39995}, stiffness: {x: 0.0}}",
                                            "friction.coefficient=0.25", "initial={x: 0.2, y: 0.89995, vx: 0.1}"});
  // k d = y - y_a
  ASSERT_NEAR(1e4 * (0.9 - 0.89995), force, 1e-11);
  const double stop = 0.2 + v0 * v0 / (2.0 * f * force);
  for (const double setting : settings()) {
    const State s = run(with(scene, setting), {}, end).final_state;
    // in the layer of rk4 (eps = h f N) the last part of V decays with a time constant h: eps h at most
    EXPECT_NEAR(s.x, stop, fixed_step() ? 2.0 * v0 * setting : std::max(1e-12, setting)) << setting;
    EXPECT_LT(std::abs(s.vx), GetParam().sticks ? 1e-9 : 1e-2 * setting) << setting;
  }
}

}  // namespace
}  // namespace vibratory_alignment
