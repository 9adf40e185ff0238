// Without friction, dampers and excitation (hard/conservative_ball, hard/conservative_part) the energy is constant,
// over ten thousand impacts. It is summed up here from the state and the depths, not taken from the ledger.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/energy.h"
#include "../support/hard_scene.h"
#include "../support/runs.h"

namespace vibratory_alignment {
namespace {

class Conservative : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(scene, Conservative, testing::Values("conservative_ball", "conservative_part"));

TEST_P(Conservative, energy_is_constant_over_1e4_impacts) {
  const Scene scene = test::hard_scene(GetParam());
  double first = NAN, drift = 0.0;
  const TrialResult result = test::run(scene, [&](const Segment& g) {
    const double e = test::energy(scene, g);
    if (std::isnan(first)) first = e;
    drift = std::max(drift, std::abs(e - first));
  });
  EXPECT_EQ(result.outcome, Outcome::time_limit);
  EXPECT_GE(test::total_impacts(result), 10000);
  EXPECT_LT(drift, 1e-11 * first);
  EXPECT_LT(result.energy->residual, 1e-11);
}

}  // namespace
}  // namespace vibratory_alignment
