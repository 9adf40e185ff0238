// Runs of whole trials for the tests of solver and trial.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "trial/simulation.h"

namespace vibratory_alignment::test {

/// Runs to the end and hands every segment to `look`.
inline TrialResult run(const Scene& scene, const std::function<void(const Segment&)>& look = {},
                       std::optional<double> until = {}) {
  SimulationOptions options;
  options.until = until;
  Simulation simulation(scene, options);
  while (simulation.advance())
    if (look) look(simulation.segment());
  return simulation.result();
}

/// Runs with another solver and tolerance.
inline TrialResult run_with(Scene scene, const std::string& solver, double tolerance,
                            std::optional<double> until = {}) {
  scene.solver.accuracy.reset();
  scene.solver.name = solver;
  scene.solver.tolerance = tolerance;
  return run(scene, {}, until);
}

/// ... to the time limit, whatever the outcome.
inline TrialResult run_to_limit_with(const Scene& scene, const std::string& solver, double tolerance) {
  return run_with(scene, solver, tolerance, scene.trial.time_limit);
}

struct TimedEvent {
  double time;
  Event event;
  State state;
};

/// All events of a run, in order.
inline std::vector<TimedEvent> events_of(const Scene& scene, std::optional<double> until = {}) {
  std::vector<TimedEvent> events;
  run(
      scene,
      [&](const Segment& g) {
        for (int i = 0; i < g.event_count; ++i)
          events.push_back({g.end_time(), g.events[static_cast<std::size_t>(i)], g.end});
      },
      until);
  return events;
}

inline double distance(const State& a, const State& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.phi - b.phi), std::abs(a.vx - b.vx),
                   std::abs(a.vy - b.vy), std::abs(a.omega - b.omega)});
}

inline long total_impacts(const TrialResult& result) {
  long total = 0;
  for (const long impacts : result.impacts) total += impacts;
  return total;
}

}  // namespace vibratory_alignment::test
