#include "cli/reproduce_command.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "cli/command.h"
#include "cli/counted.h"
#include "cli/errors.h"
#include "cli/figure_files.h"
#include "cli/interrupt.h"
#include "cli/ledger_report.h"
#include "cli/output_path.h"
#include "cli/output_roles.h"
#include "cli/progress_bar.h"
#include "cli/scene_path.h"
#include "cli/script.h"
#include "cli/set_option.h"
#include "cli/suite_inputs.h"
#include "cli/whole_file.h"
#include "model/scene_error.h"
#include "study/fact_suite.h"
#include "study/study_refusals.h"
#include "study/thread_group.h"

namespace vibratory_alignment {
namespace {

constexpr int kResamples = 200;

constexpr char kNothingWritten[] = "no ledger and no figure is written";

/// For --quick: a look that takes a tenth of the time.
constexpr Thinning kQuick = {4, 3};

constexpr char kReproduceFooter[] = R"(Examples:
  align reproduce                        all figures and facts, into the folder reproduction
  align reproduce fig7                   Fig. 7 alone, and the facts that it shows
  align reproduce --check                exit status 1 if a fact that was met is no longer
  align reproduce --quick --set friction.coefficient=0.25      a look at other values

config/paper/facts.yaml lists the facts, how each is measured and the figures; config/studies has the studies that
they are measured on (docs/studies.md, docs/paper.md). The ledger shows for each measure its value, its bound and, for
studies with samples, the range of 5 to 95 % of its values when the samples are drawn anew.

Files in the folder: ledger.md, ledger.json; figures.json; of each figure its data (CSV) and pictures (SVG, PNG).
Exit status: 0 it ran; 1 it failed while running, or --check found a fact missed that is expected to be met;
2 bad usage, facts file, study or scene.)";

struct ReproduceCommandOptions {
  std::vector<std::string> figures;
  std::string facts = "facts", output = "reproduction";
  std::vector<std::string> settings;
  int threads = 0;
  bool check = false, quick = false, no_pictures = false;
};

/// Only the figures that are asked for, and the facts that are measured on their studies, be it among others. Throws
/// UsageError.
void keep_figures(FactBook& book, const std::vector<std::string>& asked) {
  if (asked.empty()) return;
  std::set<std::string> names_kept, studies;
  std::vector<Figure> figures;
  for (const std::string& name : asked) {
    const auto found =
        std::find_if(book.figures.begin(), book.figures.end(), [&](const Figure& f) { return f.name == name; });
    if (found == book.figures.end()) {
      std::string names;
      for (const Figure& figure : book.figures) names += (names.empty() ? "" : ", ") + figure.name;
      throw UsageError("FIGURE: " + name + ": there is no such figure; " +
                       (names.empty() ? book.source + " has none" : "there are " + names));
    }
    studies.insert(found->measure.table.study);
    if (names_kept.insert(name).second) figures.push_back(*found);
  }
  book.figures = figures;
  const auto is_not_shown = [&](const Fact& fact) {
    std::vector<TableName> tables;
    for (const FactMeasure& measure : fact.measures) collect_tables(measure.measure, tables);
    return std::none_of(tables.begin(), tables.end(), [&](const TableName& t) { return studies.count(t.study) > 0; });
  };
  book.facts.erase(std::remove_if(book.facts.begin(), book.facts.end(), is_not_shown), book.facts.end());
}

FactSuite load(const ReproduceCommandOptions& options) {
  try {
    FactSuite suite = load_fact_suite(find_facts(options.facts), find_scene);
    keep_figures(suite.book, options.figures);
    return suite;
  } catch (const SceneError& refusal) {
    throw UsageError(std::string("the facts or their studies are refused:\n") + refusal.what());
  }
}

/// The files that are to be written.
std::vector<NamedFile> outputs_of(const ReproduceCommandOptions& options, const FactSuite& suite) {
  const std::filesystem::path folder = options.output;
  std::vector<NamedFile> outputs;
  for (const char* name : {"ledger.md", "ledger.json", "figures.json"})
    outputs.push_back({"--output", (folder / name).string()});
  for (const Figure& figure : suite.book.figures)
    for (const char* ending : {".csv", ".svg", ".png"})
      outputs.push_back({"figure " + figure.name, (folder / (figure.name + ending)).string()});
  return outputs;
}

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder))
    throw UsageError("--output: " + folder + ": cannot be made a folder" + (error ? ": " + error.message() : ""));
}

void write(const std::filesystem::path& path, const std::string& text) {
  WholeFile file("--output", path.string());
  file.text() << text;
  file.finish();
}

/// Runs the studies. Throws std::runtime_error when a signal ended it.
Tables run(const FactSuite& suite, FactRunOptions& run_options, const InterruptGuard& interrupt) {
  ProgressBar bar(stdout_is_terminal());
  std::size_t done = 0, all = 1;
  run_options.progress = [&](std::size_t trials, std::size_t of) {
    done = trials;
    all = of;
  };
  run_options.go_on = [&] {
    bar.update(static_cast<double>(done) / static_cast<double>(all),
               [&] { return std::to_string(done) + " of " + counted(all, "trial"); });
    return interrupt.signal() == 0;
  };
  return run_fact_studies(suite, run_options);
}

/// Exit status of a run that a signal has ended, once it is told what there is not.
int interrupted(const InterruptGuard& interrupt, const char* missing) {
  std::fprintf(stderr, "align: interrupted; %s\n", missing);
  return 128 + interrupt.signal();
}

int run_command(const ReproduceCommandOptions& options) {
  const FactSuite suite = load(options);
  const std::vector<NamedFile> outputs = outputs_of(options, suite);
  refuse_overwriting(suite_inputs(suite), outputs);
  FactRunOptions run_options;
  run_options.settings.all = options.settings;
  if (options.quick) run_options.thinning = kQuick;
  run_options.threads = options.threads > 0 ? options.threads : usual_thread_count();
  const InterruptGuard interrupt;
  Tables tables;
  std::map<std::string, Study> studies;
  try {
    studies = studies_to_run(suite, run_options);
    for (const auto& [name, study] : studies) {
      refuse_settings_of_varied_keys(study, options.settings);
      refuse_without_scenes(study);
    }
    make_folder(options.output);
    for (const NamedFile& output : outputs) OutputPath("--output", output.path);  // refused before anything runs
    tables = run(suite, run_options, interrupt);
  } catch (const SceneError& refusal) {
    throw UsageError(refusal.what());
  } catch (const std::runtime_error&) {
    if (interrupt.signal() == 0) throw;
    return interrupted(interrupt, kNothingWritten);
  }
  const std::vector<FactResult> results = judge_all(suite.book, tables, kResamples);
  if (interrupt.signal() != 0) return interrupted(interrupt, kNothingWritten);
  const std::filesystem::path folder = options.output;
  write(folder / "ledger.md", ledger_markdown(suite.book, results));
  write(folder / "ledger.json", ledger_json(suite.book, results));
  if (!write_figure_files(folder, suite.book, studies, tables, [&] { return interrupt.signal() == 0; }))
    return interrupted(interrupt, "the ledger is written, not all figures are");
  // before the pictures, which may fail or be interrupted
  std::cout << ledger_text(suite.book, results) << "Files in " << folder.string() << std::endl;
  if (!std::cout) throw OutputError("stdout", "the ledger is lost");
  if (!options.no_pictures) {
    require_script("plot_figures.py", {path_word(folder.string())}, "pictures", interrupt);
    if (interrupt.signal() != 0) return interrupted(interrupt, "not all pictures are drawn");
  }

  const std::vector<std::string> missed = missed_unexpectedly(suite.book, results);
  if (!options.check || missed.empty()) return kExitRan;
  std::string list;
  for (const std::string& id : missed) list += " " + id;
  std::fprintf(stderr, "align: expected to be met, and missed:%s\n", list.c_str());
  return kExitFailed;
}

}  // namespace

std::function<int()> set_up_reproduce(CLI::App& app) {
  const auto options = std::make_shared<ReproduceCommandOptions>();
  app.footer(kReproduceFooter);
  app.add_option("FIGURE", options->figures, "Figures to make: fig2 ... fig8. Default: all, and all facts");
  app.add_flag("--check", options->check, "Fail if a fact that is expected to be met is missed");
  app.add_flag("--quick", options->quick, "A quick look: fewer points, fewer samples");
  app.add_flag("--no-pictures", options->no_pictures, "Write the data of the figures only");
  app.add_option("--output", options->output, "Folder for the files, made if it is not there.\nDefault: reproduction")
      ->check(file_name())
      ->type_name("DIR");
  app.add_option("--threads", options->threads, "Trials that run at a time. Default: one for each processor")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  app.add_option("--facts", options->facts, "Another facts file than the one that comes with the package")
      ->check(file_name())
      ->type_name("FILE");
  add_set_option(app, options->settings,
                 "Give keys of the scenes other values in all studies, as for\n`align trial`; can be repeated");
  return [options] { return run_command(*options); };
}

}  // namespace vibratory_alignment
