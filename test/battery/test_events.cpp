// Every solver: number and times of impacts and separations, of sticking and slipping, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../support/runs.h"
#include "../support/scenes.h"
#include "../support/solver_battery.h"

namespace vibratory_alignment {
namespace {

using test::events_of;
using test::run;
using test::scene_of;
using test::TimedEvent;

class BatteryEvents : public test::SolverBattery {
 protected:
  std::vector<double> times_of(const std::vector<TimedEvent>& events, EventKind kind) const {
    std::vector<double> times;
    for (const TimedEvent& event : events)
      if (event.event.kind == kind) times.push_back(event.time);
    return times;
  }
};
INSTANTIATE_TEST_SUITE_P(solver, BatteryEvents, testing::ValuesIn(test::stated_solvers()), test::solver_test_name);

// A touch is noticed up to h late. By then the damper has missed an impulse 2 zeta w h of the speed; numerical damping
// takes pi w h decay of it. The flights after that, together as long as the time that has passed, change by this share.
TEST_P(BatteryEvents, a_bouncing_part_touches_and_leaves_when_theory_says) {
  const double end = 3.9, zeta = 0.1, rate = 100.0;
  const test::BouncingBall ball(end);
  ASSERT_EQ(ball.touches.size(), 4u);
  for (double setting : settings()) {
    if (fixed_step()) setting /= 8.0;
    const std::vector<TimedEvent> events = events_of(with(scene_of(test::ball), setting), end);
    const std::vector<double> touches = times_of(events, EventKind::touch),
                              releases = times_of(events, EventKind::release);
    // none missed, none invented
    ASSERT_EQ(touches.size(), ball.touches.size()) << setting;
    ASSERT_EQ(releases.size(), ball.releases.size()) << setting;
    for (std::size_t i = 0; i < touches.size(); ++i) {
      const double impacts = static_cast<double>(i + 1);
      const double share = (2.0 * zeta + M_PI * GetParam().numerical_decay) * rate * impacts;
      const double allowed =
          fixed_step() ? (2.0 * impacts + share * ball.touches[i]) * setting : std::max(setting, 1e-12);
      EXPECT_NEAR(touches[i], ball.touches[i], allowed) << "touch " << i << " at " << setting;
      EXPECT_NEAR(releases[i], ball.releases[i], allowed) << "release " << i << " at " << setting;
    }
  }
}

// A block that is pressed on with N and pushed with sin(nu t): it slips when the push reaches f N, and until then T is
// the push.
TEST_P(BatteryEvents, a_held_part_slips_when_the_push_reaches_f_n) {
  const double limit = 0.25 * 0.5, nu = 2.0, slip = std::asin(limit) / nu;
  const Scene scene =
      scene_of(test::ball, {"gripper={anchor: {y: 0.39995}, stiffness: {x: 0.0}}", "friction.coefficient=0.25",
                            "excitation={amplitude: 1, frequency: 2, direction: x}", "initial={x: 0.2, y: 0.89995}"});
  for (const double setting : settings()) {
    double moves_at = -1.0, worst = 0.0;
    const double allowed = fixed_step() ? setting : std::max(setting, 1e-12);
    const TrialResult result = run(
        with(scene, setting),
        [&](const Segment& g) {
          if (moves_at < 0.0 && std::abs(g.end.vx) > 2.0 * setting) moves_at = g.start.value();
          // in the layer of rk4 the force follows the push with the delay h/(1 - (T/fN)^2)
          if (g.end_time() < 0.9 * slip && g.loaded_count > 0 && g.start.value() > 5.0 * setting)
            worst = std::max(worst, std::abs(value_at(g.loaded[0].tangential_force, g.order, 0.5 * g.duration) +
                                             std::sin(nu * (g.start + 0.5 * g.duration).value())));
        },
        0.5);
    EXPECT_LE(worst, fixed_step() ? 6.0 * nu * setting : 1e-12) << setting;
    // v = (cos(nu ts) - cos(nu t))/nu - f N (t - ts) after the slip
    const double v = (std::cos(nu * slip) - std::cos(nu * 0.5)) / nu - limit * (0.5 - slip);
    EXPECT_NEAR(result.final_state.vx, v, fixed_step() ? 2.0 * setting : allowed) << setting;
    if (!GetParam().sticks) continue;
    const std::vector<double> slips = times_of(events_of(with(scene, setting), 0.5), EventKind::slip);
    ASSERT_EQ(slips.size(), 1u) << setting;
    EXPECT_NEAR(slips[0], slip, 2.0 * allowed) << setting;
    EXPECT_GE(moves_at, slip - allowed);
  }
}

// f N t reaches v0 at v0/(f N): there it sticks, once and for good.
TEST_P(BatteryEvents, a_sliding_part_sticks_when_it_has_stopped) {
  if (!GetParam().sticks) GTEST_SKIP() << "no state of sticking";
  const Scene scene = scene_of(test::ball, {"gripper={anchor: {y: 0.39995}, stiffness: {x: 0.0}}",
                                            "friction.coefficient=0.25", "initial={x: 0.2, y: 0.89995, vx: 0.1}"});
  for (const double setting : settings()) {
    const std::vector<TimedEvent> events = events_of(with(scene, setting), 1.9001);
    const std::vector<double> sticks = times_of(events, EventKind::stick);
    ASSERT_EQ(sticks.size(), 1u) << setting;
    EXPECT_NEAR(sticks[0], 0.8, fixed_step() ? 2.0 * setting : 1e-10) << setting;
    EXPECT_TRUE(times_of(events, EventKind::slip).empty());
  }
}

}  // namespace
}  // namespace vibratory_alignment
