// Names of frames with a prefix.
#include "node/frames.h"

#include <gtest/gtest.h>

#include <string>

namespace vibratory_alignment {
namespace {

TEST(FramePrefix, IsAnyWordOrPathOfWords) {
  for (const char* good : {"", "left", "cell_2/left", "a/b/c", "robot-1", "v1.2", "2nd"})
    EXPECT_TRUE(is_frame_prefix(good)) << good;
}

TEST(FramePrefix, IsNothingElse) {
  for (const char* bad : {" ", "left arm", "left ", "/left", "left/", "/", "left//arm", "left\n", "left\tarm", "~left",
                          "a:b", "a#b", "l\xc3\xa4uft", "$(arg side)"})
    EXPECT_FALSE(is_frame_prefix(bad)) << bad;
  EXPECT_FALSE(is_frame_prefix(std::string("a\0b", 3)));
}

// REP 105: the world is common to all.
TEST(FramePrefix, StandsBeforeEveryFrameButTheWorld) {
  const Frames frames = frames_with_prefix("left");
  EXPECT_EQ(frames.world, "world");
  EXPECT_EQ(frames.slot, "left/slot");
  EXPECT_EQ(frames.part, "left/part");
  EXPECT_EQ(frames.edge_a1, "left/edge_a1");
  EXPECT_EQ(frames.edge_a2, "left/edge_a2");
}

}  // namespace
}  // namespace vibratory_alignment
