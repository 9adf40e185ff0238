// A trial is given up as stalled only when nothing would have come any more: such trials are run again to their time
// limit, and none may align. And the periods by which settling is judged.
#include "trial/settling.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "../support/runs.h"
#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

using test::run;
using test::scene_of;

/// Trials that do not match, as Fig. 3 of the paper: most of them bounce where they are, some creep and align late.
Scene mismatched_scene(unsigned seed) {
  std::mt19937 random(seed);
  const auto u = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  Scene s = scene_of(test::plain, {"contacts=[edges, corners]", "initial.y=null", "initial.phi=null",
                                   "gripper.anchor={phi: 0.0}", "trial={time_limit: 100, aligned_depth: 0.01}"});
  s.slot.clearance = u(0.01, 0.05);
  s.initial.x = s.gripper.anchor_x = u(0.1, 0.3);
  s.gripper.x.stiffness = std::pow(10.0, u(-2.0, 0.0));
  s.gripper.x.damping = u(0.05, 1.5);
  s.gripper.y.damping = u(0.05, 1.5);
  s.gripper.phi.stiffness = u(10.0, 60.0);
  s.gripper.phi.damping = u(0.3, 3.0);
  s.gripper.pressing_force = u(0.2, 1.3);
  const double k = std::pow(10.0, u(3.0, 4.0));
  s.base = {k, k, 2.0 * u(0.1, 0.6) * std::sqrt(k), 2.0 * u(0.1, 0.6) * std::sqrt(k), false};
  s.friction = Friction{u(0.05, 0.5), {}};
  s.excitations[0].frequency = u(4.0, 25.0);
  s.excitations[0].waveform = seed % 4 == 0 ? Waveform::square : seed % 4 == 1 ? Waveform::triangle : Waveform::sine;
  return s;
}

TEST(Settling, what_has_stalled_never_aligns) {
  int stalled = 0, others = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const Scene scene = mismatched_scene(seed);
    const TrialResult first = run(scene);
    if (first.outcome != Outcome::stalled) {
      ++others;
      continue;
    }
    ++stalled;
    const TrialResult again = run(scene, {}, scene.trial.time_limit);
    EXPECT_FALSE(again.aligned_time) << "seed " << seed << ": given up at " << first.final_time << ", aligns at "
                                     << again.aligned_time.value_or(0.0);
    // and it is where it was
    EXPECT_LT(std::abs(again.final_state.x - first.final_state.x), 0.05) << "seed " << seed;
  }
  EXPECT_GT(stalled, 5);
  EXPECT_GT(others, 5);
}

/// A block that is carried along by 4 f N/k_x less every cycle of a Coulomb oscillator has not settled until it rests.
TEST(Settling, a_slow_creep_is_no_rest) {
  // weak spring, sliding back towards x_a over many periods under dither: creep of about 1e-5 a period
  Scene scene =
      scene_of(test::plain, {"part.inertia=null", "initial={x: 0.35, phi: 0.0}", "gripper.stiffness.x=1.0e-3",
                             "gripper.anchor.x=0.0", "gripper.damping={x: 2.0, y: 0.1}", "friction.coefficient=0.3",
                             "gripper.pressing_force=1.4", "excitation.frequency=20", "trial={time_limit: 3000}"});
  scene.excitations.push_back(scene.excitations[0]);
  scene.excitations[1].direction = Direction::x;
  scene.excitations[1].amplitude = 1.2;
  const TrialResult result = run(scene);
  // it moves all the time: about k_x x/h_x
  EXPECT_NE(result.outcome, Outcome::stalled) << "at " << result.final_time << " with x = " << result.final_state.x;
}

Excitation sine(double frequency, double amplitude = 1.0) {
  Excitation e;
  e.amplitude = amplitude;
  e.frequency = frequency;
  return e;
}

TEST(Settling, common_period_of_several_excitations) {
  const double pi = 3.14159265358979323846;
  EXPECT_NEAR(common_period({sine(20.0)}), 2.0 * pi / 20.0, 1e-15);
  EXPECT_NEAR(common_period({sine(20.0), sine(30.0)}), 2.0 * pi / 10.0, 1e-14);
  EXPECT_NEAR(common_period({sine(12.0), sine(20.0), sine(30.0)}), 2.0 * pi / 2.0, 1e-14);
  EXPECT_NEAR(common_period({sine(20.0), sine(7.77, 0.0)}), 2.0 * pi / 20.0, 1e-15);
  EXPECT_EQ(common_period({sine(20.0), sine(20.0 * std::sqrt(2.0))}), 0.0);
}

// Whatever their order: periods of the slowest are counted.
TEST(Settling, common_period_does_not_depend_on_the_order) {
  const double pi = 3.14159265358979323846;
  for (const auto& [a, b, common] : {std::array{1.0, 100.0, 1.0}, {1.0, 4096.0, 1.0}, {20.0, 20.2, 0.2}}) {
    EXPECT_NEAR(common_period({sine(a), sine(b)}), 2.0 * pi / common, 1e-12);
    EXPECT_NEAR(common_period({sine(b), sine(a)}), 2.0 * pi / common, 1e-12);
  }
}

TEST(Settling, period_of_the_slowest_excitation) {
  const double pi = 3.14159265358979323846;
  EXPECT_NEAR(slowest_period({sine(20.0), sine(3.0)}), 2.0 * pi / 3.0, 1e-15);
  EXPECT_NEAR(slowest_period({sine(20.0), sine(3.0, 0.0)}), 2.0 * pi / 20.0, 1e-15);
  Excitation chirp = sine(20.0);
  chirp.waveform = Waveform::chirp;
  chirp.end_frequency = 5.0;
  EXPECT_NEAR(slowest_period({chirp}), 2.0 * pi / 5.0, 1e-15);
}

/// When a part at rest is said to have settled, from `start` on.
double settling_time(SettlingWatch& watch, double start) {
  Segment rest;
  rest.duration = 0.5;
  for (rest.start.high = start; !watch.settled() && rest.start.high < 1000.0; rest.start.high += rest.duration)
    watch.book(rest);
  return rest.start.value();
}

// Nothing is judged during a sweep. One that has begun ends when it was to; another one begins with the change.
TEST(Settling, waits_for_the_end_of_a_sweep) {
  Excitation sweep = sine(10.0);
  sweep.waveform = Waveform::chirp;
  sweep.end_frequency = 20.0;
  sweep.sweep_time = 100.0;
  Excitation louder = sweep, other = sweep;
  louder.amplitude = 2.0;
  other.frequency = 11.0;
  const double judging = 24.0 * 2.0 * 3.14159265358979323846 / 20.0 + 1.0;
  const auto expect_settled = [&](const Excitation& changed, double when, double end) {
    SettlingWatch watch({sweep}, 1e4);
    watch.restart({changed}, when);
    const double time = settling_time(watch, when);
    EXPECT_GT(time, end);
    EXPECT_LT(time, end + judging);
  };
  expect_settled(sweep, 0.0, 100.0);
  expect_settled(louder, 50.0, 100.0);
  expect_settled(other, 50.0, 150.0);
  expect_settled(sweep, 300.0, 300.0);
}

// One long flight holds instants without number. A few are looked at, and after it the part is judged as ever.
TEST(Settling, is_looked_for_in_a_flight_of_any_length) {
  SettlingWatch watch({sine(10.0, 0.0)}, 1e13);
  Segment flight;
  flight.duration = 1e12;
  flight.order = 1;
  flight.x[1] = flight.vx[0] = flight.end.vx = 1.0;
  EXPECT_FALSE(watch.book(flight));
  const double period = 2.0 * 3.14159265358979323846 / 16.0;
  Segment rest;
  rest.start.high = flight.duration;
  rest.duration = 100.0;
  const std::optional<double> settled = watch.book(rest);
  ASSERT_TRUE(settled);
  EXPECT_GT(*settled, 22.9 * period);
  EXPECT_LT(*settled, 24.1 * period);
}

// A segment that is taken back leaves no trace, whatever was seen in it.
TEST(Settling, forgets_what_is_taken_back) {
  SettlingWatch watch({sine(10.0, 0.0)}, 1e4);
  Segment rest;
  rest.duration = 5.0;
  EXPECT_FALSE(watch.book(rest));
  rest.start.high = 5.0;
  const std::optional<double> settled = watch.book(rest);
  ASSERT_TRUE(settled);
  for (const double cut : {0.0, 0.1, 1.0}) {
    watch.take_back();
    EXPECT_FALSE(watch.settled());
    rest.duration = cut;
    EXPECT_FALSE(watch.book(rest));
  }
  rest.start.high += rest.duration;
  rest.duration = 5.0;
  const std::optional<double> again = watch.book(rest);
  ASSERT_TRUE(again);
  EXPECT_NEAR(rest.start.high + *again, 5.0 + *settled, 1e-12);
}

// A trial ends at the instant at which it has settled, and not with the step that sees it, which may be long: at the
// 24th of the instants at which a part at rest is looked at.
TEST(Settling, ends_the_trial_at_once_with_any_solver) {
  Scene scene = scene_of(R"(
part: {half_width: 0.6, base_distance: 0.9, inertia: 0.2}
slot: {clearance: 0.09}
gripper: {stiffness: {x: 0.08, phi: 60.0}, damping: {x: 0.2, y: 0.5, phi: 0.3}, anchor: {x: 0.2}, pressing_force: 0.5}
base: {stiffness: {y: 1.0e4}, damping: {y: 20.0}}
contacts: [edges, corners]
friction: {coefficient: 0.2}
excitation: {amplitude: 0.0, frequency: 20.0}
initial: {x: 0.2}
trial: {time_limit: 100.0}
)");
  for (const char* solver : {"event", "implicit", "auto"}) {
    scene.solver.name = solver;
    const TrialResult result = run(scene);
    EXPECT_EQ(result.outcome, Outcome::stalled) << solver;
    EXPECT_LT(result.final_time, 50.0) << solver;
    const double instants = result.final_time / (2.0 * 3.14159265358979323846 / 16.0);
    EXPECT_NEAR(instants, std::nearbyint(instants), 1e-9) << solver;
  }
}

// A block on the edge of the slot, its weight 1e-9 beyond it: what turns it grows by 0.6 % a period from below 1e-11,
// while y, and its differences, come to rest.
TEST(Settling, is_not_said_of_what_grows_beside_what_comes_to_rest) {
  Scene scene = scene_of(R"(
part: {half_width: 0.6, base_distance: 0.9, inertia: 0.2}
slot: {clearance: 0.1}
gripper: {stiffness: {x: 0.0}, damping: {x: 1.0, y: 1.0, phi: 0.0}, anchor: {x: 0.7, y: 0.9}}
base: {stiffness: {y: 1.0e4}, damping: {y: 200.0}}
contacts: [edges]
friction: {coefficient: 0.6}
weight: 1.0
excitation: {amplitude: 1.0e-3, frequency: 1000.0}
initial: {x: 0.700000001, phi: 0.0, y: 0.8999}
trial: {time_limit: 80.0}
)");
  EXPECT_LT(run(scene).final_state.phi, -1.0);
}

// Excitations without a common period never repeat: such a motion is not judged.
TEST(Settling, nothing_settles_without_a_common_period) {
  Scene scene =
      scene_of(test::ball, {"gripper={damping: {y: 0.5}, anchor: {y: 2.0}}", "initial.y=2.0", "trial.time_limit=100"});
  scene.excitations = {sine(5.0, 0.1), sine(5.0 * std::sqrt(2.0), 0.1)};
  EXPECT_EQ(run(scene).outcome, Outcome::time_limit);
  scene.excitations = {sine(5.0, 0.1), sine(10.0, 0.1)};
  EXPECT_EQ(run(scene).outcome, Outcome::stalled);
}

// A subharmonic motion repeats every other period only.
TEST(Settling, a_doubled_period_is_seen_as_settled) {
  const double nu = 1000.0, pi = 3.14159265358979323846, e = 0.45098;
  Scene scene =
      scene_of(test::ball, {"gripper.anchor.y=0.9", "weight=1", "excitation.frequency=1000", "initial.y=0.9"});
  scene.base = {1e12, 1e12, 0.6e6, 0.6e6, false};
  scene.excitations[0].amplitude = 1.72;
  scene.excitations[0].phase = std::acos(pi * (1.0 - e) / (1.0 + e) / 1.72);
  scene.initial.vy = 1.01 * 2.0 * pi / nu * e / (1.0 + e);
  scene.trial.time_limit = 20000.0 * 2.0 * pi / nu;
  const TrialResult result = run(scene);
  EXPECT_EQ(result.outcome, Outcome::stalled);
}

}  // namespace
}  // namespace vibratory_alignment
