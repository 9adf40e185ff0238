// Without friction, dampers and excitation the energy is constant, here with edges and corners, over 1e4 impacts of a
// ball and of a part on one edge in test/hard. It is summed up from the state and the depths, not taken from the
// ledger.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../support/energy.h"
#include "../support/runs.h"
#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

using test::energy;

/// Largest relative change of the energy over `impacts` impacts; their kinetic energy is of the size of the first one.
void expect_constant(Scene scene, long impacts) {
  scene.solver.tolerance = 1e-13;
  scene.trial.time_limit = 1e9;
  Simulation simulation(scene);
  double first = NAN, drift = 0.0;
  long seen = 0;
  while (seen < impacts && simulation.advance()) {
    const Segment& g = simulation.segment();
    const double e = energy(scene, g);
    if (std::isnan(first)) first = e;
    drift = std::max(drift, std::abs(e - first));
    for (int i = 0; i < g.event_count; ++i) seen += g.events[static_cast<std::size_t>(i)].kind == EventKind::touch;
  }
  EXPECT_GE(seen, impacts);
  EXPECT_LT(drift, 1e-11 * first);
  EXPECT_LT(simulation.result().energy->residual, 1e-11);
}

TEST(EnergyConservation, with_edges_and_corners) {
  expect_constant(
      test::scene_of(test::plain,
                     {"friction=null", "base={stiffness: {y: 4100}}", "contacts=[edges, corners]",
                      "gripper={stiffness: {x: 9, phi: 60}, anchor: {x: 0.5, y: 0.8}}", "excitation.amplitude=0",
                      "initial.x=0.5", "initial.y=0.96", "initial.phi=-0.004", "trial.aligned_depth=5"}),
      3000);
}

// ... and with friction and dampers it can only fall.
TEST(EnergyConservation, energy_only_falls_without_excitation) {
  for (const char* law : {"friction={coefficient: 0.3}", "friction={coefficient: 0.3, regularization: 1.0e-3}"}) {
    // on an isotropic base, whose springs belong to the energy; what a release drops is gone as well
    const Scene scene = test::scene_of(
        test::plain,
        {law, "base={stiffness: {y: 4100}, damping: {y: 17}}", "contacts=[edges, corners]",
         "gripper={stiffness: {x: 0.9, phi: 25}, damping: {x: 0.01, y: 0.01, phi: 0.1}, anchor: {x: 0.3, y: 0.7}}",
         "excitation.amplitude=0", "initial={x: 0.28, y: 1.0, phi: -0.05, vx: 0.5}"});
    double before = INFINITY;
    test::run(
        scene,
        [&](const Segment& g) {
          const double now = energy(scene, g);
          ASSERT_LE(now, before + 1e-12);
          // a release with d > 0 drops the base's energy, a reload brings what is left back
          double loaded = 0.0;
          for (int i = 0; i < g.event_count; ++i)
            loaded += g.events[static_cast<std::size_t>(i)].kind == EventKind::reload;
          before = loaded > 0.0 ? INFINITY : now;
        },
        3.0);
  }
}

}  // namespace
}  // namespace vibratory_alignment
