// Facts with the studies that they are measured on: runs the studies, with further settings if asked for, and judges
// the facts.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "study/facts.h"
#include "study/study.h"
#include "study/study_file.h"

namespace vibratory_alignment {

struct FactSuite {
  FactBook book;
  std::map<std::string, Study> studies;  ///< those that the book names, by name
};

/// Reads a facts file and the studies that it names, NAME.yaml in the folder that it says.
/// Throws SceneError with every fault of a file, also for formulas that ask for columns that a study has not.
FactSuite load_fact_suite(const std::string& facts_file, const FindScene& find_scene);

/// Further settings, "key.path=value": of all studies, and of single ones, by name; the latter come last.
struct FactSettings {
  std::vector<std::string> all;
  std::map<std::string, std::vector<std::string>> of_study;
};

/// How much to run. Both thin studies out for a quick look; 1: as their files say.
struct Thinning {
  std::size_t samples = 1;  ///< the samples of every point are divided by this (at least 2 are left)
  /// Of the values of a range only every so many-th is kept, and the last; lists stay, and ranges beside one.
  std::size_t grid = 1;
};

Study thinned(const Study& study, const Thinning& thinning);

struct FactRunOptions {
  FactSettings settings;
  Thinning thinning;
  int threads = 1;  ///< of the sweeps; tables of touches are made by one
  /// Told after each trial how many of all are done; asked some twenty times a second whether to go on.
  std::function<void(std::size_t done, std::size_t all)> progress;
  std::function<bool()> go_on;
};

/// The studies with settings and thinning, as run_fact_studies runs them. Throws SceneError.
std::map<std::string, Study> studies_to_run(const FactSuite& suite, const FactRunOptions& options);

/// Runs the studies of which the book of the suite needs a table (take facts out of the book to run less). Throws
/// SceneError, and std::runtime_error when `go_on` ended it.
Tables run_fact_studies(const FactSuite& suite, const FactRunOptions& options);

/// Judges all facts of the book; `resamples` as of read_measure. Throws like judge().
std::vector<FactResult> judge_all(const FactBook& book, const Tables& tables, int resamples = 0);

/// run_fact_studies + judge_all without resamples. Deterministic, whatever the threads.
std::vector<FactResult> evaluate_facts(const FactSuite& suite, const FactRunOptions& options);

}  // namespace vibratory_alignment
