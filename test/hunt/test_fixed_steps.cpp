// Random scenes by the solvers with a fixed step, which share no method with `event`: with all effects, in all
// combinations, they tend to its motion as their step shrinks.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "../support/fixed_step.h"
#include "mechanics/system.h"
#include "model/scene_error.h"
#include "random_scene.h"
#include "trace.h"

namespace vibratory_alignment::hunt {
namespace {

/// Scenes in which something is touched that each solver is asked for.
constexpr int kScenes = 10;

/// Places are compared up to this touch: each one makes differences ten times larger.
constexpr std::size_t kMostTouches = 4;

/// The first step, times the fastest rate, and how many there are at most; each of the next is a quarter of the last.
constexpr double kStep = 0.04, kSteps = 5e3;

/// Rate of what a step has to follow: the base, its damper, the tanh layer.
double fastest_rate(const System& system) {
  const double reach = system.half_width + system.base_distance;
  const double mobility =
      std::max(system.x.inverse_inertia, system.y.inverse_inertia) + reach * reach * system.phi.inverse_inertia;
  const double stiffness = std::max(system.stiffness_x, system.stiffness_y);
  const double damping = std::max(system.damping_x, system.damping_y);
  const double layer = system.regularization > 0.0 ? 10.0 / system.regularization : 0.0;
  return std::max({std::sqrt(stiffness * mobility), damping * mobility, layer});
}

/// How far apart the two are, at the instants that both have.
double difference_of_places(const System& system, const Trace& a, const Trace& b) {
  const double reach = system.half_width + system.base_distance;
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(a.places.size(), b.places.size()); ++i) {
    const State &p = a.places[i], &q = b.places[i];
    largest = std::max({largest, std::abs(p.x - q.x), std::abs(p.y - q.y), reach * std::abs(p.phi - q.phi)});
  }
  return largest / reach;
}

class FixedSteps : public testing::TestWithParam<std::string> {};

TEST_P(FixedSteps, tend_to_the_motion_of_event) {
  int compared = 0;
  for (std::uint64_t seed = 0; compared < kScenes; ++seed) {
    Scene scene = random_scene(seed, Range::ordinary);
    std::optional<System> system;
    try {
      system = make_system(scene);
    } catch (const SceneError&) {
      continue;  // no start
    }
    const double step = kStep / fastest_rate(*system);
    scene.trial.time_limit = std::min(scene.trial.time_limit, kSteps * step);
    Trace exact = run_trial(test::with_event_solver(scene, 1e-11), false);
    if (exact.touches.size() >= kMostTouches) {
      const double share = exact.touches[kMostTouches - 1].time / scene.trial.time_limit;
      exact.places.resize(std::min(exact.places.size(), static_cast<std::size_t>(share * (kInstants + 1))));
    }
    if (exact.touches.empty() || exact.places.empty()) continue;
    std::array<double, 3> errors{};
    std::size_t places = exact.places.size();
    for (std::size_t i = 0; i < errors.size(); ++i) {
      Scene by_steps = test::with_solver(scene, GetParam(), step * std::pow(0.25, static_cast<double>(i)));
      by_steps.solver.step_limit = 1'000'000;
      const Trace trace = run_trial(by_steps, false);
      EXPECT_NE(trace.result.outcome, Outcome::failed) << seed << ": " << trace.result.failure;
      places = std::min(places, trace.places.size());
      errors[i] = difference_of_places(*system, exact, trace);
    }
    EXPECT_EQ(places, exact.places.size()) << seed << ": instants at which they can be compared";
    // order one, but for where in a step a touch falls: sixteen times as many steps, a sixteenth on average
    EXPECT_LT(errors[2], 0.5 * std::max(errors[0], errors[1]) + 1e-12)
        << seed << ": " << errors[0] << " " << errors[1] << " " << errors[2];
    ++compared;
  }
}

INSTANTIATE_TEST_SUITE_P(hunt, FixedSteps, testing::ValuesIn(test::fixed_step_solvers()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace vibratory_alignment::hunt
