// The rows of a study as a table of numbers, for formulas.
//
// Columns: index, sample (number of the sample at its point); the varied values under their key paths (of an offset:
// key.path_offset; words are NaN); refused, failed, stalled, aligned (it did at some time), and the modes impact,
// nonimpact, mixed as 0 or 1; and the numbers of row_numbers.h.
#pragma once

#include <cstddef>

#include "study/study.h"
#include "study/table.h"
#include "study/trial_row.h"

namespace vibratory_alignment {

class TrialTable {
 public:
  explicit TrialTable(const Study& study);

  void add(const TrialRow& row);

  const Table& table() const { return table_; }

 private:
  Study study_;
  Table table_;
};

/// The columns that say which trial a row belongs to: index, sample and the varied values.
std::vector<std::string> trial_columns(const Study& study);
std::vector<double> trial_values(const Study& study, std::size_t index);

}  // namespace vibratory_alignment
