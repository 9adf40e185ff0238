// Long runs drift in nothing: a bounce with the period of its excitation is the same after ten thousand periods, in
// phase and in what it takes from the excitation.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../support/numbers.h"
#include "../support/scenes.h"
#include "trial/sampler.h"
#include "trial/simulation.h"

namespace vibratory_alignment {
namespace {

using test::kPi;

constexpr long kPeriods = 10000, kSettled = 1000;

struct Strobe {
  double time;
  State state;
  long impacts;
  EnergyLedger energy;
};

/// The motion once every `kSettled` periods.
std::vector<Strobe> strobes_of(const Scene& scene) {
  const double period = 2.0 * kPi / scene.excitations.front().frequency;
  SimulationOptions options;
  options.until = kPeriods * period;
  Simulation simulation(scene, options);
  Sampler sampler(simulation, kSettled * period);
  std::vector<Strobe> strobes;
  Sample sample;
  while (sampler.next(sample)) {
    const TrialResult result = simulation.result();
    strobes.push_back({sample.time, sample.state, sample.impacts[static_cast<std::size_t>(Spot::a1)], *result.energy});
  }
  return strobes;
}

TEST(LongRun, of_a_settled_bounce_drifts_in_nothing) {
  const Scene scene = load_scene_file(std::string(SCENE_DIR) + "/hard/long_run.yaml");
  const std::vector<Strobe> strobes = strobes_of(scene);
  ASSERT_GE(strobes.size(), 11u);
  const Strobe& settled = strobes[1];
  for (std::size_t i = 2; i <= 10; ++i) {
    const Strobe& now = strobes[i];
    // the instant itself is a double: it lies beside the whole period by its last digits, times the speed (below 1) and
    // the acceleration (below 2) of the flight; the rest is the 1e-8 of the solver's tolerance, which the impacts damp
    const double digits = 8.0 * 2.2e-16 * now.time + 1e-12;
    EXPECT_NEAR(now.state.y, settled.state.y, digits) << i;
    EXPECT_NEAR(now.state.vy, settled.state.vy, 2.0 * digits) << i;
    // one impact a period
    EXPECT_EQ(now.impacts - settled.impacts, static_cast<long>(i - 1) * kSettled);
    // the balance is as good as at the start, and what goes in goes out
    EXPECT_LT(now.energy.residual, 1e-11);
  }
  const auto work = [&](std::size_t from, std::size_t to) {
    return strobes[to].energy.excitation_work - strobes[from].energy.excitation_work;
  };
  EXPECT_GT(work(2, 6), 100.0);
  // booked by whole segments: each end is known to one impact's share
  EXPECT_NEAR(work(2, 6) / work(6, 10), 1.0, 1.0 / kSettled);
}

}  // namespace
}  // namespace vibratory_alignment
