// Where an axis has its marks.
#include <cmath>

#include <gtest/gtest.h>

#include "rviz_panel/ticks.h"

namespace vibratory_alignment {
namespace {

TEST(TicksTest, AreRoundNumbersWithinTheRange) {
  EXPECT_EQ(ticks(0.0, 1.0, 5), (std::vector<double>{0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0}));
  EXPECT_EQ(ticks(0.0, 39.0, 4), (std::vector<double>{0.0, 10.0, 20.0, 30.0}));
  EXPECT_EQ(ticks(3.0, 9.0, 2), (std::vector<double>{5.0}));
}

TEST(TicksTest, AreNeverTooManyForAnySizeOfRange) {
  for (double high = 1e-12; high < 1e12; high *= 1.37) {
    for (int count = 2; count < 12; ++count) {
      const std::vector<double> marks = ticks(0.0, high, count);
      ASSERT_GE(marks.size(), 1U) << high;
      ASSERT_LE(marks.size(), static_cast<std::size_t>(count) + 1) << high << " " << count;
      ASSERT_LE(marks.back(), high * (1.0 + 1e-9));
    }
  }
}

TEST(TicksTest, AnEmptyRangeHasNone) {
  EXPECT_TRUE(ticks(1.0, 1.0, 5).empty());
  EXPECT_TRUE(ticks(0.0, NAN, 5).empty());
  EXPECT_TRUE(ticks(0.0, INFINITY, 5).empty());
}

}  // namespace
}  // namespace vibratory_alignment
