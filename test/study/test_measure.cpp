// Measures on small tables whose answers can be counted.
#include <gtest/gtest.h>

#include <cmath>

#include "study/measure.h"

namespace vibratory_alignment {
namespace {

// f0 = 1, 2, 3 at x = 0 and 1, four samples each. Durations: at x = 0 about 10, 20, 30 (the last aligns in 3 of 4);
// at x = 1 about 11, 22 and nothing.
Tables durations() {
  Table table;
  table.names = {"f0", "x", "sample", "duration"};
  table.columns.resize(4);
  const auto add = [&](double f0, double x, const std::vector<double>& values) {
    for (std::size_t s = 0; s < values.size(); ++s) {
      const double row[] = {f0, x, static_cast<double>(s), values[s]};
      for (std::size_t i = 0; i < 4; ++i) table.columns[i].push_back(row[i]);
    }
  };
  add(1.0, 0.0, {9.0, 10.0, 10.0, 50.0});
  add(2.0, 0.0, {20.0, 20.0, 19.0, 21.0});
  add(3.0, 0.0, {30.0, kNone, 29.0, 31.0});
  add(1.0, 1.0, {11.0, 11.0, 11.0, 11.0});
  add(2.0, 1.0, {22.0, 22.0, 22.0, 22.0});
  add(3.0, 1.0, {kNone, kNone, 33.0, kNone});
  return {{{"study", false}, table}};
}

Measure curves(CurveNumber take, CurveJoin over = CurveJoin::mean) {
  Measure measure;
  measure.kind = Measure::Kind::curves;
  measure.table = {"study", false};
  measure.of = "duration";
  measure.curves.along = "f0";
  measure.curves.each = {"x"};
  measure.curves.take = take;
  measure.curves.over = over;
  return measure;
}

Measure rows(RowStatistic take, const std::string& of, const std::string& where = "") {
  Measure measure;
  measure.table = {"study", false};
  measure.of = of;
  measure.where = where;
  measure.rows.take = take;
  return measure;
}

TEST(Curves, are_medians_of_points_that_are_reached_often_enough) {
  Measure measure = curves(CurveNumber::mean);
  measure.curves.share = 0.75;
  const std::vector<Curve> found = curves_of(measure, durations());
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].each, std::vector<double>{0.0});
  ASSERT_EQ(found[0].points.size(), 3U);
  EXPECT_EQ(found[0].points[0].value, 10.0);
  EXPECT_EQ(found[0].points[0].low, 9.75);
  EXPECT_EQ(found[0].points[0].high, 20.0);
  EXPECT_EQ(found[0].points[2].value, 30.0);
  EXPECT_EQ(found[0].points[2].share, 0.75);
  EXPECT_EQ(found[1].points[1].value, 22.0);
  EXPECT_TRUE(std::isnan(found[1].points[2].value));
  measure.curves.share = 0.8;
  EXPECT_TRUE(std::isnan(curves_of(measure, durations())[0].points[2].value));
}

TEST(Curves, are_joined) {
  // 10, 20 and 11, 22
  EXPECT_EQ(read_measure(curves(CurveNumber::max, CurveJoin::min), durations()).value, 20.0);
  EXPECT_EQ(read_measure(curves(CurveNumber::max, CurveJoin::max), durations()).value, 22.0);
  EXPECT_EQ(read_measure(curves(CurveNumber::max, CurveJoin::mean), durations()).value, 21.0);
  EXPECT_EQ(read_measure(curves(CurveNumber::max, CurveJoin::median), durations()).value, 21.0);
  EXPECT_EQ(read_measure(curves(CurveNumber::max, CurveJoin::spread), durations()).value, 2.0);
}

TEST(Curves, give_each_number) {
  EXPECT_EQ(read_measure(curves(CurveNumber::min, CurveJoin::min), durations()).value, 10.0);
  EXPECT_EQ(read_measure(curves(CurveNumber::mean, CurveJoin::min), durations()).value, 15.0);
  EXPECT_EQ(read_measure(curves(CurveNumber::argmax), durations()).value, 2.0);
  EXPECT_EQ(read_measure(curves(CurveNumber::argmin), durations()).value, 1.0);
  EXPECT_EQ(read_measure(curves(CurveNumber::spread, CurveJoin::max), durations()).value, 11.0);
  EXPECT_DOUBLE_EQ(read_measure(curves(CurveNumber::relative_spread), durations()).value, 2.0 / 3.0);
  EXPECT_EQ(read_measure(curves(CurveNumber::rank_correlation), durations()).value, 1.0);
  Measure at = curves(CurveNumber::at, CurveJoin::min);
  at.curves.at = 1.5;
  EXPECT_EQ(read_measure(at, durations()).value, 15.0);
  Measure line = curves(CurveNumber::r_squared);
  line.curves.share = 0.75;
  line.where = "x == 0";
  EXPECT_DOUBLE_EQ(read_measure(line, durations()).value, 1.0);
}

TEST(Curves, show_shares_as_means_of_conditions) {
  Measure measure = curves(CurveNumber::width, CurveJoin::max);
  measure.of = "duration > 0";
  measure.curves.point = PointStatistic::mean;
  measure.curves.threshold = 0.875;
  // at x = 0 the shares are 1, 1, 0.75: the line falls to 0.875 half way
  EXPECT_DOUBLE_EQ(read_measure(measure, durations()).value, 1.5);
}

TEST(Curves, with_too_few_points_have_no_number) {
  Measure measure = curves(CurveNumber::mean);
  measure.curves.filled = 0.7;
  const Reading reading = read_measure(measure, durations());
  EXPECT_TRUE(std::isnan(reading.value));
  // points reached to 1, 1, 0.75 / 0.8 and 1, 1, 0.25 / 0.8
  EXPECT_DOUBLE_EQ(reading.coverage, (4.0 + 0.75 / 0.8 + 0.25 / 0.8) / 6.0);
}

TEST(Curves, without_a_point_are_left_out_on_request) {
  Measure measure = curves(CurveNumber::mean);
  measure.where = "f0 == 3";
  EXPECT_TRUE(std::isnan(read_measure(measure, durations()).value));
  measure.curves.share = 0.75;
  EXPECT_TRUE(std::isnan(read_measure(measure, durations()).value));
  measure.curves.filled = 0.0;
  EXPECT_EQ(read_measure(measure, durations()).value, 30.0);
}

TEST(Curves, are_cut_to_a_range) {
  Measure measure = curves(CurveNumber::max, CurveJoin::max);
  measure.curves.within = {0.0, 1.0};
  EXPECT_EQ(read_measure(measure, durations()).value, 11.0);
  measure.curves.within = {1.0, 2.0 - 1e-12};  // a grid's 2 may miss the 2 of the file by roundoff
  EXPECT_EQ(read_measure(measure, durations()).value, 22.0);
  measure = curves(CurveNumber::min, CurveJoin::min);
  measure.curves.within = {1.0 + 1e-12, 2.0};
  EXPECT_EQ(read_measure(measure, durations()).value, 10.0);
}

TEST(Curves, along_the_other_value) {
  Measure measure = curves(CurveNumber::rank_correlation, CurveJoin::min);
  measure.curves.along = "x";
  measure.curves.each = {"f0"};
  measure.where = "f0 < 3";
  EXPECT_EQ(read_measure(measure, durations()).value, 1.0);
}

TEST(Rows, are_counted) {
  EXPECT_EQ(read_measure(rows(RowStatistic::share, "duration > 20"), durations()).value, 10.0 / 24.0);
  EXPECT_EQ(read_measure(rows(RowStatistic::share, "duration > 20", "x == 1"), durations()).value, 5.0 / 12.0);
  EXPECT_EQ(read_measure(rows(RowStatistic::count, "duration > 20", "x == 1"), durations()).value, 5.0);
  EXPECT_EQ(read_measure(rows(RowStatistic::max, "duration"), durations()).value, 50.0);
  EXPECT_EQ(read_measure(rows(RowStatistic::min, "duration"), durations()).value, 9.0);
  EXPECT_EQ(read_measure(rows(RowStatistic::median, "duration", "f0 == 3"), durations()).value, 30.5);
  EXPECT_EQ(read_measure(rows(RowStatistic::mean, "duration", "f0 == 3 && x == 0"), durations()).value, 30.0);
}

TEST(Rows, that_are_not_there_give_nothing) {
  const Reading reading = read_measure(rows(RowStatistic::median, "duration", "x == 2"), durations());
  EXPECT_TRUE(std::isnan(reading.value));
  EXPECT_EQ(reading.coverage, 0.0);
  EXPECT_TRUE(std::isnan(read_measure(rows(RowStatistic::share, "x > 0", "x == 2"), durations()).value));
}

TEST(Ratio, divides) {
  Measure measure;
  measure.kind = Measure::Kind::ratio;
  measure.terms = {rows(RowStatistic::median, "duration", "f0 == 2 && x == 1"),
                   rows(RowStatistic::median, "duration", "f0 == 1 && x == 1")};
  EXPECT_EQ(read_measure(measure, durations()).value, 2.0);
  measure.terms[1].of = "0 * f0";
  EXPECT_TRUE(std::isnan(read_measure(measure, durations()).value));
}

TEST(RegionMeasure, is_where_the_condition_holds_often_enough) {
  Measure measure;
  measure.kind = Measure::Kind::region;
  measure.table = {"study", false};
  measure.of = "duration > 0";
  measure.region.x = "f0";
  measure.region.y = "x";
  measure.region.share = 0.75;
  const Field field = field_of(measure, durations());
  EXPECT_EQ(field.x, (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_EQ(field.y, (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(field.values, (std::vector<double>{1.0, 1.0, 1.0, 1.0, 0.75, 0.25}));
  EXPECT_EQ(read_measure(measure, durations()).value, 5.0 / 6.0);
  measure.region.share = 0.95;
  EXPECT_EQ(read_measure(measure, durations()).value, 4.0 / 6.0);
  measure.region.take = RegionNumber::largest_piece;
  EXPECT_EQ(read_measure(measure, durations()).value, 1.0);
}

// All samples of x = 1 are the same, so drawing them anew changes nothing; those of x = 0 at f0 = 1 are 9 ... 50.
TEST(Resampling, tells_how_far_the_samples_scatter) {
  const Reading same = read_measure(rows(RowStatistic::median, "duration", "f0 == 1 && x == 1"), durations(), 50);
  EXPECT_EQ(same.low, 11.0);
  EXPECT_EQ(same.high, 11.0);
  const Reading other = read_measure(rows(RowStatistic::mean, "duration", "f0 == 1 && x == 0"), durations(), 200);
  EXPECT_EQ(other.value, 19.75);
  EXPECT_LT(other.low, 12.0);   // none of four draws is 50: probability 0.32
  EXPECT_GT(other.high, 29.0);  // two or more are: 0.26
}

TEST(Resampling, is_left_out_where_nothing_is_sampled) {
  Tables tables = durations();
  Table& table = tables.begin()->second;
  table.names[2] = "other";
  const Reading reading = read_measure(rows(RowStatistic::mean, "duration"), tables, 50);
  EXPECT_TRUE(std::isnan(reading.low));
  EXPECT_TRUE(std::isnan(read_measure(rows(RowStatistic::mean, "duration"), durations()).low));
}

// Four of the 24 rows have no duration.
TEST(Rows, of_which_a_condition_is_none_are_not_kept) {
  const Tables tables = durations();
  EXPECT_EQ(read_measure(rows(RowStatistic::count, "1", "duration"), tables).value, 20.0);
}

TEST(Measure, needs_its_tables_and_columns) {
  Measure measure = rows(RowStatistic::mean, "duration");
  measure.table.study = "other";
  EXPECT_THROW(read_measure(measure, durations()), std::out_of_range);
  measure = curves(CurveNumber::mean);
  measure.curves.along = "nu";
  EXPECT_THROW(read_measure(measure, durations()), std::out_of_range);
}

/// One point with so many samples, of which the condition `half` holds in every other one.
Tables samples(std::size_t count) {
  Table table;
  table.names = {"sample", "half", "f0", "x"};
  table.columns.resize(4);
  for (std::size_t s = 0; s < count; ++s) {
    const double row[] = {static_cast<double>(s), static_cast<double>(s % 2), 1.0, 1.0};
    for (std::size_t i = 0; i < 4; ++i) table.columns[i].push_back(row[i]);
  }
  return {{{"study", false}, table}};
}

// The number of 16 draws in which a condition of probability 1/2 holds is binomial: at most 4 in 3.8 % of all, at most
// 5 in 10.5 %, and the same from above.
TEST(Resampling, tells_the_range_of_5_to_95_percent) {
  const Reading reading = read_measure(rows(RowStatistic::share, "half"), samples(16), 4000);
  EXPECT_EQ(reading.value, 0.5);
  EXPECT_EQ(reading.low, 5.0 / 16.0);
  EXPECT_EQ(reading.high, 11.0 / 16.0);
}

// All that is measured shares its draws, so that a ratio of something to itself is 1 whatever is drawn.
TEST(Resampling, draws_the_same_samples_for_both_terms_of_a_ratio) {
  Measure measure;
  measure.kind = Measure::Kind::ratio;
  measure.terms = {rows(RowStatistic::mean, "duration", "f0 == 1 && x == 0"),
                   rows(RowStatistic::mean, "duration", "f0 == 1 && x == 0")};
  const Reading reading = read_measure(measure, durations(), 50);
  EXPECT_EQ(reading.low, 1.0);
  EXPECT_EQ(reading.high, 1.0);
}

// What there is to read: of a ratio no more than of either term, of a region the share of the samples that hold.
TEST(Coverage, is_that_of_what_is_read) {
  Measure ratio;
  ratio.kind = Measure::Kind::ratio;
  const Measure there = rows(RowStatistic::mean, "1"), nothing = rows(RowStatistic::mean, "duration", "x == 2");
  for (const auto& terms : {std::vector<Measure>{there, nothing}, std::vector<Measure>{nothing, there}}) {
    ratio.terms = terms;
    const Reading reading = read_measure(ratio, durations());
    EXPECT_TRUE(std::isnan(reading.value));
    EXPECT_EQ(reading.coverage, 0.0);
  }
  Measure region;
  region.kind = Measure::Kind::region;
  region.table = {"study", false};
  region.of = "sample < 1";
  region.region.x = "f0";
  region.region.y = "x";
  region.region.take = RegionNumber::largest_piece;
  const Reading reading = read_measure(region, samples(16));
  EXPECT_TRUE(std::isnan(reading.value));
  EXPECT_EQ(reading.coverage, 1.0 / 16.0);
}

}  // namespace
}  // namespace vibratory_alignment
