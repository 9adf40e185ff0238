// A block on a shaken table (hard/shaken_block): sticks exactly as long as the force along the table is within f N.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../support/hard_scene.h"
#include "../support/numbers.h"
#include "../support/runs.h"

namespace vibratory_alignment {
namespace {

using test::kPi;
using test::TimedEvent;

constexpr double kBlockFrequency = 3.0;
/// f N, with N = f0 less what the axial spring loses to the sag d: N = f0 - N/k.
constexpr double kLimit = 0.4 * 0.5 / (1.0 + 1e-4);

Scene shaken_block(double amplitude) {
  Scene scene = test::hard_scene("shaken_block");
  scene.excitations[0].amplitude = amplitude;
  return scene;
}

TEST(ShakenBlock, sticks_below_f_n) {
  for (const double share : {0.1, 0.9, 0.99, 1.0 - 1e-9}) {
    long events = 0;
    double fastest = 0.0;
    const TrialResult result = test::run(
        shaken_block(share * kLimit),
        [&](const Segment& g) {
          events += g.event_count;
          ASSERT_EQ(g.contacts[0].slip, Slip::stick);
          fastest = std::max(fastest, std::abs(g.end.vx));
          // V = 0 exactly, in every power
          for (int k = 0; k <= g.order; ++k) ASSERT_EQ(g.loaded[0].slip_velocity[static_cast<std::size_t>(k)], 0.0);
        },
        20.0);
    EXPECT_EQ(events, 0) << share;
    EXPECT_LT(fastest, 1e-14) << share;
    EXPECT_NEAR(result.final_state.x, 0.3, 1e-14) << share;
  }
}

TEST(ShakenBlock, slips_above_f_n) {
  for (const double share : {1.0 + 1e-9, 1.0 + 1e-6, 1.01, 1.1, 3.0}) {
    bool slipped = false;
    for (const TimedEvent& e : test::events_of(shaken_block(share * kLimit)))
      slipped = slipped || e.event.kind == EventKind::slip;
    EXPECT_TRUE(slipped) << share;
  }
}

// Stick breaks when A sin(nu tau) = f N, to the last digit of N = k d (d is one of a height of order 1).
TEST(ShakenBlock, slips_when_the_force_reaches_f_n) {
  for (const double share : {1.01, 1.1, 1.5, 4.0}) {
    const std::vector<TimedEvent> events = test::events_of(shaken_block(share * kLimit));
    ASSERT_FALSE(events.empty());
    EXPECT_EQ(events[0].event.kind, EventKind::slip);
    EXPECT_NEAR(events[0].time, std::asin(1.0 / share) / kBlockFrequency,
                3e-12 / std::sqrt(1.0 - 1.0 / (share * share)))
        << share;
  }
}

/// Way of the first slip, from x'' = A sin(nu tau) - f N: it begins at rest when the right side is 0, and ends at rest.
double way_of_one_slip(double amplitude) {
  const double s0 = std::asin(kLimit / amplitude);  // s = nu tau
  const auto speed = [&](double s) { return amplitude * (std::cos(s0) - std::cos(s)) - kLimit * (s - s0); };
  double low = kPi - s0, high = 2.0 * kPi;  // fastest, and turned back by then
  for (int i = 0; i < 100; ++i) (speed(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
  const double ds = low - s0;
  return (amplitude * (std::cos(s0) * ds - std::sin(low) + std::sin(s0)) - 0.5 * kLimit * ds * ds) /
         (kBlockFrequency * kBlockFrequency);
}

TEST(ShakenBlock, slips_as_far_as_the_force_beyond_f_n_drives_it) {
  for (const double share : {1.01, 1.1, 1.2}) {
    // until it is about to slip back, half a period later
    const double until = (std::asin(1.0 / share) + kPi) / kBlockFrequency - 1e-3;
    const TrialResult result = test::run(shaken_block(share * kLimit), {}, until);
    EXPECT_NEAR(result.final_state.x - 0.3, way_of_one_slip(share * kLimit), 1e-11) << share;
  }
}

// Two slips and two sticks a period, no chattering about V = 0.
TEST(ShakenBlock, slipping_and_sticking_alternate) {
  int slips = 0, sticks = 0;
  for (const TimedEvent& e : test::events_of(shaken_block(1.2 * kLimit), 10.0 * 2.0 * kPi / kBlockFrequency)) {
    slips += e.event.kind == EventKind::slip;
    sticks += e.event.kind == EventKind::stick;
  }
  EXPECT_EQ(slips, 20);
  EXPECT_NEAR(sticks, 20, 1);
}

}  // namespace
}  // namespace vibratory_alignment
