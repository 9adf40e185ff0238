// Implicit steps in the tanh layer up to the release, where N, and with it the stiffness of the layer, goes to zero.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/scenes.h"
#include "solver/motion_series.h"
#include "trial/simulation.h"

namespace vibratory_alignment {
namespace {

/// A light part that the spring of the base throws off, whose corner creeps in a thin layer.
constexpr char kThrown[] = R"(
part: {half_width: 0.26, base_distance: 2.5, inertia: 0.05}
slot: {clearance: 0.3}
gripper: {stiffness: {phi: 80}, damping: {x: 0, y: 0, phi: 0}, anchor: {x: 0, phi: 0}, pressing_force: 1}
base: {stiffness: {x: 1, y: 2.0e6}}
contacts: [corners]
friction: {coefficient: 1, regularization: 2.0e-6}
excitation: {amplitude: 0, frequency: 1}
initial: {x: -0.5, y: 2.5, phi: -0.14}
trial: {time_limit: 0.0012}
solver: {name: implicit, tolerance: 1.0e-8}
)";

/// The same on a base so stiff that only what the step before knows of the layer leads to a solution of the next one.
constexpr char kThrownFast[] = R"(
part: {half_width: 0.2, base_distance: 2, inertia: 0.02}
slot: {clearance: 1}
gripper: {stiffness: {x: 0}, damping: {x: 0, y: 0, phi: 0}, anchor: {x: 0, phi: 0}, pressing_force: 1}
base: {stiffness: {x: 1, y: 1.0e9}}
contacts: [corners]
friction: {coefficient: 1, regularization: 1.0e-5}
excitation: {amplitude: 0, frequency: 1}
initial: {x: 0, y: -1.6, phi: 2.572}
trial: {time_limit: 5.0e-5}
solver: {name: auto, tolerance: 1.0e-8}
)";

// A step up to the release sees at its start nothing of the slip in which it ends, and is not good enough; of the half
// of it the equations have to be solved from what came before, not from the solution that is not good enough.
TEST(LayerRelease, friction_stays_within_its_limit_up_to_the_release) {
  for (const char* text : {kThrown, kThrownFast}) {
    const Scene scene = test::scene_of(text);
    Simulation simulation(scene);
    double most_friction = 0.0;
    int releases = 0;
    while (simulation.advance()) {
      const Segment& g = simulation.segment();
      for (int i = 0; i < g.loaded_count; ++i) {
        for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
          const double t = share * g.duration;
          const double limit = scene.friction->coefficient * contact_at(g, i, t).normal_force;
          most_friction = std::max(most_friction, limit);
          EXPECT_LE(std::abs(contact_at(g, i, t).tangential_force), limit + 1e-7 * most_friction)
              << g.start.value() << " + " << t;
        }
      }
      for (int i = 0; i < g.event_count; ++i)
        releases += g.events[static_cast<std::size_t>(i)].kind == EventKind::release;
    }
    EXPECT_EQ(simulation.result().outcome, Outcome::time_limit) << simulation.result().failure;
    EXPECT_EQ(releases, 1);
  }
}

}  // namespace
}  // namespace vibratory_alignment
