// Formulas over the columns of a table, as a facts file has them: "aligned && last_impact_a1 < 0.5 * end_time".
// muParser's language: + - * / ^, comparisons, && || and ?:, functions such as abs, min, max, sin, cos.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "study/table.h"

namespace vibratory_alignment {

/// what() quotes the formula and says what is wrong with it, and where.
class FormulaError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The value of the formula in each row. Of NaN, arithmetic is NaN; the comparisons <, <=, ==, >=, > are false, != is
/// true; &&, || and ?: take it for true, and min and max may pass over it.
/// Throws FormulaError when it is not a formula, or asks for a column that the table does not have.
std::vector<double> evaluate_formula(const std::string& formula, const Table& table);

/// The columns that the formula asks for, sorted. Throws FormulaError when it is not a formula.
std::vector<std::string> names_in_formula(const std::string& formula);

}  // namespace vibratory_alignment
