// The same case gives the same motion: in SI units and dimensionless to roundoff, in any number of threads bit for bit.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "../support/random_scenes.h"
#include "../support/runs.h"
#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

using test::run;
using test::scene_of;

// M = 0.1 kg, K_Y = 4000 N/m, F1 = 8 N: lengths in 2 mm, times in 5 ms, moments in 16 mN m; one case in both units,
// every number scaled by hand (damping K_Y 5 ms = 20 N s/m, of phi 16e-3 5e-3 = 8e-5 N m s, inertia 0.1 (2e-3)^2 = 4e-7
// kg m^2).
const std::string dimensionless = R"(
part: {half_width: 0.7, base_distance: 0.9, inertia: 0.3}
slot: {clearance: 0.09, depth: 0.25}
gripper:
  stiffness: {x: 0.05, phi: 60.0}
  damping: {x: 0.05, y: 0.05, phi: 0.05}
  anchor: {x: 0.15, phi: 0.001}
  pressing_force: 0.2
base: {stiffness: {x: 2000.0, y: 2500.0}, damping: {x: 15.0, y: 20.0}}
contacts: [edges, corners, walls]
friction: {coefficient: 0.2}
weight: 0.125
excitation:
  - {amplitude: 1.0, frequency: 20.0, phase: 0.3}
  - {amplitude: 0.25, frequency: 7.0, direction: x, waveform: triangle}
  - {amplitude: 0.125, frequency: 11.0, direction: phi, waveform: square, phase: 1.0}
initial: {x: 0.2, y: 0.93, phi: 0.002, vx: -0.05, vy: 0.1, omega: 0.2}
trial: {time_limit: 2.5, aligned_depth: 0.02}
)";

const std::string si = R"(
units: si
part: {mass: 0.1, half_width: 1.4e-3, base_distance: 1.8e-3, inertia: 1.2e-7}
slot: {clearance: 1.8e-4, depth: 5.0e-4}
gripper:
  stiffness: {x: 200.0, y: 4000.0, phi: 0.96}
  damping: {x: 1.0, y: 1.0, phi: 4.0e-6}
  anchor: {x: 3.0e-4, phi: 0.001}
  pressing_force: 1.6
base: {stiffness: {x: 8.0e+6, y: 1.0e+7}, damping: {x: 300.0, y: 400.0}}
contacts: [edges, corners, walls]
friction: {coefficient: 0.2}
weight: 1.0
excitation:
  - {force: 8.0, frequency: 636.6197723675813, phase: 0.3}
  - {force: 2.0, frequency: 222.81692032865348, direction: x, waveform: triangle}
  - {moment: 2.0e-3, frequency: 350.14087480216975, direction: phi, waveform: square, phase: 1.0}
initial: {x: 4.0e-4, y: 1.86e-3, phi: 0.002, vx: -0.02, vy: 0.04, omega: 40.0}
trial: {time_limit: 12.5e-3, aligned_depth: 4.0e-5}
)";

// The scaled numbers differ in their last digits; some ten impacts make hundreds of that.
TEST(Units, si_and_dimensionless_give_the_same_motion) {
  for (const char* law : {"friction={coefficient: 0.2}", "friction=null"}) {
    Scene one = scene_of(dimensionless, {law}), other = scene_of(si, {law});
    one.solver.tolerance = other.solver.tolerance = 1e-13;
    const TrialResult a = run(one, {}, 2.5), b = run(other, {}, other.trial.time_limit);
    EXPECT_NEAR(a.final_time, b.final_time, 1e-14);
    EXPECT_LT(test::distance(a.final_state, b.final_state), 1e-12) << law;
    EXPECT_EQ(a.impacts, b.impacts);
    EXPECT_EQ(a.outcome, b.outcome);
    EXPECT_GT(test::total_impacts(a), 3);
  }
}

bool identical(const TrialResult& a, const TrialResult& b) {
  return test::distance(a.final_state, b.final_state) == 0.0 && a.final_time == b.final_time &&
         a.impacts == b.impacts && a.peak_force == b.peak_force && a.counts.steps == b.counts.steps &&
         a.counts.events == b.counts.events && a.energy->residual == b.energy->residual && a.outcome == b.outcome;
}

TEST(Determinism, the_same_scene_again_is_the_same_bit_for_bit) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Scene scene = test::random_scene(seed);
    EXPECT_TRUE(identical(run(scene), run(scene))) << "seed " << seed;
  }
}

// Four threads at once, the scenes in another order in each.
TEST(Determinism, threads_do_not_meet) {
  const unsigned count = 24;
  std::vector<TrialResult> alone;
  for (unsigned seed = 1; seed <= count; ++seed) alone.push_back(run(test::random_scene(seed)));
  std::atomic<int> different{0};
  std::vector<std::thread> threads;
  for (unsigned t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (unsigned i = 0; i < count; ++i) {
        const unsigned seed = (t % 2 == 0 ? i : count - 1 - i) + 1;
        if (!identical(run(test::random_scene(seed)), alone[seed - 1])) ++different;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(different, 0);
}

// Two trials advanced in turn, segment by segment, know nothing of each other.
TEST(Determinism, interleaved_trials_do_not_meet) {
  const Scene one = test::random_scene(3), other = test::random_scene(5);
  Simulation a(one), b(other);
  bool more = true;
  while (more) {
    more = a.advance();
    more = b.advance() || more;
  }
  EXPECT_TRUE(identical(a.result(), run(one)));
  EXPECT_TRUE(identical(b.result(), run(other)));
}

TEST(Determinism, a_moved_simulation_goes_on) {
  const Scene scene = test::random_scene(7);
  Simulation first(scene);
  for (int i = 0; i < 10; ++i) first.advance();
  Simulation second = std::move(first);
  while (second.advance()) {
  }
  EXPECT_TRUE(identical(second.result(), run(scene)));
}

}  // namespace
}  // namespace vibratory_alignment
