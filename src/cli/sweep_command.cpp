#include "cli/sweep_command.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/counted.h"
#include "cli/errors.h"
#include "cli/interrupt.h"
#include "cli/output_path.h"
#include "cli/output_roles.h"
#include "cli/progress_bar.h"
#include "cli/row_text.h"
#include "cli/scene_path.h"
#include "cli/set_option.h"
#include "cli/sweep_csv.h"
#include "cli/sweep_head.h"
#include "cli/sweep_summary.h"
#include "model/scene_error.h"
#include "study/design.h"
#include "study/fingerprint.h"
#include "study/study_file.h"
#include "study/study_refusals.h"
#include "study/sweep.h"
#include "study/thread_group.h"

namespace vibratory_alignment {
namespace {

constexpr char kSweepFooter[] = R"(Examples:
  align sweep force_and_offset                     a study that comes with the package: summary only
  align sweep my_study.yaml --csv out.csv          one row a trial, in out.csv
  align sweep my_study.yaml --csv out.csv --resume goes on after Ctrl-C, a crash, a power cut
  align sweep my_study.yaml --csv 3.csv --shard 3/8 --resume   the third of eight parts, on a cluster
  align merge out.csv 1.csv 2.csv ...              puts such parts together
  align sweep my_study.yaml --set solver.tolerance=1e-6        another value for all trials

A study names a scene and says which of its values are varied: docs/studies.md, also for the columns of the file.
Rows come in the order of the trials; threads, shards and interruptions change no byte of the result.
The file is FILE.part until it is whole; what is in it when the sweep ends early is kept for --resume.
Exit status: 0 it ran, whatever the outcomes; 1 it failed while running; 2 bad usage, study or scene.)";

struct SweepCommandOptions {
  std::string study, csv, shard;
  std::vector<std::string> settings;
  int threads = 0;
  bool resume = false;
};

std::string check_shard(const std::string& text) {
  if (parse_shard(text)) return {};
  return text + " is not allowed: give I/N, as in 3/8 for the third of eight shards";
}

Study load(const SweepCommandOptions& options) {
  const std::string file = find_study(options.study);
  try {
    const Study study = load_study(file, find_scene);
    refuse_overwriting({{"the study", file}, {"the scene", study.scene_source}}, {{"--csv", options.csv}});
    if (options.settings.empty()) return study;
    refuse_settings_of_varied_keys(study, options.settings);
    const Study changed = with_settings(study, options.settings);
    refuse_without_scenes(changed);
    return changed;
  } catch (const SceneError& refusal) {
    throw UsageError(std::string("the study is refused:\n") + refusal.what());
  }
}

/// "3h 02m", "4m 10s", "12s", "0.35s"
std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::min(seconds, 1e9) + 0.5);
  char text[40];
  if (whole >= 3600)
    std::snprintf(text, sizeof text, "%ldh %02ldm", whole / 3600, whole / 60 % 60);
  else if (whole >= 60)
    std::snprintf(text, sizeof text, "%ldm %02lds", whole / 60, whole % 60);
  else if (seconds >= 10.0)
    std::snprintf(text, sizeof text, "%lds", whole);
  else
    std::snprintf(text, sizeof text, "%.2gs", seconds);
  return text;
}

/// A row of the file, from an earlier run, in a table with so many varied keys.
void add_line(SweepSummary& summary, const std::string& line, std::size_t varied) {
  const std::vector<std::string> cells = cells_of(line);
  const std::string& duration = cells.at(varied + 3);
  summary.add(std::strtoull(line.c_str(), nullptr, 10), cells.at(varied + 1),
              duration.empty() ? TrialRow::none : std::strtod(duration.c_str(), nullptr), cells.back());
}

struct Run {
  bool complete = false;
  int signal = 0;  ///< that ended it
  std::size_t trials = 0;
  double seconds = 0.0;

  double rate() const { return seconds > 0.0 ? static_cast<double>(trials) / seconds : 0.0; }
};

/// "1234 of 5000, 2.1e+03/s, 2s left; aligned 97 %"
std::string progress_text(const SweepSummary& summary, const Run& run, std::size_t count) {
  char words[100];
  std::snprintf(words, sizeof words, "%zu of %zu, %.3g/s, ", summary.trials(), count, run.rate());
  const std::size_t left = count - summary.trials();
  return words + (run.trials > 0 ? duration_text(static_cast<double>(left) / run.rate()) + " left; " : "") +
         summary.short_text();
}

/// Runs what is left of the sweep.
Run run(const Study& study, const SweepCommandOptions& options, const Shard& shard, SweepCsv* csv,
        SweepSummary& summary) {
  const InterruptGuard interrupt;
  ProgressBar bar(stdout_is_terminal() && !is_stdout(options.csv));
  const std::size_t count = shard_size(shard, trial_count(study));
  Run result;
  SweepOptions sweep;
  sweep.threads = options.threads > 0 ? options.threads : usual_thread_count();
  sweep.first = shard.number + summary.trials() * shard.count;
  sweep.stride = shard.count;
  sweep.go_on = [&] {
    if (csv != nullptr) csv->flush();
    result.seconds = bar.seconds();
    bar.update(static_cast<double>(summary.trials()) / static_cast<double>(count),
               [&] { return progress_text(summary, result, count); });
    return interrupt.signal() == 0;
  };
  result.complete = run_sweep(study, sweep, [&](const TrialRow& row) {
    if (csv != nullptr) csv->write(row_text(row, values_at(study, row.index)));
    summary.add(row.index, outcome_word(row), row.duration, row.reason);
    ++result.trials;
  });
  result.seconds = bar.seconds();
  result.signal = interrupt.signal();
  return result;
}

std::string report(const Study& study, const SweepHead& head, const SweepSummary& summary, const Run& run) {
  char line[200];
  std::string text = "Study        " + study.name + ", " + counted(head.trials, "trial");
  if (head.shard.count > 1)
    text += "; shard " + shard_text(head.shard) + " has " + std::to_string(summary.trials()) + " of them";
  text += "\n" + summary.text();
  std::snprintf(line, sizeof line, "Run          %s in %s, %.3g per second\n", counted(run.trials, "trial").c_str(),
                duration_text(run.seconds).c_str(), run.rate());
  return text + line;
}

int run_command(const SweepCommandOptions& options) {
  if (options.resume && options.csv.empty()) throw UsageError("--resume: continues a file; name it with --csv");
  const Study study = load(options);
  const std::vector<std::string> names = varied_names(study);
  const SweepHead head = {fingerprint(study, VIBRATORY_ALIGNMENT_VERSION), trial_count(study),
                          parse_shard(options.shard).value_or(Shard())};
  SweepSummary summary;
  std::unique_ptr<SweepCsv> csv;
  if (!options.csv.empty())
    csv = std::make_unique<SweepCsv>(options.csv, head, row_header(names), options.resume,
                                     [&](const std::string& line) { add_line(summary, line, names.size()); });

  const Run result = run(study, options, head.shard, csv.get(), summary);
  if (!result.complete) {
    std::fprintf(stderr, "align: interrupted after %zu of %s", summary.trials(),
                 counted(shard_size(head.shard, head.trials), "trial").c_str());
    if (csv && !csv->is_direct())
      std::fprintf(stderr, "; %s keeps them. The same call with --resume goes on", csv->file().c_str());
    std::fprintf(stderr, "\n");
    return 128 + result.signal;
  }
  if (csv) csv->finish();
  std::ostream& out = is_stdout(options.csv) ? std::cerr : std::cout;
  out << report(study, head, summary, result) << std::flush;
  if (!out) throw OutputError("stdout", "the summary is lost");
  return kExitRan;
}

}  // namespace

std::function<int()> set_up_sweep(CLI::App& app) {
  const auto options = std::make_shared<SweepCommandOptions>();
  app.footer(kSweepFooter);
  app.add_option("STUDY", options->study, "Study file (YAML), or the name of a study that comes with\nthe package")
      ->required();
  app.add_option("--threads", options->threads, "Trials that run at a time. Default: one for each processor")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  app.add_option("--csv", options->csv, "Write one row a trial to this file")->check(file_name())->type_name("FILE");
  app.add_flag("--resume", options->resume,
               "Go on with the file of a sweep that ended early, or begin it if\nthere is none; nothing is run twice");
  app.add_option("--shard", options->shard, "Run part I of N of the trials alone, counted from 0: I - 1, I - 1 + N,\nI - 1 + 2N, ...")
      ->check(CLI::Validator(check_shard, ""))
      ->type_name("I/N");
  add_set_option(app, options->settings,
                 "Give keys of the scene other values in all trials, as for\n`align trial`; can be repeated");
  return [options] { return run_command(*options); };
}

}  // namespace vibratory_alignment
