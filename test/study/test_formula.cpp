// Formulas over columns.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "study/formula.h"
#include "study/metrics.h"

namespace vibratory_alignment {
namespace {

const Table kTable = {{"aligned", "duration", "gripper.stiffness.phi"}, {{1.0, 0.0}, {4.0, kNone}, {60.0, 10.0}}};

TEST(Formula, is_evaluated_row_by_row) {
  EXPECT_EQ(evaluate_formula("gripper.stiffness.phi / 2 + 1", kTable), (std::vector<double>{31.0, 6.0}));
}

TEST(Formula, compares_and_combines) {
  EXPECT_EQ(evaluate_formula("aligned && gripper.stiffness.phi >= 60", kTable), (std::vector<double>{1.0, 0.0}));
  EXPECT_EQ(evaluate_formula("gripper.stiffness.phi < 20 || duration < 5", kTable), (std::vector<double>{1.0, 1.0}));
}

TEST(Formula, finds_no_comparison_with_nothing_true) {
  EXPECT_EQ(evaluate_formula("duration < 100", kTable)[1], 0.0);
  EXPECT_EQ(evaluate_formula("duration >= 0", kTable)[1], 0.0);
  EXPECT_TRUE(std::isnan(evaluate_formula("1 + 0 * duration", kTable)[1]));
}

TEST(Formula, is_refused_with_its_fault) {
  for (const char* formula : {"", "duration +", "duraton > 1", "duration > > 1", "(1"}) {
    try {
      evaluate_formula(formula, kTable);
      ADD_FAILURE() << formula;
    } catch (const FormulaError& error) {
      EXPECT_EQ(std::string(error.what()).find(formula), 0U) << error.what();
    }
  }
}

TEST(Formula, is_refused_on_a_table_without_rows) {
  const Table empty = {{"duration"}, {{}}};
  EXPECT_TRUE(evaluate_formula("duration > 1", empty).empty());
  EXPECT_THROW(evaluate_formula("duraton > 1", empty), FormulaError);
}

}  // namespace
}  // namespace vibratory_alignment
