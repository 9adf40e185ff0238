#include "cli/accuracy_command.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/errors.h"
#include "cli/interrupt.h"
#include "cli/output_path.h"
#include "cli/output_roles.h"
#include "cli/picture_format.h"
#include "cli/progress_bar.h"
#include "cli/row_text.h"
#include "cli/scene_path.h"
#include "cli/script.h"
#include "cli/set_option.h"
#include "cli/solver_option.h"
#include "cli/temporary_file.h"
#include "cli/whole_file.h"
#include "model/number_text.h"
#include "model/scaling.h"
#include "model/scene_loader.h"
#include "model/setting.h"
#include "model/solver_choice.h"
#include "model/yaml_file.h"
#include "study/accuracy.h"

namespace vibratory_alignment {
namespace {

constexpr char kAccuracyFooter[] = R"(Examples:
  align accuracy r1                                  every solver of this build on the scene r1
  align accuracy r1 --solvers event,implicit         only these
  align accuracy my_scene.yaml --csv a.csv --plot a.png

The reference is the trial by `event` at tolerance 1e-13 (by `implicit` where that takes more than 200000 steps),
checked by implicit steps at 1e-11; errors below their difference say nothing. Every run ends where the reference ended.
Errors of the pose (the largest difference of x, y and phi there) and of the duration are dimensionless, steps are in
the scene's own unit of time. Time: CPU time of one trial, median of repetitions that all runs take in turns; compare
times of one run only.
Exit status: 0 it ran; 1 it failed while running; 2 bad usage or bad scene.)";

struct AccuracyCommandOptions {
  std::string scene, csv, plot;
  std::vector<std::string> solvers, settings;
};

std::string format(const char* pattern, double value) {
  char text[32];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

/// A step or tolerance as `--step` and `--tolerance` take it: a step in the scene's own unit of time.
double own_setting(const Scene& scene, const AccuracyRun& run) {
  return run.fixed_step ? run.setting * output_units(scene).time : run.setting;
}

void print_heading(std::FILE* out, const Scene& scene, const AccuracyReference& reference) {
  std::fprintf(out, "%s to %.6g (dimensionless); reference %s, implicit steps alone differ by %.1e%s\n\n",
               scene.name.c_str(), reference.end_time, reference.method.c_str(), reference.agreement,
               scene.units == Units::si ? "; steps in s" : "");
  std::fprintf(out, "%-14s %9s %10s %10s %10s %11s %10s %9s %8s %10s\n", "solver", "setting", "pose", "force",
               "duration", "time [us]", "rhs", "steps", "events", "residual");
}

void print_row(std::FILE* out, const Scene& scene, const AccuracyRun& run) {
  const double setting = own_setting(scene, run);
  if (!run.failure.empty()) {
    std::fprintf(out, "%-14s %9.1e %s\n", run.solver.c_str(), setting, run.failure.c_str());
    return;
  }
  std::fprintf(out, "%-14s %9.1e %10.1e %10.1e %10s %11.1f %10ld %9ld %8ld %10.1e\n", run.solver.c_str(), setting,
               run.pose_error, run.force_error, run.duration_error ? format("%.1e", *run.duration_error).c_str() : "-",
               1e6 * run.cpu_seconds, run.counts.rhs_evaluations, run.counts.steps, run.counts.events,
               run.energy_residual);
}

/// Throws OutputError.
void write_csv(const std::string& path, const std::string& name, const Scene& scene,
               const std::vector<AccuracyRun>& runs, const AccuracyReference& reference) {
  std::ofstream file(path);
  file << "solver,kind,setting,pose_error,force_error,duration_error,cpu_seconds,repetitions,rhs_evaluations,steps,"
          "rejected,events,energy_residual,reference_agreement,failure\n";
  for (const AccuracyRun& run : runs) {
    file << run.solver << ',' << (run.fixed_step ? "step" : "tolerance") << ',' << number_text(own_setting(scene, run))
         << ',';
    if (run.failure.empty()) {
      file << number_text(run.pose_error) << ',' << number_text(run.force_error) << ',';
      if (run.duration_error) file << number_text(*run.duration_error);
      file << ',' << number_text(run.cpu_seconds) << ',' << run.repetitions << ',' << run.counts.rhs_evaluations << ','
           << run.counts.steps << ',' << run.counts.rejected << ',' << run.counts.events << ','
           << number_text(run.energy_residual) << ',' << number_text(reference.agreement) << ",\n";
    } else {
      file << ",,,,,,,,,," << number_text(reference.agreement) << ',' << csv_cell(run.failure) << '\n';
    }
  }
  close_written(file, name);
}

/// What `solver: {accuracy: ...}` makes of it, and how that went if it is among the runs.
void print_choice(std::FILE* out, const Scene& scene, const std::vector<AccuracyRun>& runs, double error) {
  const std::string solver = solver_for_accuracy(scene);
  const double tolerance = tolerance_for_accuracy(error);
  std::fprintf(out, "  solver: {accuracy: %.0e} picks %s with a tolerance of %.1e", error, solver.c_str(), tolerance);
  bool tried = false;
  for (const AccuracyRun& run : runs) {
    tried = tried || run.solver == solver;
    if (run.solver == solver && run.failure.empty() && std::abs(run.setting - tolerance) < 1e-6 * tolerance)
      std::fprintf(out, ": error %.1e, %.0f us", run.pose_error, 1e6 * run.cpu_seconds);
  }
  std::fprintf(out, tried ? ".\n" : ", which is not among these.\n");
}

/// For each of a few errors the cheapest way, and the way to have one chosen.
void print_advice(std::FILE* out, const Scene& scene, const std::vector<AccuracyRun>& runs,
                  const AccuracyReference& reference) {
  std::fprintf(out, "\n");
  for (const double error : {1e-3, 1e-6, 1e-9}) {
    if (error < reference.agreement) {
      std::fprintf(out, "For an error of %.0e: not known, the two references differ by more.\n", error);
      continue;
    }
    const AccuracyRun* run = cheapest_for(runs, error);
    if (run == nullptr) {
      std::fprintf(out, "For an error of %.0e: none of these keeps it.\n", error);
    } else {
      const char* unit = run->fixed_step && scene.units == Units::si ? " s" : "";
      std::fprintf(out, "For an error of %.0e use %s with a %s of %.1e%s: it costs %.0f us.\n", error,
                   run->solver.c_str(), run->fixed_step ? "step" : "tolerance", own_setting(scene, *run), unit,
                   1e6 * run->cpu_seconds);
    }
    print_choice(out, scene, runs, error);
  }
}

/// Reference and runs; what there is when a signal has come.
std::optional<AccuracyReference> run_study(const Scene& scene, const AccuracyCommandOptions& options,
                                           const InterruptGuard& interrupt, std::vector<AccuracyRun>& runs) {
  ProgressBar bar(stdout_is_terminal() && !is_stdout(options.csv));
  double share = 0.0;
  std::string words = "reference";
  unsigned asked = 0;
  const GoOn go_on = [&] {
    // at every step of runs that are timed: a look at the clock is not nothing
    if (asked++ % 64 == 0) bar.update(share, [&] { return words; });
    return interrupt.signal() == 0;
  };
  const std::optional<AccuracyReference> reference = accuracy_reference(scene, go_on);
  if (!reference) return reference;
  AccuracyOptions study;
  study.solvers = options.solvers;
  try {
    runs = run_accuracy_study(scene, *reference, study, go_on, [&](double done, const AccuracyRun* next) {
      share = done;
      words = next != nullptr ? next->solver + format(", %.0e", own_setting(scene, *next)) : "times, in turns";
    });
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  return reference;
}

int run_accuracy(const AccuracyCommandOptions& options) {
  const std::string file = find_scene(options.scene);
  refuse_overwriting({{"the scene", file}}, {{"--csv", options.csv}, {"--plot", options.plot}});
  YAML::Node tree = read_yaml_file(file);
  for (const std::string& setting : options.settings) apply_setting(tree, setting);
  const Scene scene = load_scene(tree, file, options.settings);
  const std::string format = options.plot.empty() ? "" : picture_format("--plot", options.plot);
  const InterruptGuard interrupt;
  std::unique_ptr<OutputPath> csv, picture;
  if (!options.csv.empty()) csv = std::make_unique<OutputPath>("--csv", options.csv);
  if (!options.plot.empty()) picture = std::make_unique<OutputPath>("--plot", options.plot);

  std::vector<AccuracyRun> runs;
  const std::optional<AccuracyReference> reference = run_study(scene, options, interrupt, runs);
  if (interrupt.signal() != 0) {
    std::fprintf(stderr, "align: interrupted; no file is written\n");
    return 128 + interrupt.signal();
  }
  if (csv) {
    write_csv(csv->temporary(), csv->path(), scene, runs, *reference);
    csv->commit();
  }
  // stdout may have the rows of --csv
  std::FILE* const out = is_stdout(options.csv) ? stderr : stdout;
  print_heading(out, scene, *reference);
  for (const AccuracyRun& run : runs) print_row(out, scene, run);
  print_advice(out, scene, runs, *reference);
  if (std::fflush(out) != 0 || std::ferror(out) != 0)
    throw OutputError(out == stdout ? "stdout" : "stderr", "the table is lost");
  if (picture) {
    const TemporaryFile table(options.plot);
    write_csv(table.path(), table.path(), scene, runs, *reference);
    require_script(
        "plot_accuracy.py",
        {path_word(table.path()), path_word(picture->temporary()), "--format", format, "--title=" + scene.name},
        "--plot", interrupt);
    if (interrupt.signal() != 0) {
      std::fprintf(stderr, "align: interrupted; no picture is written\n");
      return 128 + interrupt.signal();
    }
    picture->commit();
  }
  return kExitRan;
}

}  // namespace

std::function<int()> set_up_accuracy(CLI::App& app) {
  const auto options = std::make_shared<AccuracyCommandOptions>();
  app.footer(kAccuracyFooter);
  app.add_option("SCENE", options->scene,
                 "Scene file (YAML), or the name of a scene that comes with\nthe package, like r1")
      ->required();
  app.add_option("--solvers", options->solvers, "Solvers to try, as in event,implicit. Default: all of this build")
      ->delimiter(',')
      ->check(CLI::Validator(check_solver, ""))
      ->type_name("NAME,...");
  add_set_option(app, options->settings, "Give keys of the scene other values; can be repeated");
  app.add_option("--csv", options->csv, "Write the table to this file")->check(file_name())->type_name("FILE");
  app.add_option("--plot", options->plot, "Draw error against time, one line per solver: .png, .svg or .pdf")
      ->check(file_name())
      ->type_name("FILE");
  return [options] { return run_accuracy(*options); };
}

}  // namespace vibratory_alignment
