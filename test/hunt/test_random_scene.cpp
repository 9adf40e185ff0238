// Random scenes: the same for the same seed, of every kind, and written as a file that is read back bit for bit.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "dice.h"
#include "model/scene_loader.h"
#include "random_scene.h"
#include "scene_text.h"

namespace vibratory_alignment::hunt {
namespace {

TEST(Dice, neighbouring_seeds_share_no_number) {
  std::set<double> numbers;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Dice dice(seed);
    for (int i = 0; i < 100; ++i) numbers.insert(dice.uniform());
  }
  EXPECT_EQ(numbers.size(), 10000u);
}

// The mean of n uniform numbers is within 5 / sqrt(12 n) of the middle, but for one case in two million.
TEST(Dice, is_fair) {
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < 10000; ++seed) sum += Dice(seed).uniform();
  EXPECT_NEAR(sum / 10000.0, 0.5, 5.0 / std::sqrt(12.0 * 10000.0));
  Dice dice(1);
  for (int i = 0; i < 1000; ++i) {
    const int face = dice.below(6);
    EXPECT_TRUE(face >= 0 && face < 6);
    const double length = dice.decades(1e-3, 1e3);
    EXPECT_TRUE(length >= 0.999e-3 && length <= 1.001e3);
  }
}

TEST(RandomScene, calls_for_everything_there_is) {
  for (const Range range : {Range::ordinary, Range::wild, Range::round}) {
    int recovery = 0, frictionless = 0, regularised = 0, locked_x = 0, locked_phi = 0, floor = 0, still = 0,
        at_rest = 0;
    std::set<Waveform> waveforms;
    std::set<Direction> directions;
    std::set<int> contacts;
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
      const Scene s = random_scene(seed, range);
      recovery += s.base.recovery;
      frictionless += !s.friction;
      regularised += s.friction && s.friction->regularization;
      locked_x += !s.gripper.x.moves;
      locked_phi += !s.gripper.phi.moves;
      floor += s.slot.depth.has_value();
      still += s.excitations.empty();
      at_rest += !s.initial.y;
      contacts.insert(s.contacts.edges + 2 * s.contacts.corners + 4 * s.contacts.walls);
      for (const Excitation& e : s.excitations) {
        waveforms.insert(e.waveform);
        directions.insert(e.direction);
      }
    }
    for (const int count : {recovery, frictionless, regularised, locked_x, locked_phi, floor, still, at_rest})
      EXPECT_GT(count, 50);
    EXPECT_EQ(waveforms.size(), 4u);
    EXPECT_EQ(directions.size(), 3u);
    EXPECT_EQ(contacts.size(), 7u);
  }
}

// The text holds all there is to a scene: read back and written again it is the same text.
TEST(SceneText, is_read_back_bit_for_bit) {
  for (const Range range : {Range::ordinary, Range::wild, Range::round})
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
      const Scene scene = random_scene(seed, range);
      const std::string text = scene_text(scene);
      const Scene read = load_scene(YAML::Load(text), "random");
      EXPECT_EQ(scene_text(read), text);
      EXPECT_EQ(read.base.stiffness_y, scene.base.stiffness_y);
      EXPECT_EQ(read.gripper.phi.moves, scene.gripper.phi.moves);
      EXPECT_EQ(read.initial.phi.has_value(), scene.initial.phi.has_value());
      EXPECT_EQ(read.trial.time_limit, scene.trial.time_limit);
    }
}

}  // namespace
}  // namespace vibratory_alignment::hunt
