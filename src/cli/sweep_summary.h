// The result of a sweep for people: how many trials ended how, and how long alignments took.
#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace vibratory_alignment {

/// Takes the same memory for any number of trials: of more than a hundred thousand that aligned, durations are counted
/// in classes of 0.01 %.
class SweepSummary {
 public:
  /// `duration`: not a number unless the part aligned. `reason`: of a refused or failed trial.
  void add(std::size_t trial, const std::string& outcome, double duration, const std::string& reason);

  std::size_t trials() const { return trials_; }

  /// "aligned 97 %, refused 1 %", the most frequent first.
  std::string short_text() const;

  /// Several lines: a table of the outcomes, the first reason of each that has one, and least, greatest and quartiles
  /// of the durations, with the digits that are known.
  std::string text() const;

 private:
  struct Outcomes {
    std::size_t count = 0, first_trial = 0;
    std::string first_reason;
  };

  void count(double duration);
  double quantile_of_classes(double share) const;
  std::string quartile(double share) const;
  std::string share_of_all(std::size_t count, const char* pattern) const;

  std::size_t trials_ = 0, aligned_ = 0;
  std::map<std::string, Outcomes> outcomes_;
  std::vector<double> durations_;        ///< all of them, unless there are too many
  std::map<long, std::size_t> classes_;  ///< how many lie in class n: from e^(n/10000) on; empty unless there are
  double least_ = std::numeric_limits<double>::infinity(), greatest_ = 0.0;
};

}  // namespace vibratory_alignment
