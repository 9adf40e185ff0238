// Flat landings: two contacts at the same instant. On edge and corner that do not feel each other (hard/flat_landing),
// and on both edges, alike (hard/two_edges).
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../support/hard_scene.h"
#include "../support/mirror.h"
#include "../support/restitution.h"
#include "../support/runs.h"

namespace vibratory_alignment {
namespace {

using test::TimedEvent;

/// Largest number of events at or within `gap` of one another.
int most_at_once(const std::vector<TimedEvent>& events, double gap) {
  int most = 0;
  for (const TimedEvent& first : events) {
    int n = 0;
    for (const TimedEvent& e : events) n += e.time >= first.time && e.time <= first.time + gap;
    most = std::max(most, n);
  }
  return most;
}

// r_1 r_2 = -mu: a force at one contact leaves the other where it is. Each has the mass 1/(1 + r^2/mu) to stop.
TEST(FlatLanding, edge_and_corner_are_two_impacts) {
  const Scene scene = test::hard_scene("flat_landing");
  const double mu = scene.gripper.phi.inertia, k = scene.base.stiffness_y, h = scene.base.damping_y;
  const double lever[2] = {scene.slot_half_width() - scene.initial.x, scene.part.half_width};
  ASSERT_NEAR(lever[0] * lever[1], -mu, 1e-15);
  const TrialResult result = test::run(scene);
  ASSERT_TRUE(result.first_contact);
  double up[2];
  for (int i = 0; i < 2; ++i) {
    const double mass = 1.0 / (1.0 + lever[i] * lever[i] / mu);
    up[i] = test::linear_restitution(h / (2.0 * std::sqrt(k * mass))) * result.first_contact->approach_speed;
  }
  const double omega = (up[1] - up[0]) / (lever[1] - lever[0]), vy = up[0] - omega * lever[0];
  // the springs of the gripper act for 1e-3 meanwhile, with a force of 1e-3
  EXPECT_NEAR(result.final_state.vy, vy, 1e-5);
  EXPECT_NEAR(result.final_state.omega, omega, 1e-5);
  EXPECT_EQ(result.impacts, (std::array<long, 4>{1, 0, 1, 0}));
}

TEST(FlatLanding, edge_and_corner_touch_at_once_and_do_not_chatter) {
  const std::vector<TimedEvent> events = test::events_of(test::hard_scene("flat_landing"));
  ASSERT_EQ(events.size(), 6u);  // touch, release, close of each
  EXPECT_EQ(events[0].event.kind, EventKind::touch);
  EXPECT_EQ(events[1].event.kind, EventKind::touch);
  EXPECT_NEAR(events[0].time, events[1].time, 1e-13);
  EXPECT_EQ(most_at_once(events, 1e-9), 2);
}

TEST(FlatLanding, is_mirrored_in_the_mirrored_scene) {
  const Scene scene = test::hard_scene("flat_landing");
  const TrialResult right = test::run(scene), left = test::run(test::mirrored(scene));
  EXPECT_LT(test::distance(right.final_state, test::mirrored(left.final_state)), 1e-13);
  EXPECT_EQ(left.impacts, (std::array<long, 4>{0, 1, 0, 1}));
}

// Twice the stiffness and twice the damping: zeta times the root of 2.
TEST(TwoEdges, are_one_base_of_twice_the_stiffness) {
  const Scene scene = test::hard_scene("two_edges");
  const double zeta = scene.base.damping_y / std::sqrt(2.0 * scene.base.stiffness_y);
  ASSERT_NEAR(zeta, 0.1, 1e-15);
  const TrialResult result = test::run(scene);
  const double rise = result.final_state.y - *scene.gripper.anchor_y;
  EXPECT_NEAR(std::hypot(result.final_state.vy, rise) / result.first_contact->approach_speed,
              test::linear_restitution(zeta), 1e-5);
}

// Half a turn and no more: pi/2 is rounded by 6e-17, which is the difference of the depths.
TEST(TwoEdges, share_alike_and_do_not_turn_the_part) {
  const Scene scene = test::hard_scene("two_edges", {"trial.time_limit=8"});
  const auto look = [](const Segment& g) {
    if (g.duration > 1e-12) {
      ASSERT_TRUE(g.loaded_count == 0 || g.loaded_count == 2);
    }
  };
  const TrialResult result = test::run(scene, look, 8.0);
  EXPECT_GE(result.impacts[0], 3);
  EXPECT_EQ(result.impacts[0], result.impacts[1]);
  EXPECT_NEAR(result.peak_force[0], result.peak_force[1], 1e-9 * result.peak_force[0]);
  EXPECT_NEAR(result.final_state.phi, *scene.initial.phi, 1e-12);
  EXPECT_NEAR(result.final_state.x, 0.0, 1e-12);
}

}  // namespace
}  // namespace vibratory_alignment
