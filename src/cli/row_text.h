// Rows of a study as lines of a CSV file.
#pragma once

#include <string>
#include <vector>

#include "study/design.h"
#include "study/trial_row.h"

namespace vibratory_alignment {

/// Text as a cell: with quotation marks where it has a comma or such a mark.
std::string csv_cell(const std::string& text);

/// The names of the columns (docs/studies.md), without line end.
std::string row_header(const std::vector<std::string>& varied);

/// The row without line end; results have 17 digits, which give back the same double, or are empty where there are
/// none.
std::string row_text(const TrialRow& row, const std::vector<VariedValue>& values);

/// The cells of a line, without their quotation marks.
std::vector<std::string> cells_of(const std::string& line);

}  // namespace vibratory_alignment
