#include "study/accuracy.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <stdexcept>

#include "model/solver_names.h"
#include "trial/make_solver.h"
#include "trial/simulation.h"

namespace vibratory_alignment {
namespace {

constexpr double kReferenceTolerance = 1e-13, kSecondTolerance = 1e-11;

/// Settings of the study: decades of the tolerance, quarters of the step.
constexpr double kTolerances[] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12};
constexpr int kSteps = 7;

/// In periods of the fastest excitation, or of 1 rad per unit of time where that is faster.
constexpr double kCoarsestStep = 1e-2;

/// Repetitions of a run that is timed, in all and one after the other before the other runs have their turn: the
/// clock of a computer changes within seconds, and so meets all runs alike.
constexpr std::size_t kMostRepetitions = 50, kRepetitionsPerTurn = 5;

/// Steps of a reference by `event` before `implicit` is asked whether it needs as many.
constexpr long kManySteps = 200'000;

/// Where a trial that ends with a touch is compared, as a share of its time.
constexpr double kBeforeTouch = 0.99;

constexpr double kTwoPi = 6.28318530717958647692;

/// The study is not to go on.
struct Stopped {};

struct Run {
  TrialResult result;
  bool ends_with_touch = false;
};

Run run(const Scene& scene, const SimulationOptions& options, const GoOn& go_on) {
  Simulation simulation(scene, options);
  while (simulation.advance())
    if (!go_on()) throw Stopped();
  Run run;
  run.result = simulation.result();
  if (run.result.outcome == Outcome::failed || run.result.outcome == Outcome::time_limit) return run;
  const Segment& last = simulation.segment();
  for (int i = 0; i < last.event_count; ++i)
    if (last.events[static_cast<std::size_t>(i)].kind == EventKind::touch) run.ends_with_touch = true;
  return run;
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
std::vector<double> settings_of(const Scene& scene, bool fixed_step) {
  std::vector<double> settings;
  if (fixed_step) {
    double step = kCoarsestStep * kTwoPi / std::max(1.0, scene.fastest_excitation());
    for (int i = 0; i < kSteps; ++i, step /= 4.0) settings.push_back(step);
  } else {
    settings.assign(std::begin(kTolerances), std::end(kTolerances));
  }
  return settings;
}

/// What a run comes to, but for its time.
void compare(const Scene& scene, const AccuracyReference& reference, const GoOn& go_on, AccuracyRun& result) {
  SimulationOptions options;
  options.until = reference.end_time;
  const TrialResult checked = run(scene, options, go_on).result;
  result.cpu_seconds = checked.cpu_seconds;
  result.failure = checked.failure;
  if (checked.outcome == Outcome::failed) return;
  result.pose_error = pose_difference(checked.final_state, reference.end);
  double largest = 0.0;
  for (std::size_t i = 0; i < kSpotCount; ++i) {
    largest = std::max(largest, reference.peak_force[i]);
    result.force_error = std::max(result.force_error, std::abs(checked.peak_force[i] - reference.peak_force[i]));
  }
  if (largest > 0.0) result.force_error /= largest;
  if (reference.aligned_time) {
    // a trial that ends where the reference aligned may be about to
    const std::optional<double> aligned =
        checked.aligned_time ? checked.aligned_time : run(scene, {}, go_on).result.aligned_time;
    if (aligned) result.duration_error = std::abs(*aligned - *reference.aligned_time);
  }
  if (checked.energy) result.energy_residual = checked.energy->residual;
  result.counts = checked.counts;
}

/// Times all runs that have an answer, in turns. The ledger has been kept by compare(), and costs nothing here.
class Stopwatch {
 public:
  Stopwatch(const AccuracyReference& reference, double seconds_per_run) : seconds_(seconds_per_run) {
    options_.until = reference.end_time;
    options_.energy = false;
  }

  void add(const Scene& scene, std::size_t index) { entries_.push_back({scene, index, {}, 0.0}); }

  void time(const GoOn& go_on, std::vector<AccuracyRun>& runs) {
    bool timed = true;
    while (timed) {
      timed = false;
      for (Entry& entry : entries_)
        for (std::size_t i = 0; i < kRepetitionsPerTurn && wants_more(entry); ++i, timed = true) {
          entry.times.push_back(run(entry.scene, options_, go_on).result.cpu_seconds);
          entry.spent += entry.times.back();
        }
    }
    for (Entry& entry : entries_) {
      const auto middle = entry.times.begin() + static_cast<std::ptrdiff_t>(entry.times.size() / 2);
      std::nth_element(entry.times.begin(), middle, entry.times.end());
      runs[entry.index].cpu_seconds = *middle;
      runs[entry.index].repetitions = static_cast<int>(entry.times.size());
    }
  }

 private:
  struct Entry {
    Scene scene;
    std::size_t index;  ///< of its run
    std::vector<double> times;
    double spent;
  };

  bool wants_more(const Entry& entry) const {
    return entry.times.empty() || (entry.spent < seconds_ && entry.times.size() < kMostRepetitions);
  }

  double seconds_;
  SimulationOptions options_;
  std::vector<Entry> entries_;
};

/// The first run of a reference, at its finest, with at most so many steps. Its step limit is the scene's again where
/// that is reached.
Run first_run(Scene scene, const std::string& solver, long step_limit, const GoOn& go_on) {
  scene.solver.step_limit = std::min(scene.solver.step_limit, step_limit);
  return run(with_solver(scene, solver, kReferenceTolerance, false), {}, go_on);
}

AccuracyReference find_reference(const Scene& scene, const GoOn& go_on) {
  AccuracyReference reference;
  reference.method = "event";
  Run first = first_run(scene, reference.method, kManySteps, go_on);
  if (first.result.outcome == Outcome::failed && first.result.counts.steps > kManySteps) {
    const Run implicit = first_run(scene, "implicit", kManySteps, go_on);
    if (implicit.result.outcome != Outcome::failed) {
      reference.method = "implicit";
      first = implicit;
    } else {
      first = first_run(scene, reference.method, scene.solver.step_limit, go_on);
    }
  }
  if (first.result.outcome == Outcome::failed)
    throw std::runtime_error("the reference run failed: " + first.result.failure);
  reference.end_time = first.result.final_time;
  reference.aligned_time = first.result.aligned_time;
  SimulationOptions options;
  if (first.ends_with_touch) {
    options.until = reference.end_time *= kBeforeTouch;
    first = run(with_solver(scene, reference.method, kReferenceTolerance, false), options, go_on);
  }
  reference.end = first.result.final_state;
  reference.peak_force = first.result.peak_force;
  options.until = reference.end_time;
  const TrialResult second = run(with_solver(scene, kImplicitAlone, kSecondTolerance, false), options, go_on).result;
  if (second.outcome == Outcome::failed)
    throw std::runtime_error("the check of the reference failed: " + second.failure);
  reference.agreement = pose_difference(second.final_state, reference.end);
  return reference;
}

/// True for a solver that this build has.
bool is_built(const Scene& scene, const SolverName& solver) {
  try {
    Simulation(with_solver(scene, solver.name, kTolerances[0], solver.fixed_step));
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

/// What is tried: all settings of all solvers that are wanted, or else of all that are built.
std::vector<AccuracyRun> runs_of(const Scene& scene, const AccuracyOptions& options) {
  std::vector<AccuracyRun> runs;
  const std::vector<std::string>& wanted = options.solvers;
  for (const SolverName& solver : solver_names) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), solver.name) == wanted.end()) continue;
    if (wanted.empty() && !is_built(scene, solver)) continue;
    for (const double setting : settings_of(scene, solver.fixed_step)) {
      AccuracyRun run;
      run.solver = solver.name;
      run.setting = setting;
      run.fixed_step = solver.fixed_step;
      runs.push_back(run);
    }
  }
  return runs;
}

}  // namespace

std::optional<AccuracyReference> accuracy_reference(const Scene& scene, const GoOn& go_on) {
  try {
    return find_reference(scene, go_on);
  } catch (const Stopped&) {
    return {};
  }
}

std::vector<AccuracyRun> run_accuracy_study(const Scene& scene, const AccuracyReference& reference,
                                            const AccuracyOptions& options, const GoOn& go_on,
                                            const std::function<void(double, const AccuracyRun*)>& progress) {
  std::vector<AccuracyRun> runs = runs_of(scene, options);
  Stopwatch stopwatch(reference, options.seconds_per_run);
  try {
    std::string slow;  // solver whose last run was too long for finer ones
    for (std::size_t i = 0; i < runs.size(); ++i) {
      AccuracyRun& run = runs[i];
      progress(static_cast<double>(i) / static_cast<double>(runs.size()), &run);
      if (run.solver == slow) {
        run.failure = "left out: a coarser one took too long";
        continue;
      }
      const Scene with_setting = with_solver(scene, run.solver, run.setting, run.fixed_step);
      compare(with_setting, reference, go_on, run);
      if (run.cpu_seconds > options.longest_run) slow = run.solver;
      if (run.failure.empty()) stopwatch.add(with_setting, i);
    }
    progress(1.0, nullptr);
    stopwatch.time(go_on, runs);
  } catch (const Stopped&) {
    runs.clear();
  }
  return runs;
}

const AccuracyRun* cheapest_for(const std::vector<AccuracyRun>& runs, double error) {
  const AccuracyRun* best = nullptr;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    // kept by this and by all finer runs of the same solver, which follow it
    bool kept = runs[i].failure.empty();
    for (std::size_t j = i; j < runs.size() && runs[j].solver == runs[i].solver; ++j)
      kept = kept && (!runs[j].failure.empty() || runs[j].pose_error <= error);
    if (kept && (best == nullptr || runs[i].cpu_seconds < best->cpu_seconds)) best = &runs[i];
  }
  return best;
}

}  // namespace vibratory_alignment
