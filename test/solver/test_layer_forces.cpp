// Friction in the tanh layer is T = -f N tanh(V/eps) to the tolerance at every instant, also where it hardly moves the
// part: there the motion's own series say nothing about how far that of T holds. Found at random.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/runs.h"
#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

/// A corner that slides along a wall and leaves it again and again. N turns the light part away at once; T, whose lever
/// is a thousandth of N's, has its mass to move.
const std::string corner_on_the_wall = R"(
part: {half_width: 0.0004, base_distance: 0.354, inertia: 9e-08}
slot: {clearance: 4e-05}
gripper: {stiffness: {}, damping: {x: 0, y: 0, phi: 0}, anchor: {x: 0, y: 1, phi: 0}}
base: {stiffness: {x: 1, y: 1}, damping: {x: 0, y: 0}}
contacts: [walls]
friction: {coefficient: 0.4, regularization: 0.009}
excitation: {amplitude: 0, frequency: 1}
initial: {x: 0.0007, y: 0.35, phi: -0.01}
trial: {time_limit: 0.04, aligned_depth: 0.007}
solver: {name: event, tolerance: 1e-08}
)";

double magnitude(const Series& series, int order, double t) {
  double sum = 0.0;
  for (int k = order; k >= 0; --k) sum = sum * t + std::abs(series[static_cast<std::size_t>(k)]);
  return sum;
}

TEST(LayerForces, follow_their_law_to_the_tolerance_throughout_a_step) {
  for (const double tolerance : {1e-3, 1e-5, 1e-8, 1e-11}) {
    Scene scene = test::scene_of(corner_on_the_wall);
    scene.solver.tolerance = tolerance;
    const double f = scene.friction->coefficient, eps = *scene.friction->regularization;
    int seen = 0, released = 0;
    test::run(scene, [&](const Segment& g) {
      for (int i = 0; i < g.loaded_count; ++i) {
        const ContactSeries& contact = g.loaded[static_cast<std::size_t>(i)];
        if (slip_of(g, contact) != Slip::regularized || g.layer_crossing != nullptr) continue;
        ++seen;
        for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
          const double t = share * g.duration;
          const double n = value_at(contact.normal_force, g.order, t), v = value_at(contact.slip_velocity, g.order, t);
          // the last digits of the series of V, of terms that are each as large as the speed of the point
          const double rounding = f * std::abs(n) / eps * 1e-14 * magnitude(contact.slip_velocity, g.order, t);
          EXPECT_NEAR(value_at(contact.tangential_force, g.order, t), -f * n * std::tanh(v / eps),
                      tolerance * f * magnitude(contact.normal_force, g.order, t) + rounding)
              << g.start.value() << " + " << t;
        }
      }
      for (int i = 0; i < g.event_count; ++i)
        if (g.events[static_cast<std::size_t>(i)].kind == EventKind::release) ++released;
    });
    EXPECT_GT(seen, 20) << tolerance;
    EXPECT_GT(released, 2) << tolerance;
  }
}

// The step is chosen for T to hold to a hundredth of the tolerance at its end; at the loosest tolerances, where the
// poles of the layer bound the steps anyway, to a tenth (docs/hybrid_step.md "Step").
TEST(LayerForces, follow_their_law_to_a_hundredth_of_the_tolerance_at_the_end_of_a_step) {
  for (const double tolerance : {1e-1, 1e-3, 1e-5, 1e-8}) {
    Scene scene = test::scene_of(test::plain, {"friction.regularization=0.002"});
    scene.solver.tolerance = tolerance;
    const double f = scene.friction->coefficient, eps = *scene.friction->regularization;
    const double share = tolerance > 1e-3 ? 0.1 : 0.01;
    double worst = 0.0;
    test::run(scene, [&](const Segment& g) {
      for (int i = 0; i < g.loaded_count; ++i) {
        const ContactSeries& contact = g.loaded[static_cast<std::size_t>(i)];
        if (slip_of(g, contact) != Slip::regularized || g.layer_crossing != nullptr) continue;
        const double t = g.duration;
        const double law = -f * value_at(contact.normal_force, g.order, t) *
                           std::tanh(value_at(contact.slip_velocity, g.order, t) / eps);
        worst = std::max(worst, std::abs(value_at(contact.tangential_force, g.order, t) - law) /
                                    (f * magnitude(contact.normal_force, g.order, t)));
      }
    });
    // what lies beyond the last two terms adds some two times as much
    EXPECT_LT(worst, 4.0 * share * tolerance) << tolerance;
    EXPECT_GT(worst, 0.01 * share * tolerance) << tolerance;
  }
}

// Beyond |V|/eps = 1/2 ln(2/tolerance of a step), the thousandth of that asked for, the law counts as sliding: a
// contact in the layer is not there any more, one that slides not there yet.
TEST(LayerForces, follow_the_law_of_the_layer_up_to_its_edge_and_no_farther) {
  for (const double tolerance : {1e-4, 1e-8}) {
    Scene scene = test::scene_of(test::plain, {"friction.regularization=0.002"});
    scene.solver.tolerance = tolerance;
    const double rounding = std::max(1e-9, 1e-3 * tolerance);  // or truncation error of a step, which ends at the edge
    const double edge = 0.5 * std::log(2.0 / (1e-3 * tolerance)) * *scene.friction->regularization;
    int within = 0, beyond = 0, crossings = 0;
    test::run(scene, [&](const Segment& g) {
      for (int i = 0; i < g.loaded_count; ++i) {
        const ContactSeries& contact = g.loaded[static_cast<std::size_t>(i)];
        const bool in_layer = slip_of(g, contact) == Slip::regularized;
        ++(in_layer ? within : beyond);
        for (const double share : {0.0, 0.5, 1.0}) {
          const double v = std::abs(contact_at(g, i, share * g.duration).slip_velocity);
          EXPECT_TRUE(in_layer ? v <= edge * (1.0 + rounding) : v >= edge * (1.0 - rounding))
              << g.start.value() << ": " << v;
        }
      }
      for (int i = 0; i < g.event_count; ++i)
        if (g.events[static_cast<std::size_t>(i)].kind == EventKind::slip_reversal ||
            g.events[static_cast<std::size_t>(i)].kind == EventKind::slip)
          ++crossings;
    });
    EXPECT_GT(within, 20) << tolerance;
    EXPECT_GT(beyond, 20) << tolerance;
    EXPECT_GT(crossings, 5) << tolerance;
  }
}

}  // namespace
}  // namespace vibratory_alignment
