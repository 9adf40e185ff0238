// What is reported of the pace.
#include <gtest/gtest.h>

#include "node/pace_meter.h"

namespace vibratory_alignment {
namespace {

using std::chrono::seconds;
const PaceMeter::Clock::time_point kStart{std::chrono::hours(5)};

TEST(PaceMeter, CountsTheTimeThatItRunsAlone) {
  PaceMeter meter;
  meter.set_running(true, kStart);
  for (int i = 0; i < 30; ++i) meter.add_sample(0.01);
  meter.set_running(false, kStart + seconds(3));
  meter.add_sample(5.0);  // a step while it pauses
  meter.set_running(true, kStart + seconds(10));
  meter.set_running(true, kStart + seconds(11));
  const PaceReport report = meter.take(kStart + seconds(12));
  EXPECT_DOUBLE_EQ(report.running, 5.0);
  EXPECT_NEAR(report.simulated, 0.3, 1e-12);
  EXPECT_NEAR(report.real_time_factor(), 0.06, 1e-12);
  EXPECT_DOUBLE_EQ(report.rate(), 6.0);
}

TEST(PaceMeter, BeginsAnewWithEveryReport) {
  PaceMeter meter;
  meter.set_running(true, kStart);
  meter.add_sample(1.0);
  meter.add_dropped(0.7);
  EXPECT_EQ(meter.take(kStart + seconds(1)).dropped, 0.7);
  const PaceReport second = meter.take(kStart + seconds(2));
  EXPECT_EQ(second.running, 1.0);
  EXPECT_EQ(second.simulated, 0.0);
  EXPECT_EQ(second.dropped, 0.0);
}

TEST(PaceMeter, ReportsNothingWhileNothingRuns) {
  PaceMeter meter;
  EXPECT_EQ(meter.take(kStart).real_time_factor(), 0.0);
  EXPECT_EQ(meter.take(kStart + seconds(9)).running, 0.0);
}

}  // namespace
}  // namespace vibratory_alignment
