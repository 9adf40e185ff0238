// What the plot keeps of a run.
#include <algorithm>

#include <gtest/gtest.h>

#include "rviz_panel/history.h"

namespace vibratory_alignment {
namespace {

TEST(HistoryTest, KeepsEveryPointWhileThereIsRoom) {
  History history(10);
  for (int i = 0; i < 10; ++i) history.add({0.1 * i, 1.0 * i, 2.0 * i, 3.0 * i});
  ASSERT_EQ(history.points().size(), 10U);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(history.points()[static_cast<std::size_t>(i)].force_a2, 3.0 * i);
}

TEST(HistoryTest, LongRunsKeepTheirPeaksTheirEndAndTheirOrder) {
  constexpr int kCount = 100000;
  History history(100);
  for (int i = 0; i < kCount; ++i) {
    history.add({1.0 * i, 5.0 + i, i == 31234 ? 7.0 : 1.0, i == 77777 ? 8.0 : 0.0});
    ASSERT_LE(history.points().size(), 100U);
  }
  const std::vector<HistoryPoint>& points = history.points();
  EXPECT_GE(points.size(), 50U);
  EXPECT_EQ(points.back().time, kCount - 1.0);
  EXPECT_EQ(points.back().misalignment, 5.0 + kCount - 1.0);
  const auto time_of = [&](double HistoryPoint::*force, double peak) {
    const auto found =
        std::find_if(points.begin(), points.end(), [&](const HistoryPoint& p) { return p.*force == peak; });
    return found == points.end() ? -1.0 : found->time;
  };
  // a point stands for at most 100000/50 = 2000 samples, and bears the time of the last
  EXPECT_GE(time_of(&HistoryPoint::force_a1, 7.0), 31234.0);
  EXPECT_LT(time_of(&HistoryPoint::force_a1, 7.0), 31234.0 + 4000.0);
  EXPECT_GE(time_of(&HistoryPoint::force_a2, 8.0), 77777.0);
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_LT(points[i - 1].time, points[i].time);
}

TEST(HistoryTest, TimeThatDoesNotGoOnBeginsANewRun) {
  History history(4);
  for (int i = 0; i < 9; ++i) history.add({1.0 * i, 1.0, 1.0, 1.0});
  history.add({0.0, 2.0, 0.0, 0.0});
  history.add({1.0, 2.0, 0.0, 0.0});
  ASSERT_EQ(history.points().size(), 2U) << "and no point stands for several any more";
  EXPECT_EQ(history.points()[0].misalignment, 2.0);
  for (int i = 0; i < 2; ++i) history.add({0.0, 3.0, 0.0, 0.0});  // twice set back to the start
  EXPECT_EQ(history.points().size(), 1U);
}

}  // namespace
}  // namespace vibratory_alignment
