#include "study/fact_suite.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <system_error>

#include "model/scene_error.h"
#include "study/design.h"
#include "study/facts_file.h"
#include "study/sweep.h"
#include "study/touches.h"
#include "study/trial_table.h"

namespace vibratory_alignment {
namespace {

constexpr std::size_t kFewestSamples = 2;

/// Names of the studies that the book needs, for a measure or a picture.
std::set<std::string> studies_of(const FactBook& book) {
  std::set<std::string> names;
  for (const TableName& table : tables_of(book)) names.insert(table.study);
  for (const Figure& figure : book.figures) names.insert(figure.measure.table.study);
  return names;
}

/// The positions of a range that are kept: 0, step, 2 step ... and the last.
std::vector<std::size_t> kept_positions(std::size_t count, std::size_t step) {
  std::vector<std::size_t> positions;
  for (std::size_t i = 0; i < count; i += step) positions.push_back(i);
  if (positions.back() != count - 1) positions.push_back(count - 1);
  return positions;
}

/// Trials between two neighbouring values of dimension `d`.
std::size_t stride_of(const Study& study, std::size_t d) {
  std::size_t stride = study.samples ? study.samples->count : 1;
  for (std::size_t k = d + 1; k < study.dimensions.size(); ++k)
    if (!study.dimensions[k].sampled()) stride *= study.dimensions[k].count;
  return stride;
}

/// Place of the first key of dimension `d` among the varied values.
std::size_t first_key(const Study& study, std::size_t d) {
  std::size_t place = 0;
  for (std::size_t k = 0; k < d; ++k) place += study.dimensions[k].keys.size();
  return place;
}

}  // namespace

FactSuite load_fact_suite(const std::string& facts_file, const FindScene& find_scene) {
  FactSuite suite;
  suite.book = load_facts(facts_file);
  const std::filesystem::path folder = std::filesystem::path(facts_file).parent_path() / suite.book.study_folder;
  Tables columns;
  for (const std::string& name : studies_of(suite.book)) {
    const std::string file = (folder / (name + ".yaml")).lexically_normal().string();
    if (std::error_code ignored; !std::filesystem::exists(file, ignored))
      throw SceneError(facts_file, {"study: " + name + ": there is no file " + file});
    const Study study = load_study(file, find_scene);
    columns[{name, false}] = TrialTable(study).table();
    columns[{name, true}] = touch_columns(study);
    suite.studies[name] = study;
  }
  const std::vector<std::string> faults = faults_of_formulas(suite.book, columns);
  if (!faults.empty()) throw SceneError(facts_file, faults);
  return suite;
}

Study thinned(const Study& study, const Thinning& thinning) {
  Study thin = study;
  for (std::size_t d = 0; d < study.dimensions.size(); ++d) {
    Dimension& dimension = thin.dimensions[d];
    const bool has_list = std::any_of(dimension.keys.begin(), dimension.keys.end(),
                                      [](const auto& key) { return !key.values.empty(); });
    if (dimension.sampled() || has_list || thinning.grid <= 1) continue;
    const std::vector<std::size_t> positions = kept_positions(dimension.count, thinning.grid);
    for (std::size_t k = 0; k < dimension.keys.size(); ++k)
      for (const std::size_t position : positions)
        dimension.keys[k].values.push_back(
            values_at(study, position * stride_of(study, d))[first_key(study, d) + k].text);
    dimension.count = positions.size();
  }
  if (thin.samples)
    thin.samples->count =
        std::min(thin.samples->count, std::max(kFewestSamples, thin.samples->count / thinning.samples));
  return thin;
}

std::map<std::string, Study> studies_to_run(const FactSuite& suite, const FactRunOptions& options) {
  std::map<std::string, Study> studies;
  for (const std::string& name : studies_of(suite.book)) {
    std::vector<std::string> settings = options.settings.all;
    const auto own = options.settings.of_study.find(name);
    if (own != options.settings.of_study.end()) settings.insert(settings.end(), own->second.begin(), own->second.end());
    studies[name] = thinned(with_settings(suite.studies.at(name), settings), options.thinning);
  }
  return studies;
}

Tables run_fact_studies(const FactSuite& suite, const FactRunOptions& options) {
  const std::map<std::string, Study> studies = studies_to_run(suite, options);
  const std::vector<TableName> wanted = tables_of(suite.book);
  std::size_t all = 0, done = 0;
  for (const TableName& name : wanted) all += trial_count(studies.at(name.study));
  const auto count = [&](std::size_t trials) {
    done += trials;
    if (options.progress) options.progress(done, all);
  };
  Tables tables;
  for (const TableName& name : wanted) {
    const Study& study = studies.at(name.study);
    if (name.touches) {
      tables[name] = touch_table(study, options.go_on);
      count(trial_count(study));
      continue;
    }
    TrialTable table(study);
    SweepOptions sweep;
    sweep.threads = options.threads;
    sweep.go_on = options.go_on;
    const bool whole = run_sweep(study, sweep, [&](const TrialRow& row) {
      table.add(row);
      count(1);
    });
    if (!whole) throw std::runtime_error("interrupted");
    tables[name] = table.table();
  }
  return tables;
}

std::vector<FactResult> judge_all(const FactBook& book, const Tables& tables, int resamples) {
  std::vector<FactResult> results;
  results.reserve(book.facts.size());
  for (const Fact& fact : book.facts) results.push_back(judge(fact, tables, resamples));
  return results;
}

std::vector<FactResult> evaluate_facts(const FactSuite& suite, const FactRunOptions& options) {
  return judge_all(suite.book, run_fact_studies(suite, options));
}

}  // namespace vibratory_alignment
