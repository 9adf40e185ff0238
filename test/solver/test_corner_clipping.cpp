// An edge that clips a corner of the part: in through one face and out through the other within one flight. The way is
// straight or a circle, so that depth and instant of the clip are known.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../support/runs.h"
#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

/// No forces in flight: the springs are at ease or absent. The slot is wide: one edge at a time.
const std::string drifting = R"(
part: {half_width: 0.6, base_distance: 0.8, inertia: 0.2}
slot: {clearance: 0.9}
gripper: {stiffness: {x: 0.0, phi: 0.0}, anchor: {y: 1.0}}
base: {stiffness: {y: 100.0}}
contacts: [edges]
excitation: {amplitude: 0.0, frequency: 1.0}
initial: {x: 0.0, y: 1.0, phi: 0.0}
trial: {time_limit: 1.0, aligned_depth: 5.0}
)";

constexpr double kHalfWidth = 0.6, kBase = 0.8, kSlot = 1.5;

/// The tilted part goes along x with its lower left corner `depth` below the edges.
Scene sliding_by(double phi, double depth, double speed, double start_x) {
  Scene s = test::scene_of(drifting, {"part.inertia=null"});
  s.initial.phi = phi;
  s.initial.y = kHalfWidth * std::sin(std::abs(phi)) + kBase * std::cos(phi) - depth;
  s.gripper.anchor_y = *s.initial.y;
  s.initial.x = start_x;
  s.initial.vx = speed;
  s.trial.time_limit = 1.9 / std::abs(speed);
  return s;
}

// Going right with phi > 0, edge A1 comes in through the bottom, right of the lower left corner, where
// (A1 - C).e2 = -b: x = l - (b - y cos phi)/sin phi.
TEST(CornerClipping, a_sliding_corner_touches_however_little_it_reaches_below) {
  for (const double phi : {0.3, 0.7, 1.1})
    for (const double speed : {0.01, 1.0, 50.0})
      for (const double depth : {1e-2, 1e-4, 1e-7, 1e-10, 1e-13}) {
        // the corner starts in the middle of the slot
        const double start = kHalfWidth * std::cos(phi) - kBase * std::sin(phi);
        const Scene s = sliding_by(phi, depth, speed, start);
        const TrialResult r = test::run(s);
        ASSERT_GE(r.impacts[0], 1) << "phi " << phi << " depth " << depth;
        const double x = kSlot - (kBase - *s.initial.y * std::cos(phi)) / std::sin(phi);
        EXPECT_NEAR(r.first_contact->time, (x - start) / speed, 4e-15 / speed / std::sin(phi)) << depth;
        EXPECT_NEAR(r.first_contact->slip_velocity, speed * std::cos(phi), 1e-13 * speed);
        EXPECT_EQ(test::total_impacts(test::run(sliding_by(phi, -depth, speed, start))), 0)
            << "phi " << phi << " gap " << depth;
      }
}

// So fast that one step, as long as the springs allow, reaches a hundred million times as far.
TEST(CornerClipping, an_edge_early_in_a_long_step_is_not_too_short_a_visit) {
  for (const double depth : {1e-3, 1e-6, 1e-9, 1e-12}) {
    const double phi = 0.7, start = 0.0, speed = 1e8;
    Scene s = sliding_by(phi, depth, speed, start);
    s.trial.time_limit = 1.0;
    const TrialResult r = test::run(s);
    ASSERT_GE(r.impacts[0], 1) << depth;
    const double x = kSlot - (kBase - *s.initial.y * std::cos(phi)) / std::sin(phi);
    EXPECT_NEAR(r.first_contact->time, (x - start) / speed, 4e-15 / speed / std::sin(phi)) << depth;
  }
}

// Mirrored, and through the side: going left with phi > 0 the edge comes in through the left side.
TEST(CornerClipping, through_the_side_as_well) {
  for (const double depth : {1e-3, 1e-8, 1e-12}) {
    const TrialResult r = test::run(sliding_by(0.7, depth, -1.0, 2.0));
    ASSERT_GE(r.impacts[0], 1) << depth;
    // V on the left side: v.t with n = e1, t = (n_y, -n_x)
    EXPECT_NEAR(r.first_contact->slip_velocity, -std::sin(0.7), 1e-12);
    EXPECT_EQ(test::total_impacts(test::run(sliding_by(0.7, -depth, -1.0, 2.0))), 0) << depth;
    const TrialResult mirrored = test::run(sliding_by(-0.7, depth, 1.0, -2.0));
    EXPECT_GE(mirrored.impacts[1], 1);
    EXPECT_EQ(mirrored.first_contact->time, r.first_contact->time);
  }
}

/// The part turns about its resting centre; its lower right corner (radius 1) passes the edge A1 within `reach`.
Scene turning_by(double reach, double omega) {
  Scene s = test::scene_of(drifting);
  // the edge lies at the angle -45 degrees from C, as far away as the corner less `reach`
  const double radius = std::hypot(kHalfWidth, kBase) - reach, down = radius * std::sqrt(0.5);
  s.initial.x = kSlot - down;
  s.initial.y = down;
  s.gripper.anchor_y = down;
  // the corner itself lies at the angle -atan(b/a) = -53.1 degrees at phi = 0; start 0.35 before it passes
  const double passing = std::atan2(kBase, kHalfWidth) - 0.25 * 3.14159265358979323846;
  s.initial.phi = passing - 0.35 * (omega > 0.0 ? 1.0 : -1.0);
  s.initial.omega = omega;
  s.trial.time_limit = 0.6 / std::abs(omega);
  return s;
}

TEST(CornerClipping, a_turning_corner_touches_however_little_it_reaches_over) {
  for (const double omega : {0.5, -0.5, 8.0, -8.0})
    for (const double reach : {1e-3, 1e-6, 1e-9, 1e-12, 1e-14}) {
      const Scene s = turning_by(reach, omega);
      const TrialResult r = test::run(s);
      ASSERT_GE(r.impacts[0], 1) << omega << " " << reach;
      // before the corner by the angle at which the face (at b or a from C) reaches the edge's radius
      const double radius = std::hypot(kHalfWidth, kBase) - reach, face = omega > 0.0 ? kHalfWidth : kBase;
      const double early = std::acos(face / radius) - std::acos(face / std::hypot(kHalfWidth, kBase));
      EXPECT_NEAR(r.first_contact->time, (0.35 + early) / std::abs(omega), 2e-15 / std::abs(omega))
          << omega << " " << reach;
      EXPECT_EQ(test::total_impacts(test::run(turning_by(-reach, omega))), 0) << omega << " " << reach;
    }
}

// Fast, so that a sampled search would step over it.
TEST(CornerClipping, many_turns_in_one_flight_miss_nothing) {
  // edges lie outside the circle of the corners but inside that of the side faces' upper part, which has no end
  Scene s = test::scene_of(
      drifting, {"initial.omega=40", "trial.time_limit=5", "initial.y=3.0", "gripper.anchor.y=3.0", "initial.x=0.2"});
  const TrialResult r = test::run(s);
  ASSERT_TRUE(r.first_contact);
  // the first face that reaches an edge: |u| = a of the turning strip; found here on a fine grid of angles
  double first = INFINITY;
  for (const double edge : {kSlot, -kSlot})
    for (double t = 0.0; t < 0.2 && t < first; t += 1e-7) {
      const double phi = 40.0 * t, c = std::cos(phi), n = std::sin(phi), rx = edge - 0.2, ry = -3.0;
      if (std::abs(rx * c + ry * n) < kHalfWidth && ry * c - rx * n > -kBase) first = t;
    }
  EXPECT_NEAR(r.first_contact->time, first, 2e-7);
}

}  // namespace
}  // namespace vibratory_alignment
