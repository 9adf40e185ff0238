// Dry friction with closed forms: a block that is shaken along the base, the Coulomb oscillator, and the signs of friction.
// The part rests on the edge A1 with locked tilt, so that N is constant and V = x'.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../support/runs.h"
#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

using test::events_of;
using test::TimedEvent;

/// A block pressed on the edge with N = load, free to slide along x on a spring k_x.
const std::string block = R"(
part: {half_width: 0.7, base_distance: 0.9}
slot: {clearance: 0.09}
gripper: {stiffness: {x: 0.0}, anchor: {x: 0.3}, pressing_force: 0.5}
base: {stiffness: {y: 1.0e4}, damping: {y: 20.0}}
contacts: [edges]
friction: {coefficient: 0.4}
excitation: {amplitude: 0.1, frequency: 3.0, direction: x}
initial: {x: 0.3}
trial: {time_limit: 20.0}
)";

/// f0 less what the axial spring loses to the sag d: N = f0 - N/k.
constexpr double kLoad = 0.5 / (1.0 + 1e-4);

Scene shaken_block(double amplitude) {
  Scene scene = test::scene_of(block);
  scene.excitations[0].amplitude = amplitude;
  return scene;
}

TEST(StickSlip, a_shaken_block_sticks_below_f_n) {
  for (const double share : {0.1, 0.9, 1.0 - 1e-9}) {
    long events = 0;
    double fastest = 0.0;
    const TrialResult result = test::run(shaken_block(share * 0.4 * kLoad), [&](const Segment& g) {
      events += g.event_count;
      ASSERT_EQ(g.contacts[0].slip, Slip::stick);
      fastest = std::max(fastest, std::abs(g.end.vx));
      // V = 0 exactly, in every power
      for (int k = 0; k <= g.order; ++k) ASSERT_EQ(g.loaded[0].slip_velocity[static_cast<std::size_t>(k)], 0.0);
    }, 20.0);
    EXPECT_EQ(events, 0) << share;
    EXPECT_LT(fastest, 1e-14) << share;
    EXPECT_NEAR(result.final_state.x, 0.3, 1e-14) << share;
  }
}

TEST(StickSlip, a_shaken_block_slips_above_f_n) {
  for (const double share : {1.0 + 1e-9, 1.0 + 1e-6, 1.1, 3.0}) {
    bool slipped = false;
    for (const TimedEvent& e : events_of(shaken_block(share * 0.4 * kLoad))) slipped = slipped || e.event.kind == EventKind::slip;
    EXPECT_TRUE(slipped) << share;
  }
}

// Stick breaks when A sin(nu tau) = f N, to the last digit of N = k d (d is one of a height of order 1).
TEST(StickSlip, stick_breaks_when_the_force_reaches_f_n) {
  for (const double share : {1.1, 1.5, 4.0}) {
    const std::vector<TimedEvent> events = events_of(shaken_block(share * 0.4 * kLoad));
    ASSERT_FALSE(events.empty());
    EXPECT_EQ(events[0].event.kind, EventKind::slip);
    EXPECT_NEAR(events[0].time, std::asin(1.0 / share) / 3.0, 3e-12 / std::sqrt(1.0 - 1.0 / (share * share))) << share;
  }
}

// Slow slip-stick motion has two slips and two sticks a period, no chattering about V = 0.
TEST(StickSlip, slipping_and_sticking_alternate) {
  int slips = 0, sticks = 0;
  const double period = 2.0 * 3.14159265358979323846 / 3.0;
  for (const TimedEvent& e : events_of(shaken_block(1.2 * 0.4 * kLoad), 10.0 * period)) {
    slips += e.event.kind == EventKind::slip;
    sticks += e.event.kind == EventKind::stick;
  }
  EXPECT_EQ(slips, 20);
  EXPECT_NEAR(sticks, 20, 1);
}

// Coulomb oscillator: 2 f N/k_x of amplitude lost in every half cycle of pi/sqrt(k_x), until the spring can no longer
// move it.
TEST(StickSlip, coulomb_oscillator_loses_four_f_n_over_k_a_cycle) {
  const double k_x = 0.7, f = 0.013, lost = 2.0 * f * kLoad / k_x;
  for (const double start : {0.2, 0.11, -0.15}) {
    Scene scene = test::scene_of(block);
    scene.gripper.x.stiffness = k_x;
    scene.friction->coefficient = f;
    scene.excitations[0].amplitude = 0.0;
    scene.initial.x = 0.3 + start;
    scene.trial.time_limit = 200.0;
    const int half_cycles = static_cast<int>(std::ceil((std::abs(start) - f * kLoad / k_x) / lost));
    std::vector<TimedEvent> turns;
    for (const TimedEvent& e : events_of(scene))
      if (e.event.kind == EventKind::stick || e.event.kind == EventKind::slip_reversal) turns.push_back(e);
    ASSERT_EQ(static_cast<int>(turns.size()), half_cycles) << start;
    for (int n = 1; n <= half_cycles; ++n) {
      const TimedEvent& turn = turns[static_cast<std::size_t>(n - 1)];
      const double amplitude = (std::abs(start) - n * lost) * (n % 2 == 0 ? 1.0 : -1.0) * (start > 0.0 ? 1.0 : -1.0);
      EXPECT_NEAR(turn.state.x - 0.3, amplitude, 1e-11) << n;
      EXPECT_NEAR(turn.time, n * 3.14159265358979323846 / std::sqrt(k_x), 1e-10) << n;
      EXPECT_EQ(turn.event.kind, n == half_cycles ? EventKind::stick : EventKind::slip_reversal);
    }
    // and it stays where it stopped
    EXPECT_NEAR(test::run(scene).final_state.x, turns.back().state.x, 1e-13);
  }
}

TEST(StickSlip, friction_takes_the_energy_that_the_oscillator_loses) {
  Scene scene = test::scene_of(block);
  scene.gripper.x.stiffness = 0.7;
  scene.friction->coefficient = 0.013;
  scene.excitations[0].amplitude = 0.0;
  scene.initial.x = 0.5;
  scene.trial.time_limit = 200.0;
  const TrialResult result = test::run(scene);
  const double rest = result.final_state.x - 0.3;
  EXPECT_NEAR(result.energy->friction_loss, 0.5 * 0.7 * (0.04 - rest * rest), 1e-10);
}

/// State after the first impact of a part that falls flat or tilted on the edge A1, at the release.
State after_impact(const std::vector<std::string>& settings) {
  std::vector<std::string> all = {"initial.y=1.0", "gripper.damping=null"};
  all.insert(all.end(), settings.begin(), settings.end());
  for (const TimedEvent& e : events_of(test::scene_of(test::plain, all)))
    if (e.event.kind == EventKind::release) return e.state;
  return {};
}

// Departure 1 of MODEL.md: on a part that is tilted counter-clockwise the normal force pushes to the left.
TEST(Signs, normal_force_of_a_tilted_face_pushes_against_the_tilt) {
  const std::string none = "friction=null";
  EXPECT_LT(after_impact({none, "initial.phi=0.1"}).vx, -0.01);
  // the edge is to the right of C: it turns the part counter-clockwise, more so than it was turning
  EXPECT_GT(after_impact({none, "initial.phi=0.0"}).omega, 0.1);
}

// Departure 2: friction against sliding to the right acts to the left, below C, and turns the part clockwise.
TEST(Signs, friction_opposes_sliding_and_its_moment_is_that_of_a_force_below_c) {
  const std::string fast = "initial={x: 0.21, y: 1.0, phi: 0.0, vx: 1.0}", back = "initial={x: 0.21, y: 1.0, phi: 0.0, vx: -1.0}";
  const State smooth = after_impact({"friction=null", fast}), rough = after_impact({"friction.coefficient=0.1", fast});
  EXPECT_LT(rough.vx, smooth.vx);
  EXPECT_LT(rough.omega, smooth.omega);
  const State smooth_back = after_impact({"friction=null", back}), rough_back = after_impact({"friction.coefficient=0.1", back});
  EXPECT_GT(rough_back.vx, smooth_back.vx);
  EXPECT_GT(rough_back.omega, smooth_back.omega);
}

// Its power is -f N |V|: under the printed sign of its moment the tilt would gain energy.
TEST(Signs, friction_only_takes_energy) {
  for (const char* start : {"initial={x: 0.21, y: 1.0, phi: 0.0, vx: 1.0}", "initial={x: 0.21, y: 1.0, phi: 0.3, omega: -3.0}",
                            "initial={x: 0.21, y: 1.0, phi: -0.3, vx: -1.0, omega: 3.0}"})
    for (const char* law : {"friction={coefficient: 0.5}", "friction={coefficient: 0.5, regularization: 1.0e-2}"}) {
      double least = 0.0, taken = 0.0;
      test::run(test::scene_of(test::plain, {start, law, "contacts=[edges, corners]"}), [&](const Segment& g) {
        for (int i = 0; i < g.loaded_count; ++i)
          for (const double share : {0.1, 0.5, 0.9}) {
            const ContactSeries& c = g.loaded[static_cast<std::size_t>(i)];
            const double t = share * g.duration;
            const double power = value_at(c.tangential_force, g.order - 1, t) * value_at(c.slip_velocity, g.order, t);
            least = std::min(least, -power);
            taken = std::max(taken, -power);
          }
      });
      EXPECT_GT(taken, 0.01);
      EXPECT_GT(least, -1e-13);
    }
}

}  // namespace
}  // namespace vibratory_alignment
