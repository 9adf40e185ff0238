// The shrinker keeps what a fault needs and takes out the rest.
#include <gtest/gtest.h>

#include "model/scene_loader.h"
#include "random_changes.h"
#include "random_scene.h"
#include "scene_text.h"
#include "shrink.h"

namespace vibratory_alignment::hunt {
namespace {

// A fault that needs friction and a stiff base, and nothing else.
bool fails(const Trial& t) { return t.scene.friction && t.scene.base.stiffness_y > 3000.0; }

TEST(Shrink, keeps_the_fault_and_nothing_else) {
  int shrunk = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Scene scene = random_scene(seed, Range::wild);
    if (!fails(scene)) continue;
    ++shrunk;
    const Scene simple = shrink(scene, fails, 10000).scene;
    EXPECT_TRUE(fails(simple));
    EXPECT_TRUE(simple.excitations.empty());
    EXPECT_FALSE(simple.friction->regularization);
    EXPECT_FALSE(simple.base.recovery);
    EXPECT_FALSE(simple.slot.depth);
    EXPECT_FALSE(simple.gripper.x.moves);
    EXPECT_EQ(simple.weight, 0.0);
    EXPECT_EQ(simple.friction->coefficient, 1.0);
    EXPECT_EQ(simple.contacts.edges + simple.contacts.corners + simple.contacts.walls, 1);
    EXPECT_NO_THROW(load_scene(YAML::Load(scene_text(simple)), "simple"));  // it can be kept as a file
  }
  EXPECT_GT(shrunk, 15);
}

TEST(Shrink, asks_no_more_often_than_it_may) {
  int asked = 0;
  const auto count = [&](const Trial& t) { return ++asked, fails(t); };
  shrink(random_scene(1, Range::wild), count, 20);
  EXPECT_EQ(asked, 20);
}

TEST(Shrink, leaves_a_scene_alone_that_only_fails_as_it_is) {
  const Scene scene = random_scene(3, Range::ordinary);
  const Scene same = shrink(
                         scene, [](const Trial&) { return false; }, 10000)
                         .scene;
  EXPECT_EQ(same.base.stiffness_y, scene.base.stiffness_y);
  EXPECT_EQ(same.excitations.size(), scene.excitations.size());
  EXPECT_EQ(same.trial.time_limit, scene.trial.time_limit);
}

// A fault that needs a change of the second excitation's amplitude, and nothing else.
TEST(Shrink, keeps_the_change_that_the_fault_needs) {
  const auto needs_change = [](const Trial& t) {
    if (t.scene.excitations.size() < 2) return false;
    for (const Change& c : t.changes)
      if (c.excitations && c.excitations->size() > 1 &&
          (*c.excitations)[1].amplitude != t.scene.excitations[1].amplitude)
        return true;
    return false;
  };
  int shrunk = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Scene scene = random_scene(seed, Range::ordinary);
    const Trial trial(scene, random_changes(seed, scene));
    if (!needs_change(trial)) continue;
    ++shrunk;
    const Trial simple = shrink(trial, needs_change, 10000);
    ASSERT_EQ(simple.changes.size(), 1u);
    const Change& change = simple.changes.front();
    EXPECT_FALSE(change.pressing_force);
    EXPECT_FALSE(change.cut_late);
    ASSERT_EQ(simple.scene.excitations.size(), 2u);
    ASSERT_EQ(change.excitations->size(), 2u);
    for (const std::size_t i : {0u, 1u}) EXPECT_EQ((*change.excitations)[i].waveform, Waveform::sine);
    EXPECT_EQ((*change.excitations)[0].amplitude, simple.scene.excitations[0].amplitude);
    EXPECT_EQ((*change.excitations)[1].frequency, simple.scene.excitations[1].frequency);
  }
  EXPECT_GT(shrunk, 3);
}

// What is excited no more is not changed either.
TEST(Shrink, drops_an_excitation_wherever_it_is_set) {
  const auto is_changed = [](const Trial& t) { return !t.changes.empty() && t.changes[0].excitations; };
  Trial trial = random_scene(1, Range::ordinary);
  trial.scene.excitations = {{Direction::x, Waveform::square, 1.0, 5.0}, {Direction::y, Waveform::sine, 1.0, 7.0}};
  trial.changes.resize(1);
  trial.changes[0].excitations = trial.scene.excitations;
  const Trial simple = shrink(trial, is_changed, 10000);
  EXPECT_TRUE(simple.scene.excitations.empty());
  EXPECT_TRUE(simple.changes[0].excitations->empty());
}

}  // namespace
}  // namespace vibratory_alignment::hunt
