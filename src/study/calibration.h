// Calibration: the search for values that the paper leaves out, such that a trial of its figures shows what it says.
//
// A set is a value for every parameter. Its settings go into the studies that the facts are measured on; its shortfall
// is the sum of the facts' (facts.h), 0 when all are met. Searched is in two stages, for every reading of the paper and
// several seeds each: a controlled random search over all ranges (NLopt's CRS2 with local mutation), then a subspace
// simplex search (NLopt's Sbplx) from its best set. What a study's samples leave of noise is in the shortfall as well,
// so derivatives would be of no use. The best sets of all searches are judged at last on the studies as a whole.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "study/fact_suite.h"

namespace vibratory_alignment {

/// A value that is searched for.
struct CalibrationParameter {
  std::string name;
  double from = 0.0, to = 0.0;
  bool logarithmic = false;
  double start = 0.0;  ///< in the range; the first set of every search

  double value_at(double share) const;  ///< share 0 ... 1 of the range
  double share_of(double value) const;
};

/// Key path of the scene and a formula of the parameters (formula.h), by study; those of "all" come first.
using CalibrationSettings = std::map<std::string, std::vector<std::pair<std::string, std::string>>>;

/// One way to read what the paper says of its model; searched on its own.
struct CalibrationReading {
  std::string name;
  CalibrationSettings settings;  ///< come after those of the calibration
};

struct CalibrationSearch {
  std::size_t searches = 2;  ///< for each reading, seeds 1 and on
  std::size_t population = 100;
  std::size_t global_evaluations = 1000;
  std::size_t local_evaluations = 500;
  std::size_t finalists = 4;           ///< sets that are judged on the whole studies
  Thinning thinning;                   ///< of the studies during the search
  std::vector<std::string> leave_out;  ///< facts that only the finalists are judged by
};

/// Plain data, read by calibration_file.h.
struct Calibration {
  std::string source;
  std::string facts_file;
  std::vector<CalibrationParameter> parameters;
  CalibrationSettings settings;
  std::vector<CalibrationReading> readings;
  CalibrationSearch search;
};

/// The settings of a set: `values` in the order of the parameters. Throws FormulaError.
FactSettings settings_of(const Calibration& calibration, const CalibrationReading& reading,
                         const std::vector<double>& values);

struct CalibratedSet {
  std::size_t reading = 0, seed = 0;
  std::vector<double> values;
  double shortfall = 0.0;           ///< on the thinned studies
  std::vector<FactResult> results;  ///< on the whole studies; only of finalists
  std::size_t met() const;
};

struct CalibrationProgress {
  std::size_t evaluations = 0, all_evaluations = 0, trials = 0;
  double best_shortfall = 0.0;
  std::size_t best_met = 0;
};

struct CalibrationResult {
  FactBook book;                    ///< the facts that the results of the finalists belong to
  std::vector<CalibratedSet> best;  ///< of every search, the least shortfall first; the finalists have results
  std::size_t evaluations = 0, trials = 0;
  std::vector<std::size_t> sets_that_meet;  ///< [n]: sets, of those that were looked at whole, that meet n facts
};

struct CalibrationOptions {
  int threads = 1;  ///< searches that run at the same time
  FindScene find_scene;
  std::function<void(const CalibrationProgress&)> progress;  ///< told after each evaluation, by one thread at a time
  std::function<bool()> go_on;
};

/// Deterministic, whatever the threads. Throws SceneError for a facts file or study that is refused or a setting that
/// no scene takes, FormulaError, and std::runtime_error when `go_on` ended it.
CalibrationResult run_calibration(const Calibration& calibration, const CalibrationOptions& options);

}  // namespace vibratory_alignment
