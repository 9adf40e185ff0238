// Linear impact (hard/linear_impact): the restitution of a damped spring that only pushes, in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../support/hard_scene.h"
#include "../support/restitution.h"
#include "../support/runs.h"

namespace vibratory_alignment {
namespace {

using test::linear_restitution;

/// Speed after over speed before the first impact.
double restitution(Scene scene) {
  scene.solver.tolerance = 1e-12;
  double before = 0.0;
  for (const test::TimedEvent& e : test::events_of(scene)) {
    if (e.event.kind == EventKind::touch) before = e.state.vy;
    // without damping force and depth end together, and the contact is over
    if (e.event.kind == EventKind::release) return -e.state.vy / before;
  }
  return NAN;
}

TEST(LinearImpact, restitution_has_the_published_values) {
  const double known[][2] = {{0.1, 0.74408}, {0.3, 0.45098}, {0.6, 0.24884}};
  for (const auto& [zeta, e] : known) {
    EXPECT_NEAR(linear_restitution(zeta), e, 5e-6);
    EXPECT_NEAR(restitution(test::hard_scene("linear_impact", {"base.damping.y=" + std::to_string(2e3 * zeta)})), e,
                1e-5);
  }
}

// The gripper's spring is at ease at the height of touch, so that its force in contact is d: it changes the stiffness k
// by 1, and so the restitution by O(1/k).
TEST(LinearImpact, restitution_is_that_of_a_linear_base) {
  for (const double zeta : {0.0, 0.05, 0.1, 0.3, 0.6, 0.9, 1.5, 5.0})
    for (const double k : {1e4, 1e6, 1e8}) {
      Scene scene = test::hard_scene("linear_impact");
      test::set_base(scene, k, zeta);
      EXPECT_NEAR(restitution(scene), linear_restitution(zeta), 3.0 / k + 1e-9) << zeta << " " << k;
    }
}

TEST(LinearImpact, restitution_does_not_depend_on_the_speed) {
  const double slow = restitution(test::hard_scene("linear_impact", {"initial.y=0.9001"}));
  const double fast = restitution(test::hard_scene("linear_impact", {"initial.y=3.0"}));
  EXPECT_NEAR(slow, fast, 1e-9);
}

}  // namespace
}  // namespace vibratory_alignment
