// Every solver: what holds for any motion, on random scenes of all kinds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "../support/mirror.h"
#include "../support/random_scenes.h"
#include "../support/runs.h"
#include "../support/solver_battery.h"
#include "trial/sampler.h"

namespace vibratory_alignment {
namespace {

using test::distance;
using test::mirrored;
using test::run;

class BatteryInvariants : public test::SolverBattery {
 protected:
  Scene random(unsigned seed) const {
    Scene scene = with(test::random_scene(seed), setting());
    scene.trial.time_limit = 1.0;
    return scene;
  }
  double setting() const { return fixed_step() ? 5e-4 : 1e-8; }

  /// By how much a force leaves N >= 0, |T| <= f N, beside the largest N of the run.
  static double out_of_cone(const Scene& scene) {
    const double f = scene.friction ? scene.friction->coefficient : 0.0;
    double largest = 0.0, most = 0.0;
    run(scene, [&](const Segment& g) {
      for (int i = 0; i < g.loaded_count; ++i)
        for (const double share : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
          const ContactValues contact = contact_at(g, i, share * g.duration);
          const double n = contact.normal_force;
          largest = std::max(largest, n);
          most = std::max({most, -n, std::abs(contact.tangential_force) - f * n});
        }
    });
    return largest > 0.0 ? most / largest : 0.0;
  }

  static void expect_same(const TrialResult& one, const TrialResult& other, unsigned seed) {
    EXPECT_EQ(distance(one.final_state, other.final_state), 0.0) << "seed " << seed;
    EXPECT_EQ(one.final_time, other.final_time) << "seed " << seed;
    EXPECT_EQ(one.peak_force, other.peak_force) << "seed " << seed;
    EXPECT_EQ(one.impacts, other.impacts) << "seed " << seed;
    EXPECT_EQ(one.counts.steps, other.counts.steps) << "seed " << seed;
    ASSERT_TRUE(one.energy && other.energy);
    EXPECT_EQ(one.energy->residual, other.energy->residual) << "seed " << seed;
  }
};
INSTANTIATE_TEST_SUITE_P(solver, BatteryInvariants, testing::ValuesIn(test::stated_solvers()), test::solver_test_name);

// N >= 0 and |T| <= f N everywhere in a step, to the last digits or to a tolerance of the largest N. ode has as its
// limit the N without friction: what that is beside N falls with the step.
TEST_P(BatteryInvariants, forces_stay_in_the_friction_cone) {
  const bool set_apart = std::string(GetParam().name) == "ode";
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const double outside = out_of_cone(random(seed));
    if (set_apart && outside > 1e-9) {
      Scene finer = random(seed);
      *finer.solver.step /= 16.0;
      EXPECT_LT(out_of_cone(finer), 0.3 * outside) << "seed " << seed;
    } else {
      EXPECT_LT(outside, fixed_step() ? 1e-12 : setting()) << "seed " << seed;
    }
  }
}

// The ledger misses what the steps miss: nothing but rounding for those under error control, else it falls with the
// step, up to where in a step the events happen to fall.
TEST_P(BatteryInvariants, energy_is_accounted_for) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Scene scene = random(seed);
    const TrialResult result = run(scene);
    ASSERT_TRUE(result.energy);
    if (!fixed_step()) {
      EXPECT_LT(result.energy->residual, 10.0 * setting()) << "seed " << seed;
      continue;
    }
    if (result.energy->residual < 1e-3) continue;
    scene = with(scene, setting() / 16.0);
    EXPECT_LT(run(scene).energy->residual, 0.5 * result.energy->residual) << "seed " << seed;
  }
}

TEST_P(BatteryInvariants, the_same_run_again_is_the_same_to_the_bit) {
  for (unsigned seed = 1; seed <= 20; ++seed) expect_same(run(random(seed)), run(random(seed)), seed);
}

// Another trial before or in between leaves no trace.
TEST_P(BatteryInvariants, trials_do_not_meet) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const TrialResult alone = run(random(seed));
    Simulation one(random(seed)), other(random(seed + 100));
    bool one_runs = true, other_runs = true;
    while (one_runs || other_runs) {
      one_runs = one_runs && one.advance();
      other_runs = other_runs && other.advance();
    }
    expect_same(alone, one.result(), seed);
    // used up and made anew in its place
    one = Simulation(random(seed));
    while (one.advance()) {
    }
    expect_same(alone, one.result(), seed);
  }
}

TEST_P(BatteryInvariants, the_rate_of_output_changes_nothing) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const TrialResult plain = run(random(seed));
    for (const double interval : {1.3e-3, 0.37}) {
      Simulation simulation(random(seed));
      Sampler sampler(simulation, interval, true);
      Sample sample;
      while (sampler.next(sample)) {
      }
      expect_same(plain, simulation.result(), seed);
    }
  }
}

// Left and right exchanged. What rounding differs in is amplified by impacts, in few scenes by much: as much as a start
// moved by the last digits.
TEST_P(BatteryInvariants, mirrored_scenes_give_mirrored_motions) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Scene scene = random(seed);
    Scene moved = scene;
    moved.initial.vx += 1e-14;
    if (moved.initial.y) *moved.initial.y += 1e-14;
    const TrialResult right = run(scene), left = run(mirrored(scene));
    const double growth = distance(run(moved).final_state, right.final_state) / 1e-14;
    const double allowed = 1e-12 + 1e-13 * growth;
    EXPECT_LT(distance(right.final_state, mirrored(left.final_state)), allowed) << "seed " << seed;
    EXPECT_EQ(right.impacts[0], left.impacts[1]) << "seed " << seed;
    EXPECT_EQ(right.impacts[2], left.impacts[3]) << "seed " << seed;
  }
}

}  // namespace
}  // namespace vibratory_alignment
