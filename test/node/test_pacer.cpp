// The pace of simulated time against the wall clock.
#include <gtest/gtest.h>

#include "node/pacer.h"

namespace vibratory_alignment {
namespace {

using std::chrono::milliseconds;
const Pacer::Clock::time_point kStart{std::chrono::hours(5)};

/// Seconds from kStart to the instant.
double since_start(Pacer::Clock::time_point instant) { return std::chrono::duration<double>(instant - kStart).count(); }

TEST(Pacer, SimulatedTimeAdvancesWithTheTimeScale) {
  Pacer pacer;
  pacer.start(0.01, kStart, 2.0);
  EXPECT_EQ(pacer.due(2.0), kStart);
  EXPECT_NEAR(since_start(pacer.due(2.005)), 0.5, 1e-6);
  EXPECT_DOUBLE_EQ(pacer.simulated(kStart + milliseconds(500)), 2.005);
}

TEST(Pacer, ZeroMeansAtOnce) {
  Pacer pacer;
  pacer.start(0.0, kStart, 0.0);
  EXPECT_EQ(pacer.due(1e9), kStart);
  EXPECT_EQ(pacer.simulated(kStart + milliseconds(500)), 0.0);
}

TEST(Pacer, ChangesWithoutAJump) {
  Pacer pacer;
  pacer.start(0.01, kStart, 0.0);
  const auto change = kStart + milliseconds(300);
  pacer.start(1.0, change, pacer.simulated(change));
  EXPECT_DOUBLE_EQ(pacer.simulated(change), 0.003);
  EXPECT_NEAR(since_start(pacer.due(0.103)), 0.4, 1e-6);
}

TEST(Pacer, AnAbsurdlySlowPaceDoesNotOverflow) {
  Pacer pacer;
  pacer.start(1e-300, kStart, 0.0);
  EXPECT_GT(pacer.due(1e300), kStart + std::chrono::hours(24 * 365));
}

}  // namespace
}  // namespace vibratory_alignment
