// Dry friction: when stick breaks, and the signs of friction. A block on a shaken table and the Coulomb oscillator are
// in test/hard.
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

/// A drive that grows slowly under a fast ripple, amplitude (sin s + 0.01 sin 50 s), s = frequency t.
void drive_slowly(Scene& scene, Direction direction, double amplitude, double frequency) {
  Excitation slow, ripple;
  slow.direction = ripple.direction = direction;
  slow.amplitude = amplitude;
  slow.frequency = frequency;
  ripple.amplitude = 0.01 * amplitude;
  ripple.frequency = 50.0 * frequency;
  scene.excitations.push_back(slow);
  scene.excitations.push_back(ripple);
}

/// The s at which that drive reaches `force`: it only grows up to s = 1.
double reached_at(double force, double amplitude) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double s = 0.5 * (low + high);
    (amplitude * (std::sin(s) + 0.01 * std::sin(50.0 * s)) < force ? low : high) = s;
  }
  return high;
}

constexpr double kFrequencies[] = {1e-3, 0.05, 1.0, 10.0};

/// A part in the slot whose tilted corner presses on the right wall; only y moves, and nothing does before it slips.
const std::string wedged = R"(
part: {half_width: 0.5, base_distance: 0.5}
slot: {clearance: 0.01}
gripper: {stiffness: {}, anchor: {y: 0.3}}
base: {stiffness: {x: 120.0, y: 100.0}}
contacts: [walls]
friction: {coefficient: 0.4}
excitation: {amplitude: 0, frequency: 1}
initial: {x: 0.0, y: 0.3, phi: 0.05}
trial: {time_limit: 1.0, aligned_depth: 10.0}
)";

// At rest all velocities are zero, whatever the excitation does meanwhile: T alone tells when the stick breaks.
TEST(StickSlip, a_part_held_at_rest_slips_when_the_drive_reaches_f_n) {
  // the corner: a cos phi + b sin phi, less l
  const double limit = 0.4 * 120.0 * (0.5 * std::cos(0.05) + 0.5 * std::sin(0.05) - 0.51);
  const double expected = reached_at(limit, 1.0);
  for (const double frequency : kFrequencies) {
    Scene scene = test::scene_of(wedged);
    drive_slowly(scene, Direction::y, 1.0, frequency);
    const std::vector<TimedEvent> events = events_of(scene, 1.1 * expected / frequency);
    ASSERT_FALSE(events.empty()) << frequency;
    EXPECT_EQ(events[0].event.kind, EventKind::slip);
    EXPECT_EQ(events[0].event.site, Site::b1);
    // what is cut off of T
    EXPECT_NEAR(events[0].time * frequency, expected, 1e-10) << frequency;
    // the last digit of the forces, for as long as a step may last
    EXPECT_NEAR(events[0].state.y, 0.3, 1e-15 + 1e-17 / (frequency * frequency));
  }
}

/// A block pressed on edge and corner, with its tilt locked and free to slide along x.
const std::string two_footed_block = R"(
part: {half_width: 0.7, base_distance: 0.9}
slot: {clearance: 0.09}
gripper: {stiffness: {x: 0.0}, anchor: {x: 0.3}, pressing_force: 0.5}
base: {stiffness: {y: 1.0e4}, damping: {y: 20.0}}
contacts: [edges, corners]
friction: {coefficient: 0.4}
excitation: {amplitude: 0.0, frequency: 3.0, direction: x}
initial: {x: 0.3}
trial: {time_limit: 20.0}
)";

// Nothing pulls along x: T is exactly zero, and both of its limits are reached where N is. It is let go there.
TEST(StickSlip, what_nothing_pulls_is_let_go_without_sliding) {
  for (const std::string friction : {"0.4", "1.0", "3.0"})
    for (const std::string tolerance : {"1.0e-4", "1.0e-6", "1.0e-8"}) {
      const Scene scene = test::scene_of(two_footed_block,
                                         {"excitation={amplitude: 1.0, frequency: 3.0, direction: y}",
                                          "friction.coefficient=" + friction, "solver={tolerance: " + tolerance + "}"});
      int releases = 0;
      for (const TimedEvent& event : events_of(scene, 20.0)) {
        EXPECT_NE(event.event.kind, EventKind::slip) << friction << " " << tolerance << " at " << event.time;
        EXPECT_EQ(event.state.x, 0.3) << friction << " " << tolerance << " at " << event.time;
        releases += event.event.kind == EventKind::release;
      }
      EXPECT_GT(releases, 10) << friction << " " << tolerance;
    }
}

// Edge and corner share the load and hold up to the sum of their limits.
TEST(StickSlip, a_part_held_by_edge_and_corner_slips_when_the_drive_reaches_both_limits) {
  // each carries half: sag N/k of half the load
  const double limit = 0.4 * 0.5 / (1.0 + 0.5e-4), expected = reached_at(limit, 0.3);
  for (const double frequency : {0.05, 1.0, 10.0}) {
    Scene scene = test::scene_of(two_footed_block);
    drive_slowly(scene, Direction::x, 0.3, frequency);
    const std::vector<TimedEvent> events = events_of(scene, 1.1 * expected / frequency);
    ASSERT_FALSE(events.empty()) << frequency;
    EXPECT_EQ(events[0].event.kind, EventKind::slip);
    // N is the difference of heights of order one, times 1e4
    EXPECT_NEAR(events[0].time * frequency, expected, 1e-10) << frequency;
    EXPECT_NEAR(events[0].state.x, 0.3, 1e-14);
  }
}

// Only y moves, held by the corner at one wall and by the opposite edge at the part's side. V of the edge is -c y', so
// that the smallest forces are as 1 : c, until the edge is at its limit; from there on the corner takes the rest, until
// it is at its own.
TEST(StickSlip, the_strong_contact_takes_what_the_weak_one_cannot) {
  Scene scene = test::scene_of(wedged, {"contacts=[edges, walls]", "initial.y=-0.3"});
  const double c = std::cos(0.05), s = std::sin(0.05), f = 0.4;
  const double wall = 120.0 * (0.5 * c + 0.5 * s - 0.51);
  const double side = (120.0 * c * c + 100.0 * s * s) * (0.5 - 0.51 * c + 0.3 * s);
  ASSERT_LT(side, 0.5 * wall);
  scene.gripper.anchor_y = -0.3 - side * s;  // balances the side's normal force
  const double first = f * side * (1.0 + c * c) / c, last = f * (wall + c * side), amplitude = last / 0.7;
  for (const double frequency : kFrequencies) {
    Scene driven = scene;
    drive_slowly(driven, Direction::y, amplitude, frequency);
    const double end = reached_at(last, amplitude);
    std::vector<TimedEvent> slips;
    for (const TimedEvent& e : events_of(driven, 1.001 * end / frequency))
      if (e.event.kind != EventKind::aligned) slips.push_back(e);
    ASSERT_EQ(slips.size(), 2u) << frequency;
    EXPECT_EQ(slips[0].event.kind, EventKind::slip);
    EXPECT_EQ(slips[0].event.site, Site::a2);
    EXPECT_NEAR(slips[0].time * frequency, reached_at(first, amplitude), 1e-10) << frequency;
    EXPECT_EQ(slips[1].event.kind, EventKind::slip);
    EXPECT_EQ(slips[1].event.site, Site::b1);
    EXPECT_NEAR(slips[1].time * frequency, end, 1e-10) << frequency;
    EXPECT_NEAR(slips[1].state.y, -0.3, 1e-15 + 1e-17 / (frequency * frequency)) << frequency;
  }
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
  const std::string fast = "initial={x: 0.21, y: 1.0, phi: 0.0, vx: 1.0}",
                    back = "initial={x: 0.21, y: 1.0, phi: 0.0, vx: -1.0}";
  const State smooth = after_impact({"friction=null", fast}), rough = after_impact({"friction.coefficient=0.1", fast});
  EXPECT_LT(rough.vx, smooth.vx);
  EXPECT_LT(rough.omega, smooth.omega);
  const State smooth_back = after_impact({"friction=null", back}),
              rough_back = after_impact({"friction.coefficient=0.1", back});
  EXPECT_GT(rough_back.vx, smooth_back.vx);
  EXPECT_GT(rough_back.omega, smooth_back.omega);
}

// Its power is -f N |V|: under the printed sign of its moment the tilt would gain energy.
TEST(Signs, friction_only_takes_energy) {
  for (const char* start :
       {"initial={x: 0.21, y: 1.0, phi: 0.0, vx: 1.0}", "initial={x: 0.21, y: 1.0, phi: 0.3, omega: -3.0}",
        "initial={x: 0.21, y: 1.0, phi: -0.3, vx: -1.0, omega: 3.0}"})
    for (const char* law : {"friction={coefficient: 0.5}", "friction={coefficient: 0.5, regularization: 1.0e-2}"}) {
      double least = 0.0, taken = 0.0;
      test::run(test::scene_of(test::plain, {start, law, "contacts=[edges, corners]"}), [&](const Segment& g) {
        for (int i = 0; i < g.loaded_count; ++i)
          for (const double share : {0.1, 0.5, 0.9}) {
            const ContactValues c = contact_at(g, i, share * g.duration);
            const double power = c.tangential_force * c.slip_velocity;
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
