// Stamps against clocks that stand, jump and are set back.
#include <gtest/gtest.h>

#include "node/stamps.h"

namespace vibratory_alignment {
namespace {

const ros::Duration kNanosecond(0, 1);

TEST(Stamps, FollowAClockThatRuns) {
  Stamps stamps{ros::Duration()};
  for (int i = 1; i < 10; ++i) EXPECT_EQ(stamps.next(ros::Time(i, 5)), ros::Time(i, 5));
}

TEST(Stamps, AreNeverZeroNorTwiceTheSame) {
  Stamps stamps{ros::Duration()};
  EXPECT_EQ(stamps.next(ros::Time()), ros::Time(0, 1));
  EXPECT_EQ(stamps.next(ros::Time()), ros::Time(0, 2));
  EXPECT_EQ(stamps.next(ros::Time(7, 0)), ros::Time(7, 0));
  EXPECT_EQ(stamps.next(ros::Time(7, 0)), ros::Time(7, 1));
  EXPECT_EQ(stamps.next(ros::Time(7, 1)), ros::Time(7, 2));
}

TEST(Stamps, OneMoreIsNoReadingOfTheClock) {
  Stamps stamps{ros::Duration()};
  stamps.next(ros::Time(7, 0));
  EXPECT_EQ(stamps.one_more(), ros::Time(7, 1));
  EXPECT_FALSE(stamps.set_back(ros::Time(7, 0)));
  EXPECT_TRUE(stamps.set_back(ros::Time(6, 999999999)));
  EXPECT_FALSE(stamps.set_back(ros::Time())) << "there is no clock";
  EXPECT_EQ(stamps.next(ros::Time(7, 0)), ros::Time(7, 2));
}

TEST(Stamps, FollowASimulatedClockBackAtOnce) {
  Stamps stamps{ros::Duration()};
  stamps.next(ros::Time(7, 0));
  stamps.next(ros::Time(7, 0));
  EXPECT_EQ(stamps.next(ros::Time(6, 999999999)), ros::Time(6, 999999999));
  EXPECT_EQ(stamps.next(ros::Time(6, 999999999)), ros::Time(7, 0));
}

TEST(Stamps, StandingStampsAheadOfTheClockAreNoJump) {
  Stamps stamps{ros::Duration()};
  stamps.next(ros::Time(7, 0));
  for (int i = 0; i < 5; ++i) stamps.next(ros::Time(7, 0));
  EXPECT_EQ(stamps.next(ros::Time(7, 2)), ros::Time(7, 6)) << "behind the last stamp, but not set back";
}

TEST(Stamps, CorrectionsOfTheWallClockNeverReachTheStamps) {
  Stamps stamps{ros::Duration(1.0)};
  const ros::Time last = stamps.next(ros::Time(100, 0));
  EXPECT_EQ(stamps.next(ros::Time(99, 500000000)), last + kNanosecond);
  EXPECT_EQ(stamps.next(ros::Time(98, 0)), ros::Time(98, 0)) << "but a jump does";
}

TEST(Stamps, NoClockAfterAClockIsNoJump) {
  Stamps stamps{ros::Duration()};
  const ros::Time last = stamps.next(ros::Time(7, 0));
  EXPECT_EQ(stamps.next(ros::Time()), last + kNanosecond);
}

}  // namespace
}  // namespace vibratory_alignment
