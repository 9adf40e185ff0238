// Grazing: a swing whose lowest point is a known gap above or below the edge. A gap counts down to the last digits of
// the height, on either side: no impact is missed, none is invented.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "../support/runs.h"
#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

constexpr double kUlp = 0x1p-52;  // of the heights below, between 1 and 2

/// y = y_a + R cos tau from rest at the top; the bottom face is at the height of the edge for y = b = 0.875.
/// All numbers are binary fractions, so that `gap` (a multiple of kUlp) is exactly the least distance.
TrialResult swing(double gap) {
  const double b = 0.875, radius = 0.25;
  Scene scene = test::scene_of(test::ball);
  scene.part.base_distance = b;
  scene.gripper.anchor_y = b + radius + gap;
  scene.initial.y = b + 2.0 * radius + gap;
  scene.trial.time_limit = 5.0;
  return test::run(scene, {}, 5.0);
}

TEST(Grazing, the_side_of_the_gap_decides) {
  for (const double size : {1e-3, 1e-6, 1e-9, 1e-12, 1e-14}) {
    const double gap = std::round(size / kUlp) * kUlp;
    EXPECT_EQ(test::total_impacts(swing(gap)), 0) << gap;
    EXPECT_EQ(test::total_impacts(swing(-gap)), 1) << -gap;
  }
}

// 1e-9 above to 1e-9 below in fine steps: one change, at the gap 0 (to the last digits of the height).
TEST(Grazing, a_fine_scan_changes_once) {
  const int steps = 200;
  for (const double range : {1e-9, 200 * 4 * kUlp}) {
    for (int i = -steps; i <= steps; ++i) {
      const double gap = std::round(range * i / steps / kUlp) * kUlp;
      if (std::abs(gap) <= 3.0 * kUlp) continue;
      ASSERT_EQ(test::total_impacts(swing(gap)), gap < 0.0 ? 1 : 0) << "gap " << gap;
    }
  }
}

// v^2 = R^2 - (R - excess)^2, at tau = pi - acos(1 - excess/R).
TEST(Grazing, impact_speed_grows_as_the_root_of_the_excess) {
  for (const double size : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    const double excess = std::round(size / kUlp) * kUlp;
    const TrialResult result = swing(-excess);
    ASSERT_TRUE(result.first_contact);
    const double speed = std::sqrt(excess * (0.5 - excess));
    // the last digit of the height is worth ulp R / v of speed
    EXPECT_NEAR(result.first_contact->approach_speed, speed, 2.0 * kUlp * 0.25 / speed + 1e-15) << excess;
    EXPECT_NEAR(result.first_contact->time, 3.14159265358979323846 - std::acos(1.0 - 4.0 * excess), 4.0 * kUlp / speed)
        << excess;
  }
}

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

}  // namespace
}  // namespace vibratory_alignment
