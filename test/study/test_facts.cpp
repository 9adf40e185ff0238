// Judging facts: bounds, shortfall, several measures.
#include <gtest/gtest.h>

#include <cmath>

#include "study/facts.h"
#include "study/formula.h"
#include "study/metrics.h"

namespace vibratory_alignment {
namespace {

Reading reading(double value, double coverage = 1.0) { return {value, coverage, kNone, kNone}; }

TEST(Shortfall, is_zero_within_the_bounds) {
  const Bound between = {1.0, 2.0, 0.5};
  EXPECT_EQ(shortfall(reading(1.0), between), 0.0);
  EXPECT_EQ(shortfall(reading(2.0), between), 0.0);
  EXPECT_EQ(shortfall(reading(7.0), {1.0, {}, 0.5}), 0.0);
  EXPECT_EQ(shortfall(reading(-7.0), {{}, 1.0, 0.5}), 0.0);
}

TEST(Shortfall, is_the_distance_in_units_of_the_scale) {
  const Bound between = {1.0, 2.0, 0.5};
  EXPECT_DOUBLE_EQ(shortfall(reading(0.9), between), 0.2);
  EXPECT_DOUBLE_EQ(shortfall(reading(2.5), between), 1.0);
}

// 2 - 1/s goes on from s = 1 with the same value and slope.
TEST(Shortfall, is_bounded_and_rises_all_the_way) {
  const Bound bound = {{}, 0.0, 1.0};
  EXPECT_DOUBLE_EQ(shortfall(reading(2.0), bound), 1.5);
  double before = 0.0;
  for (double value = 0.01; value < 100.0; value *= 1.1) {
    const double now = shortfall(reading(value), bound);
    EXPECT_GT(now, before);
    EXPECT_LT(now, 2.0);
    before = now;
  }
  EXPECT_NEAR(shortfall(reading(1.0 + 1e-9), bound) - shortfall(reading(1.0 - 1e-9), bound), 2e-9, 1e-12);
}

TEST(Shortfall, of_nothing_is_more_than_of_any_value) {
  EXPECT_EQ(shortfall(reading(kNone, 1.0), {1.0, {}, 1.0}), 2.0);
  EXPECT_EQ(shortfall(reading(kNone, 0.25), {1.0, {}, 1.0}), 2.75);
  EXPECT_EQ(shortfall(reading(kNone, 0.0), {1.0, {}, 1.0}), 3.0);
}

Fact fact_of(const std::vector<std::pair<std::string, Bound>>& formulas) {
  Fact fact;
  fact.id = "F1";
  for (const auto& [formula, bound] : formulas) {
    FactMeasure measure;
    measure.name = formula;
    measure.bound = bound;
    measure.measure.table.study = "study";
    measure.measure.of = formula;
    measure.measure.rows.take = RowStatistic::mean;
    fact.measures.push_back(measure);
  }
  return fact;
}

const Tables kTables = {{{"study", false}, {{"a"}, {{1.0, 3.0}}}}};

TEST(Judge, asks_for_all_measures) {
  const Bound at_least_two = {2.0, {}, 4.0};
  const FactResult met = judge(fact_of({{"a", at_least_two}, {"2 * a", at_least_two}}), kTables);
  EXPECT_TRUE(met.met);
  EXPECT_EQ(met.shortfall, 0.0);
  const FactResult missed = judge(fact_of({{"a", at_least_two}, {"a / 2", at_least_two}}), kTables);
  EXPECT_FALSE(missed.met);
  EXPECT_TRUE(missed.measures[0].met);
  EXPECT_FALSE(missed.measures[1].met);
  EXPECT_EQ(missed.measures[1].reading.value, 1.0);
  EXPECT_EQ(missed.shortfall, 0.125);
}

TEST(Judge, names_the_fact_in_its_faults) {
  try {
    judge(fact_of({{"b", {2.0, {}, 1.0}}}), kTables);
    ADD_FAILURE();
  } catch (const FormulaError& error) {
    EXPECT_EQ(std::string(error.what()).find("fact F1: b: "), 0U) << error.what();
  }
}

// Three of the four trials at the one point hold; of those whose mark is a number two, and one of these is not 0.
TEST(MarksOf, are_the_shares_of_trials_for_which_the_mark_holds) {
  Figure figure;
  figure.kind = Figure::Kind::curves;
  figure.measure.kind = Measure::Kind::curves;
  figure.measure.table = {"study", false};
  figure.measure.of = "a";
  figure.measure.curves.along = "x";
  const Tables tables = {
      {{"study", false}, {{"sample", "x", "a", "b"}, {{0, 1, 2, 3}, {7, 7, 7, 7}, {1, 2, 3, 4}, {5, NAN, 0, NAN}}}}};
  for (const auto& [mark, share] : {std::pair{"a > 1", 0.75}, {"b", 0.25}}) {
    figure.mark = mark;
    const std::vector<Curve> marks = curves_of(marks_of(figure), tables);
    ASSERT_EQ(marks.size(), 1U);
    ASSERT_EQ(marks[0].points.size(), 1U);
    EXPECT_EQ(marks[0].points[0].at, 7.0);
    EXPECT_EQ(marks[0].points[0].value, share);
  }
}

TEST(TablesOf, names_each_once) {
  FactBook book;
  book.facts = {fact_of({{"a", {}}, {"b", {}}}), fact_of({{"c", {}}})};
  book.facts[1].measures[0].measure.table = {"other", true};
  Figure figure;
  figure.kind = Figure::Kind::curves;
  figure.measure.table = {"third", false};
  book.figures = {figure};
  const std::vector<TableName> names = tables_of(book);
  ASSERT_EQ(names.size(), 3U);
  EXPECT_EQ(names[0].study, "other");
  EXPECT_TRUE(names[0].touches);
  EXPECT_EQ(names[1].study, "study");
  EXPECT_EQ(names[2].study, "third");
}

}  // namespace
}  // namespace vibratory_alignment
