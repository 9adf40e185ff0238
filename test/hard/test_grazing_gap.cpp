// Grazing (hard/grazing): a swing whose lowest point is a known gap above or below the edge. A gap counts down to the
// last digits of the height, on either side: no impact is missed, none is invented.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/hard_scene.h"
#include "../support/runs.h"

namespace vibratory_alignment {
namespace {

constexpr double kUlp = 0x1p-52;  // of the heights below, between 1 and 2
constexpr double kRadius = 0.25;

/// y = y_a + R cos tau from rest at the top. All numbers are binary fractions, so that `gap` (a multiple of kUlp) is
/// exactly the least distance.
TrialResult swing(double gap) {
  Scene scene = test::hard_scene("grazing");
  scene.gripper.anchor_y = scene.part.base_distance + kRadius + gap;
  scene.initial.y = scene.part.base_distance + 2.0 * kRadius + gap;
  return test::run(scene);
}

TEST(GrazingGap, its_side_decides) {
  for (const double size : {1e-3, 1e-6, 1e-9, 1e-12, 1e-14}) {
    const double gap = std::round(size / kUlp) * kUlp;
    EXPECT_EQ(test::total_impacts(swing(gap)), 0) << gap;
    EXPECT_EQ(test::total_impacts(swing(-gap)), 1) << -gap;
  }
}

// The scene as it stands in the file: no impact.
TEST(GrazingGap, of_the_scene_is_1e_minus_9) {
  EXPECT_EQ(test::total_impacts(test::run(test::hard_scene("grazing"))), 0);
  EXPECT_EQ(test::total_impacts(
                test::run(test::hard_scene("grazing", {"gripper.anchor.y=1.124999999", "initial.y=1.374999999"}))),
            1);
}

// 1e-9 above to 1e-9 below in fine steps: one change, at the gap 0 (to the last digits of the height).
TEST(GrazingGap, a_fine_scan_changes_once) {
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
TEST(GrazingGap, impact_speed_grows_as_the_root_of_the_excess) {
  for (const double size : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    const double excess = std::round(size / kUlp) * kUlp;
    const TrialResult result = swing(-excess);
    ASSERT_TRUE(result.first_contact);
    const double speed = std::sqrt(excess * (2.0 * kRadius - excess));
    // the last digit of the height is worth ulp R / v of speed
    EXPECT_NEAR(result.first_contact->approach_speed, speed, 2.0 * kUlp * kRadius / speed + 1e-15) << excess;
    EXPECT_NEAR(result.first_contact->time, 3.14159265358979323846 - std::acos(1.0 - excess / kRadius),
                4.0 * kUlp / speed)
        << excess;
  }
}

}  // namespace
}  // namespace vibratory_alignment
