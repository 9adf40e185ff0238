#include "study/formula.h"

#include <muParser.h>

namespace vibratory_alignment {
namespace {

/// Columns are named by key paths ("gripper.stiffness.phi"), so that a dot belongs to a name.
constexpr char kNameCharacters[] = "0123456789_.abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";

}  // namespace

std::vector<double> evaluate_formula(const std::string& formula, const Table& table) {
  std::vector<double> row(table.names.size());
  std::vector<double> values(table.rows());
  try {
    mu::Parser parser;
    parser.DefineNameChars(kNameCharacters);
    for (std::size_t i = 0; i < row.size(); ++i) parser.DefineVar(table.names[i], &row[i]);
    parser.SetExpr(formula);
    parser.Eval();  // parses it, so that it is refused even where there are no rows
    for (std::size_t r = 0; r < values.size(); ++r) {
      for (std::size_t i = 0; i < row.size(); ++i) row[i] = table.columns[i][r];
      values[r] = parser.Eval();
    }
  } catch (const mu::ParserError& error) {
    throw FormulaError(formula + ": " + error.GetMsg());
  }
  return values;
}

std::vector<std::string> names_in_formula(const std::string& formula) {
  std::vector<std::string> names;
  try {
    mu::Parser parser;
    parser.DefineNameChars(kNameCharacters);
    parser.SetExpr(formula);
    for (const auto& [name, place] : parser.GetUsedVar()) names.push_back(name);  // a sorted map
  } catch (const mu::ParserError& error) {
    throw FormulaError(formula + ": " + error.GetMsg());
  }
  return names;
}

}  // namespace vibratory_alignment
