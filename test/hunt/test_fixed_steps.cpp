// Random scenes by the solvers with a fixed step, which share no method with `event`: with all effects, in all
// combinations, they tend to its motion as their step shrinks.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "../support/fixed_step.h"
#include "mechanics/system.h"
#include "model/scene_error.h"
#include "random_scene.h"
#include "trial/simulation.h"

namespace vibratory_alignment::hunt {
namespace {

/// Scenes in which something is touched that each solver is asked for.
constexpr int kScenes = 10;

/// Later touches are not compared: each can make a difference ten times larger.
constexpr int kMostTouches = 3;

/// The first step, times the fastest rate, and how many there are at most; each of the next is a quarter of the last.
constexpr double kStep = 0.04, kSteps = 5e3;

constexpr int kInstants = 20;

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

struct Places {
  std::vector<State> at_instants;  ///< until the first touch that is not compared
  int touches = 0;
};

/// Places at equal parts of `time`; `most_touches`: none after these.
Places places_of(Scene scene, double time, int most_touches = 1 << 20) {
  scene.solver.step_limit = 1'000'000;
  SimulationOptions options;
  options.energy = false;
  options.until = time;
  Simulation simulation(scene, options);
  Places places;
  while (simulation.advance() && places.touches <= most_touches) {
    const Segment& segment = simulation.segment();
    while (places.at_instants.size() < kInstants) {
      const double t = time * static_cast<double>(places.at_instants.size() + 1) / (kInstants + 1);
      if (t > segment.end_time()) break;
      places.at_instants.push_back(state_at(segment, std::clamp(t - segment.start.value(), 0.0, segment.duration)));
    }
    for (int i = 0; i < segment.event_count; ++i)
      if (segment.events[static_cast<std::size_t>(i)].kind == EventKind::touch) ++places.touches;
  }
  return places;
}

double difference(const System& system, const Places& a, const Places& b) {
  const double reach = system.half_width + system.base_distance;
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(a.at_instants.size(), b.at_instants.size()); ++i) {
    const State &p = a.at_instants[i], &q = b.at_instants[i];
    largest = std::max({largest, std::abs(p.x - q.x), std::abs(p.y - q.y), reach * std::abs(p.phi - q.phi)});
  }
  return largest / reach;
}

class FixedSteps : public testing::TestWithParam<std::string> {};

TEST_P(FixedSteps, tend_to_the_motion_of_event) {
  int compared = 0;
  for (std::uint64_t seed = 0; compared < kScenes; ++seed) {
    const Scene scene = random_scene(seed, Range::ordinary);
    std::optional<System> system;
    try {
      system = make_system(scene);
    } catch (const SceneError&) {
      continue;  // no start
    }
    const double step = kStep / fastest_rate(*system), time = std::min(scene.trial.time_limit, kSteps * step);
    const Places exact = places_of(test::with_event_solver(scene, 1e-11), time, kMostTouches);
    if (exact.touches == 0 || exact.at_instants.empty()) continue;
    std::array<double, 3> errors{};
    for (std::size_t i = 0; i < errors.size(); ++i)
      errors[i] = difference(
          *system, exact,
          places_of(test::with_solver(scene, GetParam(), step * std::pow(0.25, static_cast<double>(i))), time));
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
