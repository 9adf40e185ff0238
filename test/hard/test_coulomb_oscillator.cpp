// Coulomb oscillator (hard/coulomb_oscillator): 2 f N/k_x of amplitude lost in every half cycle of pi/sqrt(k_x), until
// the spring can no longer move it.
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

constexpr double kMiddle = 0.3, kStiffness = 0.7;
constexpr double kLimit = 0.013 * 0.5 / (1.0 + 1e-4);  // f N, N less the sag of the base

TEST(CoulombOscillator, loses_four_f_n_over_k_a_cycle) {
  const double lost = 2.0 * kLimit / kStiffness;
  for (const double start : {0.2, 0.11, -0.15}) {
    Scene scene = test::hard_scene("coulomb_oscillator");
    scene.initial.x = kMiddle + start;
    const int half_cycles = static_cast<int>(std::ceil((std::abs(start) - kLimit / kStiffness) / lost));
    std::vector<TimedEvent> turns;
    for (const TimedEvent& e : test::events_of(scene))
      if (e.event.kind == EventKind::stick || e.event.kind == EventKind::slip_reversal) turns.push_back(e);
    ASSERT_EQ(static_cast<int>(turns.size()), half_cycles) << start;
    for (int n = 1; n <= half_cycles; ++n) {
      const TimedEvent& turn = turns[static_cast<std::size_t>(n - 1)];
      const double amplitude = (std::abs(start) - n * lost) * (n % 2 == 0 ? 1.0 : -1.0) * (start > 0.0 ? 1.0 : -1.0);
      EXPECT_NEAR(turn.state.x - kMiddle, amplitude, 1e-11) << n;
      EXPECT_NEAR(turn.time, n * kPi / std::sqrt(kStiffness), 1e-10) << n;
      EXPECT_EQ(turn.event.kind, n == half_cycles ? EventKind::stick : EventKind::slip_reversal);
    }
    // and it stays where it stopped
    EXPECT_NEAR(test::run(scene).final_state.x, turns.back().state.x, 1e-13);
  }
}

TEST(CoulombOscillator, loses_its_energy_to_friction) {
  const TrialResult result = test::run(test::hard_scene("coulomb_oscillator"));
  const double rest = result.final_state.x - kMiddle;
  EXPECT_NEAR(result.energy->friction_loss, 0.5 * kStiffness * (0.2 * 0.2 - rest * rest), 1e-10);
}

}  // namespace
}  // namespace vibratory_alignment
