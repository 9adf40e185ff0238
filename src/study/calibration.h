// Calibration: the search for values that the paper leaves out, such that a trial of its figures shows what it says.
//
// A set is a value for every parameter. Its settings go into the studies that the facts are measured on; its shortfall
// is the sum over the facts of s/(1 + s), s a fact's own (facts.h): 0 when all are met, less than one a fact, so that
// no fact that is far out of reach is bought with those that are near. Every reading of the paper is searched, with
// several seeds each: first all ranges at once, by a controlled random search (NLopt's CRS2 with local mutation). The
// searches with the best sets go on, in rounds that look around the best set so far, nearer and nearer and on fuller
// studies. A round takes the values of all studies first, then for each figure its own: those ask only for that
// figure's studies, which is what makes a round cheap. Values of all studies that are better only with other values of
// the figures are found by a round that adapts these to each candidate. At last a subspace simplex search (NLopt's
// Sbplx) over all values. What a study's samples leave of noise is in the shortfall as well, so derivatives would be of
// no use. The best sets of all searches are judged on the whole studies.
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
  double start = 0.0;  ///< in the range; in the first set of every search, but for readings that say otherwise

  /// share 0 ... 1 of the range; to four digits, so that what is written down of a set is what was judged.
  double value_at(double share) const;
  double share_of(double value) const;
};

/// Key path of the scene and a formula of the parameters (formula.h), by study; those of "all" come first. An empty
/// formula takes the key out.
using CalibrationSettings = std::map<std::string, std::vector<std::pair<std::string, std::string>>>;

/// One way to read what the paper says of its model; searched on its own.
struct CalibrationReading {
  std::string name;
  CalibrationSettings settings;  ///< come after those of the calibration
  std::vector<double> start;     ///< the first set of its searches, in the order of the parameters
};

/// How the values of each group of studies are adapted to a candidate for those that all studies have in common.
struct CalibrationAdaptation {
  double reach = 0.0;           ///< to both sides of those of the best set, as a share of the ranges
  std::size_t evaluations = 0;  ///< of each group, the best set's own values first
  double room = 0.0;            ///< how much more than the best set a candidate may fall short on its way
};

/// A look around the best set so far.
struct CalibrationRound {
  std::size_t searches = 1;  ///< that go on to it, those that have found most; no more than in the round before
  double reach = 0.0;        ///< to both sides of the best set, as a share of the ranges
  std::size_t shared_evaluations = 0;               ///< of the values that all studies have in common
  std::optional<CalibrationAdaptation> adaptation;  ///< to each of these; without, those of the best set are held
  std::size_t own_evaluations = 0;                  ///< of those of each group of studies that has values of its own
  Thinning thinning;                                ///< of the studies
};

struct CalibrationSearch {
  std::size_t searches = 2;  ///< for each reading, seeds 1 and on
  std::size_t population = 100;
  std::size_t global_evaluations = 1000;
  Thinning thinning;  ///< of the studies at first
  std::vector<CalibrationRound> rounds;
  std::size_t local_evaluations = 500;  ///< after the last round, of the searches in it, with its thinning
  std::size_t finalists = 2;            ///< sets that are judged on the whole studies
  std::vector<std::string> leave_out;   ///< facts that only the finalists are judged by
};

/// Plain data, read by calibration_file.h.
struct Calibration {
  std::string source;
  std::string text;  ///< of the file, without comments
  std::string facts_file;
  std::vector<CalibrationParameter> parameters;
  CalibrationSettings settings;
  std::vector<CalibrationReading> readings;
  CalibrationSearch search;
};

/// The settings of a set: `values` in the order of the parameters. Throws FormulaError.
FactSettings settings_of(const Calibration& calibration, const CalibrationReading& reading,
                         const std::vector<double>& values);

/// What came out when a set was looked at.
struct CalibrationAnswer {
  struct Part {
    double shortfall = 0.0;
    std::size_t met = 0;  ///< facts
  };
  std::vector<Part> parts;  ///< fewer than were asked for when the set was given up
  std::size_t trials = 0;
  double shortfall() const;
};

/// Which set of which search: the first has number 0.
struct CalibrationPlace {
  std::size_t reading = 0, seed = 0, number = 0;
  bool operator<(const CalibrationPlace& other) const;
};

struct CalibratedSet {
  std::size_t reading = 0, seed = 0;
  std::size_t rounds = 0;  ///< that its search went through
  std::vector<double> values;
  double shortfall = 0.0;           ///< on the studies as thinned out at its search's end
  std::vector<FactResult> results;  ///< on the whole studies; only of finalists
  std::size_t met() const;
};

struct CalibrationProgress {
  std::size_t evaluations = 0, trials = 0;
  double best_shortfall = 0.0;
  std::size_t best_met = 0;
};

struct CalibrationResult {
  FactBook book;  ///< the facts that the results of the finalists belong to
  /// Of every search: first the finalists, those that meet most first; the others by rounds and shortfall.
  std::vector<CalibratedSet> best;
  std::size_t evaluations = 0, trials = 0;
  std::vector<std::size_t> sets_that_meet;  ///< [n]: sets, of those that were looked at whole, that meet n facts
};

struct CalibrationOptions {
  int threads = 1;  ///< searches that run at the same time
  FindScene find_scene;
  /// The following are called by one thread at a time.
  std::function<void(const CalibrationProgress&)> progress;  ///< after each evaluation
  std::function<bool()> go_on;
  /// An answer that is known from an earlier run of the same calibration; it is not asked for again.
  std::function<std::optional<CalibrationAnswer>(const CalibrationPlace&, const std::vector<double>& values)> known;
  /// Told every answer that was not known.
  std::function<void(const CalibrationPlace&, const std::vector<double>& values, const CalibrationAnswer&)> keep;
};

/// The same for calibrations that ask the same in the same order: of this file, the facts file, the studies that it
/// names, their scenes and `version`, that of this package. Throws SceneError as run_calibration.
std::string fingerprint(const Calibration& calibration, const FindScene& find_scene, const std::string& version);

/// Throws SceneError for facts, studies, keys and formulas that there are not, and where all trials of a study are
/// refused with the values that a reading starts with: the search would run in vain.
void check_calibration(const Calibration& calibration, const FactSuite& suite);

/// Of a calibration that check_calibration() takes. Deterministic, whatever the threads. Throws SceneError for a facts
/// file or study that is refused or a setting that no scene takes, FormulaError, and std::runtime_error when `go_on`
/// ended it.
CalibrationResult run_calibration(const Calibration& calibration, const CalibrationOptions& options);

}  // namespace vibratory_alignment
