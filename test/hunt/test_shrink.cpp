// The shrinker keeps what a fault needs and takes out the rest.
#include <gtest/gtest.h>

#include "random_scene.h"
#include "shrink.h"

namespace vibratory_alignment::hunt {
namespace {

// A fault that needs friction and a stiff base, and nothing else.
bool fails(const Scene& s) { return s.friction && s.base.stiffness_y > 3000.0; }

TEST(Shrink, keeps_the_fault_and_nothing_else) {
  int shrunk = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Scene scene = random_scene(seed, Range::wild);
    if (!fails(scene)) continue;
    ++shrunk;
    const Scene simple = shrink(scene, fails, 10000);
    EXPECT_TRUE(fails(simple));
    EXPECT_TRUE(simple.excitations.empty());
    EXPECT_FALSE(simple.friction->regularization);
    EXPECT_FALSE(simple.base.recovery);
    EXPECT_FALSE(simple.slot.depth);
    EXPECT_FALSE(simple.gripper.x.moves);
    EXPECT_EQ(simple.weight, 0.0);
    EXPECT_EQ(simple.friction->coefficient, 1.0);
    EXPECT_EQ(simple.contacts.edges + simple.contacts.corners + simple.contacts.walls, 1);
  }
  EXPECT_GT(shrunk, 50);
}

TEST(Shrink, asks_no_more_often_than_it_may) {
  int asked = 0;
  const auto count = [&](const Scene& s) { return ++asked, fails(s); };
  shrink(random_scene(1, Range::wild), count, 20);
  EXPECT_EQ(asked, 20);
}

TEST(Shrink, leaves_a_scene_alone_that_only_fails_as_it_is) {
  const Scene scene = random_scene(3, Range::ordinary);
  const Scene same = shrink(
      scene, [](const Scene&) { return false; }, 10000);
  EXPECT_EQ(same.base.stiffness_y, scene.base.stiffness_y);
  EXPECT_EQ(same.excitations.size(), scene.excitations.size());
  EXPECT_EQ(same.trial.time_limit, scene.trial.time_limit);
}

}  // namespace
}  // namespace vibratory_alignment::hunt
