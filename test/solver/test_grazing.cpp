// Contacts that barely begin or barely hold. A swing to a known gap above or below the edge:
// test/hard/test_grazing_gap.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "../support/runs.h"
#include "../support/scenes.h"
#include "mechanics/contact_frame.h"

namespace vibratory_alignment {
namespace {

/// Flat, exactly as high as the edge and the top surface; it rises and turns about the mass centre.
Scene lifted_from_a_face(double base_distance) {
  Scene scene = test::scene_of(R"(
part: {half_width: 0.4, base_distance: 1.0, inertia: 0.1}
slot: {clearance: 0.01}
gripper: {stiffness: {phi: 1}, anchor: {x: 0, phi: 0, y: 1}}
base: {stiffness: {y: 1.0e+4}, damping: {x: 60, y: 60}}
contacts: [edges, corners]
excitation: {amplitude: 0, frequency: 1}
initial: {x: 0.2, y: 1.0, phi: 0, vy: 0.06, omega: -0.2}
trial: {time_limit: 0.01}
)");
  scene.part.base_distance = base_distance;
  scene.initial.y = base_distance;
  return scene;
}

// vy + omega r_x is 0.018 at the edge, which is left, and -0.02 at the corner, which touches; whatever the last digit
// of the height says.
TEST(Grazing, a_point_that_starts_on_a_face_goes_where_its_velocity_takes_it) {
  std::mt19937 random(61);
  std::uniform_real_distribution<double> u(0.2, 2.0);
  for (int i = 0; i < 100; ++i) {
    const Scene scene = lifted_from_a_face(i == 0 ? 0.2954502860841442 : u(random));
    int touches = 0;
    for (const test::TimedEvent& e : test::events_of(scene)) {
      if (e.event.kind != EventKind::touch) continue;
      ++touches;
      EXPECT_EQ(e.event.site, Site::b1) << scene.part.base_distance;
      EXPECT_EQ(e.time, 0.0) << scene.part.base_distance;
    }
    EXPECT_EQ(touches, 1) << scene.part.base_distance;
  }
}

// Two corners at once, after a flight that began a thousand times faster: the touch is where the depth is zero, to the
// digits of the place and not of where the flight has been.
TEST(Grazing, a_touch_of_two_is_where_the_depth_is_zero) {
  const Scene scene = test::scene_of(R"(
part: {half_width: 0.17, base_distance: 0.9}
slot: {clearance: 4e-09}
gripper: {stiffness: {}, damping: {x: 0, y: 2, phi: 0}, anchor: {x: 0, phi: 0}, pressing_force: 1}
base: {stiffness: {x: 1e+09, y: 1e+09}, damping: {x: 0, y: 7982}, recovery: false}
contacts: [corners]
weight: 0
excitation:
  - {amplitude: 0, frequency: 1, phase: 0, direction: y, waveform: sine}
initial: {x: -0.2, y: 0.8574344303505902, phi: 0.08, vx: 0, vy: 0, omega: 0}
trial: {time_limit: 1e+01, aligned_depth: 0}
solver: {name: event, tolerance: 5e-13, step_limit: 1000}
)");
  const System system = make_system(scene);
  int touches = 0;
  for (const test::TimedEvent& e : test::events_of(scene)) {
    if (e.event.kind != EventKind::touch) continue;
    ++touches;
    EXPECT_NEAR(contact_kinematics(system, e.state, e.event.site, e.event.face).depth, 0.0, 1e-14);
  }
  EXPECT_GT(touches, 0);
}

// A corner held down by a damper until nothing presses it is let go at rest, on the floor, to be pressed again at once:
// a touch whose depth rate is rounding, and for which Newton's method would look far away.
TEST(Grazing, a_touch_from_rest_is_noticed) {
  const Scene scene = test::scene_of(R"(
part: {half_width: 9e+03, base_distance: 23.727339268572276, inertia: 0.07725}
slot: {clearance: 1, depth: 1}
gripper: {stiffness: {phi: 42.59}, damping: {x: 0, y: 0.3425, phi: 0.1}, anchor: {x: 0, phi: 0.11563762452269133}, pressing_force: 6}
base: {stiffness: {x: 1, y: 2e+07}, damping: {x: 0, y: 3e+04}, recovery: false}
contacts: [walls]
weight: 2
excitation:
  - {amplitude: 0.9, frequency: 1, phase: 0, direction: y, waveform: sine}
initial: {x: 0, y: 2e+03, phi: 0.1156, vx: 0, vy: 0.4, omega: -0.2537}
trial: {time_limit: 2, aligned_depth: 0}
solver: {name: event, tolerance: 2e-09, step_limit: 1000}
)");
  const System system = make_system(scene);
  double deepest = 0.0;
  int flights = 0;
  test::run(scene, [&](const Segment& g) {
    if (g.contacts[static_cast<std::size_t>(Site::b2_floor)].phase != Phase::outside) return;
    ++flights;
    for (const double share : {0.13, 0.5, 1.0})
      deepest = std::max(
          deepest, contact_kinematics(system, state_at(g, share * g.duration), Site::b2_floor, Face::floor).depth);
  });
  EXPECT_GT(flights, 3);
  EXPECT_LE(deepest, 1e-9);  // lengths are 1e4
}

// With less than the pressing force the excitation never lifts the part: |A| < f0 + w.
TEST(Grazing, nothing_bounces_below_the_pressing_force) {
  for (const double amplitude : {0.7, 1.2}) {
    Scene scene = test::scene_of(test::ball, {"gripper={pressing_force: 0.8, damping: {y: 0.05}}", "initial.y=null"});
    scene.excitations[0].frequency = 20.0;
    scene.excitations[0].amplitude = amplitude;
    const long impacts = test::total_impacts(test::run(scene, {}, 10.0));
    if (amplitude < 0.8)
      EXPECT_EQ(impacts, 0);
    else
      EXPECT_GT(impacts, 3);
  }
}

// Resting on the base under a slow lift that is a hair more or less than the load: N = (f0 - A sin(nu tau)) k/(k + 1),
// but for what the motion of the base adds, nu^2 A/k = 1e-7. The contact opens or it does not.
TEST(Grazing, a_contact_that_barely_holds) {
  for (const double sign : {1.0, -1.0})
    for (const double size : {1e-2, 1e-4, 1e-6}) {
      Scene scene = test::scene_of(test::ball, {"gripper={pressing_force: 0.5}", "initial.y=null"});
      scene.base = {1e4, 1e4, 200.0, 200.0, false};
      scene.excitations[0].frequency = 0.05;
      scene.excitations[0].amplitude = 0.5 * (1.0 + sign * size);
      long releases = 0;
      test::run(
          scene,
          [&](const Segment& g) {
            for (int i = 0; i < g.event_count; ++i)
              releases += g.events[static_cast<std::size_t>(i)].kind == EventKind::release;
          },
          60.0);
      EXPECT_EQ(releases > 0, sign > 0.0) << sign * size;
    }
}

// A part that starts on the base, without a damper, with a speed of which N rises by less than last digits of lengths:
// it touches and is thrown back, no faster than it came but for the last digit of a depth, or is lifted off by the
// spring.
TEST(Grazing, a_landing_of_the_last_digits_ends) {
  for (const double half_width : {1.0, 100.0, 1e3, 1e4})
    for (const double anchor : {1.0, 2.0})
      for (double speed = 1e-16; speed < 1e-6; speed *= 1.7) {
        Scene scene = test::scene_of(R"(
part: {half_width: 1, base_distance: 1}
slot: {clearance: 0.1}
gripper: {stiffness: {x: 0}, anchor: {x: 0.5, y: 1}}
base: {stiffness: {y: 1.0e+8}}
contacts: [edges]
excitation: {amplitude: 0, frequency: 1}
initial: {x: 0.5, y: 1, phi: 0}
trial: {time_limit: 0.5}
)");
        scene.part.half_width = half_width;
        scene.gripper.anchor_y = anchor;
        scene.initial.vy = -speed;
        const TrialResult result = test::run(scene);
        ASSERT_NE(result.outcome, Outcome::failed)
            << result.failure << " " << half_width << " " << anchor << " " << speed;
        // pulled up by anchor - 1 for half a time unit at most
        EXPECT_LE(std::abs(result.final_state.vy), speed + 0.5 * (anchor - 1.0) + 1e4 * 3e-16)
            << half_width << " " << speed;
      }
}

// A part let down into the slot beside a wall, on whose line its corner is to the last digits: both corners stand on
// the floor, level, y = -depth + b less half the load over k each.
TEST(Grazing, a_corner_on_the_line_of_a_wall_stands_on_the_floor) {
  for (const char* solver : {"event", "implicit", "auto", "rk4"})
    for (const double sign : {1.0, -1.0})
      for (const double beside : {-3e-16, 0.0, 3e-16}) {
        Scene scene = test::scene_of(R"(
part: {half_width: 1, base_distance: 1, inertia: 0.5}
slot: {clearance: 0.01, depth: 0.5}
gripper: {stiffness: {x: 0, phi: 1}, damping: {y: 0.2}, anchor: {x: 0.01, y: 0}}
base: {stiffness: {y: 1000}, damping: {x: 10, y: 10}}
contacts: [walls]
excitation: {amplitude: 0, frequency: 1}
initial: {x: 0.01, y: 1.2, phi: 0}
trial: {time_limit: 30}
)");
        scene.solver.name = solver;
        if (scene.solver.name == "rk4") scene.solver.step = 1e-3;
        scene.initial.x = scene.gripper.anchor_x = sign * (0.01 + beside);
        double most = 0.0;
        const auto follow = [&](const Segment& g) { most = std::max(most, std::abs(g.end.phi)); };
        const TrialResult result = test::run(scene, follow, 30.0);
        EXPECT_LE(most, 1e-12) << solver << " " << sign << " " << beside;
        EXPECT_NEAR(result.final_state.y, 0.5 - 0.5 / 2001.0, 1e-3) << solver << " " << sign << " " << beside;
      }
}

}  // namespace
}  // namespace vibratory_alignment
