#include "cli/trial_command.h"

#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/csv_writer.h"
#include "cli/errors.h"
#include "cli/interrupt.h"
#include "cli/json_report.h"
#include "cli/output_path.h"
#include "cli/output_roles.h"
#include "cli/progress_bar.h"
#include "cli/scene_path.h"
#include "cli/set_option.h"
#include "cli/solver_option.h"
#include "cli/summary.h"
#include "model/scaling.h"
#include "model/scene_loader.h"
#include "model/setting.h"
#include "model/solver_names.h"
#include "model/solver_rules.h"
#include "model/tree_reader.h"
#include "model/yaml_file.h"
#include "node/bag_writer.h"
#include "trial/sampler.h"
#include "trial/simulation.h"

namespace vibratory_alignment {
namespace {

constexpr char kTrialFooter[] = R"(Examples:
  align trial fig2                               the paper's alignment trial, which comes with the package
  align trial my_scene.yaml --json               a scene of your own, the result for a program
  align trial fig2 --csv run.csv --sample 0.01   motion and forces, every 0.01 and at every event
  align trial fig2 --set friction.coefficient=0.3 excitation.frequency=25
  align trial fig2 --until 5 --tolerance 1e-10   the motion until 5, more exactly
  align trial fig2 --accuracy 1e-6               solver and tolerance chosen for this error of the end
  align trial fig2 --solver rk4 --step 1e-4      the same by another solver (docs/solvers.md)

Units:
  Options, results and files are in the scene's own units. A scene with `units: si` has s, m, m/s, rad, N. Other
  scenes have the paper's: time 1/p where p^2 = K_Y/M, length F1/K_Y, force F1 (F1 is the unit of force,
  scales.force, K_Y the axial stiffness of the gripper, M the mass of the part). Angles are in rad.

CSV columns:
  t                        time
  x,y,phi,vx,vy,omega      position, tilt and velocity of the part
  n1,n2,t1,t2              normal and tangential force at the slot's edges a1 (right) and a2 (left)
  nb1,nb2,tb1,tb2          the same at the part's lower corners b1 (right) and b2 (left)
  nf1,nf2,tf1,tf2          the same where these corners stand on the slot's floor
  event                    1 at an event instant, 0 at a regular sample

Files appear under their names when they are whole; a run that fails or is interrupted leaves none.
Exit status: 0 the trial ran, whatever its outcome; 1 it failed while running; 2 bad usage or bad scene.)";

struct TrialCommandOptions {
  std::string scene;
  std::string solver, accuracy, tolerance, step;
  std::optional<double> until, sample;
  std::vector<std::string> settings;
  bool json = false;
  std::string csv, bag;
};

/// Accepts what a scene accepts under this rule, of numbers > 0.
CLI::Validator number_by(const NumberRule& rule) {
  const auto check = [&rule](const std::string& text) {
    const std::optional<double> value = parse_number(text);
    if (!value || !rule.allows(*value)) return text + " is not allowed: give " + rule.text;
    if (!has_sane_size(*value)) return text + " is not allowed: give " + rule.text + ", of a size from 1e-100 to 1e100";
    return std::string();
  };
  return CLI::Validator(check, "");
}

/// Takes `key` out of the section `solver`, if it is there.
void drop_solver_key(YAML::Node& tree, const std::string& key) {
  if (tree.IsMap() && tree["solver"].IsMap() && tree["solver"][key]) apply_setting(tree, "solver." + key + "=null");
}

/// A key of the section `solver`; no node where it is not given.
YAML::Node solver_key(const YAML::Node& tree, const char* key) {
  const YAML::Node section = tree.IsMap() ? tree["solver"] : YAML::Node();
  return section && section.IsMap() ? section[key] : YAML::Node();
}

/// The solver that the scene names; null when it names none that there is.
const SolverName* solver_of(const YAML::Node& tree) {
  const YAML::Node name = solver_key(tree, "name");
  return find_solver(name && name.IsScalar() ? name.Scalar() : SolverSettings().name);
}

/// The scene with everything that the options change in it.
Scene load(const TrialCommandOptions& options, const std::string& file) {
  YAML::Node tree = read_yaml_file(file);
  if (!options.solver.empty()) {
    apply_setting(tree, "solver.name=" + options.solver);
    // What the scene gives for its own solver means nothing to one of the other kind.
    const bool fixed_step = find_solver(options.solver)->fixed_step;
    drop_solver_key(tree, fixed_step ? "tolerance" : "step");
    if (fixed_step) drop_solver_key(tree, "accuracy");
  }
  if (!options.tolerance.empty() || !options.step.empty()) drop_solver_key(tree, "accuracy");
  if (!options.accuracy.empty()) {
    for (const char* chosen : {"tolerance", "step"}) drop_solver_key(tree, chosen);
    if (options.solver.empty()) drop_solver_key(tree, "name");
  }
  for (const std::string& setting : options.settings) apply_setting(tree, setting);

  const SolverName* const solver = solver_of(tree);
  if (solver && solver->fixed_step && !options.accuracy.empty()) {
    throw UsageError(std::string("--accuracy: the solver ") + solver->name + " has a fixed step; give --step");
  }
  if (solver && solver->fixed_step && !options.tolerance.empty()) {
    throw UsageError(std::string("--tolerance: the solver ") + solver->name + " has a fixed step; give --step");
  }
  if (solver && !solver->fixed_step && !options.step.empty()) {
    throw UsageError(std::string("--step: the solver ") + solver->name + " chooses its steps; give --tolerance");
  }
  if (!options.accuracy.empty()) apply_setting(tree, "solver.accuracy=" + options.accuracy);
  if (!options.tolerance.empty()) apply_setting(tree, "solver.tolerance=" + options.tolerance);
  if (!options.step.empty()) apply_setting(tree, "solver.step=" + options.step);
  return load_scene(tree, file, options.settings);
}

/// Throws UsageError for a name that would overwrite the scene or another output.
void check_outputs(const TrialCommandOptions& options, const std::string& scene_file) {
  refuse_overwriting({{"the scene", scene_file}}, {{"--csv", options.csv}, {"--bag", options.bag}});
  if (options.json && is_stdout(options.csv)) throw UsageError("--json: stdout has the rows of --csv");
}

/// Dimensionless: --sample, or a twentieth of the period of the fastest excitation.
double sample_interval(const TrialCommandOptions& options, const Scene& scene, double end) {
  const double interval =
      options.sample ? *options.sample / output_units(scene).time : scene.shortest_period() / kUsualSamplesPerPeriod;
  if (end / interval > kMostSamples) {
    throw UsageError("--sample: the run would have more than 1e9 samples; give a longer interval");
  }
  return interval;
}

Simulation make_simulation(const Scene& scene, const SimulationOptions& options) {
  try {
    return Simulation(scene, options);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

/// The files that a trial is recorded in.
class Recorder {
 public:
  /// Throws UsageError when one of them cannot be written.
  Recorder(const TrialCommandOptions& options, const Scene& scene) {
    if (!options.csv.empty()) csv_ = std::make_unique<CsvWriter>(options.csv, output_units(scene));
    if (!options.bag.empty()) {
      bag_path_ = std::make_unique<OutputPath>("--bag", options.bag);
      bag_ = std::make_unique<BagWriter>(bag_path_->temporary(), scene);
    }
  }

  bool wanted() const { return csv_ || bag_; }

  /// Throws std::runtime_error.
  void write(const Sample& sample) {
    if (csv_) csv_->write(sample);
    if (bag_) bag_->write(sample);
  }

  /// The run is whole: the files get their names. Without it they leave nothing. Throws std::runtime_error.
  void finish(const TrialResult& result) {
    if (bag_) bag_->finish(result);
    if (csv_) csv_->finish();
    if (bag_path_) bag_path_->commit();
  }

 private:
  std::unique_ptr<CsvWriter> csv_;
  std::unique_ptr<OutputPath> bag_path_;
  std::unique_ptr<BagWriter> bag_;
};

/// Shows how far a trial is that ends at time `end` at the latest, in the scene's own unit.
void show(ProgressBar& progress, double time, double end) {
  progress.update(end > 0.0 ? time / end : 0.0, [&] {
    char words[80];
    std::snprintf(words, sizeof words, "at t = %.5g of at most %.5g, %.0f s", time, end, progress.seconds());
    return std::string(words);
  });
}

/// Runs to the end or to a signal.
void simulate(Simulation& simulation, Recorder& recorder, double interval, double end, const InterruptGuard& interrupt,
              ProgressBar& progress) {
  const double unit = output_units(simulation.scene()).time;
  const auto go_on = [&] {
    show(progress, simulation.time() * unit, end * unit);
    return interrupt.signal() == 0;
  };
  if (!recorder.wanted()) {
    while (go_on() && simulation.advance()) {
    }
    return;
  }
  Sampler sampler(simulation, interval, true);
  Sample sample;
  while (go_on() && sampler.next(sample, go_on)) recorder.write(sample);
}

int run_trial(const TrialCommandOptions& options) {
  const std::string file = find_scene(options.scene);
  check_outputs(options, file);
  const Scene scene = load(options, file);
  const double time_unit = output_units(scene).time;

  SimulationOptions simulation_options;
  if (options.until) simulation_options.until = *options.until / time_unit;
  const double end = simulation_options.until.value_or(scene.trial.time_limit);
  const bool sampled = !options.csv.empty() || !options.bag.empty();
  const double interval = sampled ? sample_interval(options, scene, end) : end;
  Simulation simulation = make_simulation(scene, simulation_options);
  const InterruptGuard interrupt;
  Recorder recorder(options, scene);

  const bool rows_on_stdout = is_stdout(options.csv);
  {
    ProgressBar progress(!options.json && !rows_on_stdout && stdout_is_terminal());
    simulate(simulation, recorder, interval, end, interrupt, progress);
  }
  if (interrupt.signal() != 0) {
    std::fprintf(stderr, "align: interrupted at t = %.6g; nothing is reported or written\n",
                 simulation.time() * time_unit);
    return 128 + interrupt.signal();
  }
  const TrialResult result = simulation.result();
  const bool failed = result.outcome == Outcome::failed;
  std::ostream& out = rows_on_stdout ? std::cerr : std::cout;
  if (!failed) recorder.finish(result);

  out << (options.json ? json_report(result, scene) + "\n" : summary(result, scene)) << std::flush;
  if (!out) throw OutputError("stdout", "the report is lost");
  if (!failed) return kExitRan;
  std::fprintf(stderr, "align: the trial failed at t = %.6g: %s%s\n", result.final_time * time_unit,
               result.failure.c_str(), recorder.wanted() ? "; it leaves no file" : "");
  return kExitFailed;
}

}  // namespace

std::function<int()> set_up_trial(CLI::App& app) {
  const auto options = std::make_shared<TrialCommandOptions>();
  const CLI::Validator positive = number_by(positive_number);
  app.footer(kTrialFooter);
  app.add_option("SCENE", options->scene,
                 "Scene file (YAML), or the name of a scene that comes with\nthe package, like fig2")
      ->required();
  app.add_option("--solver", options->solver, solver_list() + ";\ndefault: the one that the scene names, else event")
      ->check(CLI::Validator(check_solver, ""))
      ->type_name("NAME");
  CLI::Option* const accuracy = app.add_option("--accuracy", options->accuracy,
                                               "Choose solver and tolerance so that x, y, phi at the end are exact to\n"
                                               "this, dimensionless; with --solver the tolerance alone. Where impacts\n"
                                               "amplify the last digits of a double beyond it no tolerance keeps it:\n"
                                               "`align accuracy` tells");
  CLI::Option* const tolerance = app.add_option("--tolerance", options->tolerance,
                                                "For solvers that choose their steps: the error that a step may have");
  CLI::Option* const step = app.add_option("--step", options->step, "For rk4, semi_implicit and ode: the step, a time");
  accuracy->check(number_by(accuracy_rule))->type_name("E")->excludes(step)->excludes(tolerance);
  tolerance->check(number_by(tolerance_rule))->type_name("E")->excludes(step);
  step->check(positive)->type_name("H");
  app.add_option("--until", options->until,
                 "Run exactly to this time, whatever happens before. Default: to the\n"
                 "outcome, at most to trial.time_limit of the scene")
      ->check(positive)
      ->type_name("TAU");
  add_set_option(app, options->settings,
                 "Give keys of the scene other values, as in\n--set gripper.pressing_force=0.3; can be repeated");
  app.add_flag("--json", options->json, "Print one JSON object instead of the summary, and nothing else");
  app.add_option("--csv", options->csv, "Write the motion and the forces to this file")
      ->check(file_name())
      ->type_name("FILE");
  app.add_option("--bag", options->bag, "Write a ROS bag with the topics of aligner_node; needs no ROS master")
      ->check(file_name())
      ->type_name("FILE");
  app.add_option("--sample", options->sample,
                 "Time between two rows of the CSV file or messages of the bag. Changes\n"
                 "nothing in the motion. Default: 1/20 of the shortest excitation period")
      ->check(positive)
      ->type_name("DT");
  return [options] { return run_trial(*options); };
}

}  // namespace vibratory_alignment
