#include "cli/calibrate_command.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/calibration_log.h"
#include "cli/calibration_report.h"
#include "cli/command.h"
#include "cli/counted.h"
#include "cli/errors.h"
#include "cli/interrupt.h"
#include "cli/output_path.h"
#include "cli/output_roles.h"
#include "cli/scene_path.h"
#include "cli/suite_inputs.h"
#include "cli/whole_file.h"
#include "model/scene_error.h"
#include "study/calibration.h"
#include "study/calibration_file.h"
#include "study/fact_suite.h"
#include "study/thread_group.h"

namespace vibratory_alignment {
namespace {

constexpr char kCalibrateFooter[] = R"(Examples:
  align calibrate config/paper/calibration.yaml --report calibration.md
  align calibrate my_search.yaml --threads 8
  align calibrate my_search.yaml --log my_search.jsonl --resume     goes on where an earlier run ended

A calibration file names facts, the values that are searched for with their ranges, and what they are in the scenes
(docs/studies.md). The search is the same whatever the threads; one thread runs one search. It takes from minutes to
hours: every half minute a line on stderr tells how far it is.
Exit status: 0 it ran; 1 it failed while running; 2 bad usage or bad file; interrupted: 128 + the signal.)";

constexpr double kSecondsBetweenLines = 30.0;

struct CalibrateCommandOptions {
  std::string file, report, log;
  bool resume = false;
  int threads = usual_thread_count();
};

/// Tells now and then how far the search is.
class ProgressLines {
 public:
  void update(const CalibrationProgress& progress) {
    const auto now = Clock::now();
    if (now < next_) return;
    next_ = now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(kSecondsBetweenLines));
    const double seconds = std::chrono::duration<double>(now - begin_).count();
    std::fprintf(stderr, "%6.0f s: %s, %s", seconds, counted(progress.evaluations, "set").c_str(),
                 counted(progress.trials, "trial").c_str());
    if (std::isfinite(progress.best_shortfall))
      std::fprintf(stderr, "; best: shortfall %.3f, %s met", progress.best_shortfall,
                   counted(progress.best_met, "fact").c_str());
    std::fprintf(stderr, "\n");
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now(), next_ = begin_;
};

/// What `action` returns. What it refuses is bad usage: the calibration, the facts it names, their studies and scenes.
template <class Action>
auto with_refusals(const Action& action) {
  try {
    return action();
  } catch (const SceneError& refusal) {
    throw UsageError(std::string("the calibration, its facts or their studies are refused:\n") + refusal.what());
  }
}

/// Throws UsageError for an output that would overwrite an input or the other output, SceneError for what cannot run.
void check(const CalibrateCommandOptions& options, const Calibration& calibration) {
  const FactSuite suite = load_fact_suite(calibration.facts_file, find_scene);
  std::vector<NamedFile> inputs = suite_inputs(suite);
  inputs.push_back({"the calibration", calibration.source});
  refuse_overwriting(inputs, {{"--report", options.report}, {"--log", options.log}});
  check_calibration(calibration, suite);
}

int run_calibrate(const CalibrateCommandOptions& options) {
  const Calibration calibration = with_refusals([&] { return load_calibration(options.file); });
  with_refusals([&] { check(options, calibration); });
  const InterruptGuard interrupt;
  std::unique_ptr<OutputPath> report;
  if (!options.report.empty()) report = std::make_unique<OutputPath>("--report", options.report);

  std::unique_ptr<CalibrationLog> log;
  if (!options.log.empty()) {
    const auto print = with_refusals([&] { return fingerprint(calibration, find_scene, VIBRATORY_ALIGNMENT_VERSION); });
    log = std::make_unique<CalibrationLog>(options.log, print, options.resume);
  }

  ProgressLines lines;
  CalibrationOptions run;
  run.threads = options.threads;
  run.find_scene = find_scene;
  run.progress = [&](const CalibrationProgress& progress) { lines.update(progress); };
  run.go_on = [&] { return interrupt.signal() == 0; };
  if (log) {
    run.known = [&](const CalibrationPlace& place, const std::vector<double>& values) {
      return log->known(place, values);
    };
    run.keep = [&](const CalibrationPlace& place, const std::vector<double>& values, const CalibrationAnswer& answer) {
      log->keep(place, values, answer);
    };
  }
  CalibrationResult result;
  try {
    result = with_refusals([&] { return run_calibration(calibration, run); });
  } catch (const std::runtime_error&) {
    if (interrupt.signal() == 0) throw;
    std::fprintf(stderr, "align: interrupted; nothing is reported%s\n",
                 log ? ". --resume goes on with what the log has" : ", and without --log nothing is kept");
    return 128 + interrupt.signal();
  }
  if (!report) {
    write_calibration_report(std::cout, calibration, result);
    std::cout << std::flush;
    if (!std::cout) throw OutputError("stdout", "the report is lost");
    return kExitRan;
  }
  std::ofstream file(report->temporary());
  write_calibration_report(file, calibration, result);
  close_written(file, report->path());
  report->commit();
  return kExitRan;
}

}  // namespace

std::function<int()> set_up_calibrate(CLI::App& app) {
  const auto options = std::make_shared<CalibrateCommandOptions>();
  app.footer(kCalibrateFooter);
  app.add_option("CALIBRATION", options->file, "Calibration file (YAML)")->required();
  app.add_option("--threads", options->threads, "Searches that run at the same time. Default: the processors")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  app.add_option("--report", options->report, "Write the report (Markdown) to this file instead of stdout")
      ->check(file_name())
      ->type_name("FILE");
  CLI::Option* log = app.add_option("--log", options->log, "Write every answer to this file, as it is known")
                         ->check(file_name())
                         ->type_name("FILE");
  app.add_flag("--resume", options->resume, "Go on with the answers that the log has")->needs(log);
  return [options] { return run_calibrate(*options); };
}

}  // namespace vibratory_alignment
