#include "study/accuracy.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "model/solver_names.h"
#include "trial/make_solver.h"
#include "trial/simulation.h"

namespace vibratory_alignment {
namespace {

constexpr double kReferenceTolerance = 1e-13, kSecondTolerance = 1e-11;

/// Settings of the study: decades of the tolerance, quarters of the step.
constexpr double kCoarsestTolerance = 1e-1, kFinestTolerance = 1e-12;
constexpr int kSteps = 7;

constexpr int kMostRepetitions = 50;
constexpr double kTwoPi = 6.28318530717958647692;

TrialResult run(const Scene& scene, const SimulationOptions& options) {
  Simulation simulation(scene, options);
  while (simulation.advance()) {
  }
  return simulation.result();
}

Scene with_solver(Scene scene, const std::string& name, double setting, bool fixed_step) {
  scene.solver.name = name;
  scene.solver.accuracy.reset();
  if (fixed_step)
    scene.solver.step = setting;
  else
    scene.solver.step.reset();
  if (!fixed_step) scene.solver.tolerance = setting;
  return scene;
}

double pose_difference(const State& a, const State& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.phi - b.phi)});
}

/// Coarse to fine.
std::vector<double> settings_of(const Scene& scene, bool fixed_step, double step_share) {
  std::vector<double> settings;
  if (fixed_step) {
    double step = step_share * kTwoPi / std::max(1.0, scene.fastest_excitation());
    for (int i = 0; i < kSteps; ++i, step /= 4.0) settings.push_back(step);
  } else {
    for (double t = kCoarsestTolerance; t > 0.9 * kFinestTolerance; t /= 10.0) settings.push_back(t);
  }
  return settings;
}

AccuracyRun measure(const Scene& scene, const AccuracyReference& reference, double seconds) {
  SimulationOptions options;
  options.until = reference.end_time;
  AccuracyRun result;
  // the ledger is kept once, and costs nothing in the runs that are timed
  const TrialResult checked = run(scene, options);
  result.failure = checked.failure;
  if (checked.outcome == Outcome::failed) return result;
  result.pose_error = pose_difference(checked.final_state, reference.end);
  double largest = 0.0;
  for (std::size_t i = 0; i < kSpotCount; ++i) {
    largest = std::max(largest, reference.peak_force[i]);
    result.force_error = std::max(result.force_error, std::abs(checked.peak_force[i] - reference.peak_force[i]));
  }
  if (largest > 0.0) result.force_error /= largest;
  if (reference.aligned_time) {
    // a trial that ends where the reference aligned may be about to
    const std::optional<double> aligned = checked.aligned_time ? checked.aligned_time : run(scene, {}).aligned_time;
    if (aligned) result.duration_error = std::abs(*aligned - *reference.aligned_time);
  }
  if (checked.energy) result.energy_residual = checked.energy->residual;
  result.counts = checked.counts;

  options.energy = false;
  std::vector<double> times;
  double spent = 0.0;
  while (times.empty() || (spent < seconds && times.size() < kMostRepetitions)) {
    times.push_back(run(scene, options).cpu_seconds);
    spent += times.back();
  }
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  result.cpu_seconds = *middle;
  result.repetitions = static_cast<int>(times.size());
  return result;
}

}  // namespace

AccuracyReference accuracy_reference(const Scene& scene) {
  AccuracyReference reference;
  reference.method = "event";
  reference.second_method = kImplicitAlone;
  const TrialResult first = run(with_solver(scene, reference.method, kReferenceTolerance, false), {});
  if (first.outcome == Outcome::failed) throw std::runtime_error("the reference run failed: " + first.failure);
  reference.end_time = first.final_time;
  reference.end = first.final_state;
  reference.peak_force = first.peak_force;
  reference.aligned_time = first.aligned_time;
  SimulationOptions options;
  options.until = reference.end_time;
  const TrialResult second = run(with_solver(scene, reference.second_method, kSecondTolerance, false), options);
  if (second.outcome == Outcome::failed)
    throw std::runtime_error("the check of the reference failed: " + second.failure);
  reference.agreement = pose_difference(second.final_state, reference.end);
  return reference;
}

std::vector<AccuracyRun> run_accuracy_study(const Scene& scene, const AccuracyReference& reference,
                                            const AccuracyOptions& options,
                                            const std::function<bool(const AccuracyRun&)>& progress) {
  std::vector<AccuracyRun> runs;
  for (const SolverName& solver : solver_names) {
    const std::vector<std::string>& wanted = options.solvers;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), solver.name) == wanted.end()) continue;
    for (const double setting : settings_of(scene, solver.fixed_step, options.step_share)) {
      AccuracyRun result;
      try {
        result =
            measure(with_solver(scene, solver.name, setting, solver.fixed_step), reference, options.seconds_per_run);
      } catch (const std::invalid_argument&) {
        // asked for by name it must be there; in a study of all it is left out
        if (!wanted.empty()) throw;
        break;
      }
      result.solver = solver.name;
      result.setting = setting;
      result.fixed_step = solver.fixed_step;
      runs.push_back(result);
      if (!progress(result)) return runs;
      if (result.cpu_seconds > options.longest_run) break;
    }
  }
  return runs;
}

const AccuracyRun* cheapest_for(const std::vector<AccuracyRun>& runs, double error) {
  const AccuracyRun* best = nullptr;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    // kept by this and by all finer runs of the same solver, which follow it
    bool kept = true;
    for (std::size_t j = i; j < runs.size() && runs[j].solver == runs[i].solver; ++j)
      kept = kept && runs[j].failure.empty() && runs[j].pose_error <= error;
    if (kept && (best == nullptr || runs[i].cpu_seconds < best->cpu_seconds)) best = &runs[i];
  }
  return best;
}

}  // namespace vibratory_alignment
