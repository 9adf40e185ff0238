// Results of a study as a plain table of numbers: one row a trial (or a touch), one column a quantity.
// What does not apply to a row is NaN there (the duration of a trial that did not align).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace vibratory_alignment {

struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;  ///< columns[i] belongs to names[i]; all of the same length

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }

  /// Null when there is no such column.
  const std::vector<double>* find(const std::string& name) const {
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] == name) return &columns[i];
    return nullptr;
  }
};

}  // namespace vibratory_alignment
