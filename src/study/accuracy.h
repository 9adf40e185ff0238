// What accuracy costs: a trial by every solver over tolerances or steps, against a converged reference.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model/scene.h"
#include "trial/outcome.h"

namespace vibratory_alignment {

/// Asked at every step of every run: false ends the study.
using GoOn = std::function<bool()>;

/// The converged answer: the end state of the trial, its peak forces and its alignment duration. Dimensionless.
struct AccuracyReference {
  /// Every run of the study ends here: at the end of the trial, or a hundredth before it where that is a touch, whose
  /// force belongs to the peaks or not by the last digit of the time.
  double end_time = 0.0;
  State end;
  std::array<double, kSpotCount> peak_force{};
  std::optional<double> aligned_time;
  /// Difference of the pose from that of a second method; errors below it say nothing.
  double agreement = 0.0;
  std::string method;
};

/// One run of one solver.
struct AccuracyRun {
  std::string solver;
  double setting = 0.0;  ///< tolerance, or step of a fixed-step solver, dimensionless
  bool fixed_step = false;
  std::string failure;       ///< not empty: the trial failed, and why, or was left out
  double pose_error = 0.0;   ///< largest difference of x, y, phi at the end
  double force_error = 0.0;  ///< largest difference of a peak force, relative to the largest peak force
  std::optional<double> duration_error;
  double cpu_seconds = 0.0;  ///< of one trial: median of the repetitions, which all runs of the study take in turns
  int repetitions = 0;
  SolverCounts counts;
  double energy_residual = 0.0;
};

struct AccuracyOptions {
  std::vector<std::string> solvers;  ///< names; empty: all that this build has
  double seconds_per_run = 0.2;      ///< CPU time that the repetitions of a run may take; one is made in any case
  double longest_run = 10.0;  ///< a solver's finer settings are left out after a run longer than this, in s of CPU time
};

/// The reference of a scene: `event` at tolerance 1e-13, checked by implicit steps alone at 1e-11. Where `event` would
/// need more than 200000 steps and `implicit` does not, as in lasting contact on a very stiff base, it is
/// `implicit`. None when it is not to go on. Throws SceneError, std::runtime_error when the trial fails.
std::optional<AccuracyReference> accuracy_reference(const Scene& scene, const GoOn& go_on);

/// All runs, solver by solver, coarse to fine; none when it is not to go on. `progress` is told which run comes next,
/// null when all are to be timed, and the share of all that are done. Throws std::invalid_argument for a solver that is
/// named and not in this build.
std::vector<AccuracyRun> run_accuracy_study(const Scene& scene, const AccuracyReference& reference,
                                            const AccuracyOptions& options, const GoOn& go_on,
                                            const std::function<void(double, const AccuracyRun*)>& progress);

/// The fastest run whose error, and that of all finer runs of its solver that have an answer, is at most `error`; null
/// when there is none.
const AccuracyRun* cheapest_for(const std::vector<AccuracyRun>& runs, double error);

}  // namespace vibratory_alignment
