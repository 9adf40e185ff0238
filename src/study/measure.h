// A measure: one number read off the results of studies, as a facts file asks for it (docs/studies.md "Facts").
//
//   rows     a statistic of a formula over the rows of a study
//   curves   the median (or mean) of a formula over the samples of each point, as curves along one varied value, one
//            curve for each value of others; a number of each curve; these joined to one
//   region   the points of a plane of two varied values at which a condition holds for a share of the samples
//   ratio    one measure over another
#pragma once

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "study/metrics.h"
#include "study/table.h"

namespace vibratory_alignment {

// In measure.cpp the words for these stand in the same order.
enum class RowStatistic { share, count, mean, median, min, max };
enum class CurveNumber {
  min,
  max,
  mean,
  argmin,
  argmax,
  spread,
  relative_spread,
  at,
  r_squared,
  rank_correlation,
  width
};
enum class PointStatistic { median, mean };
enum class CurveJoin { min, max, mean, median, spread };
enum class RegionNumber { share, largest_piece, open, narrowing };

const std::vector<std::string>& row_statistic_words();
const std::vector<std::string>& curve_number_words();
const std::vector<std::string>& point_statistic_words();
const std::vector<std::string>& curve_join_words();
const std::vector<std::string>& region_number_words();

/// Which table a measure is read from: that of a study's trials or that of all touches in them.
struct TableName {
  std::string study;
  bool touches = false;

  bool operator<(const TableName& other) const {
    return std::tie(study, touches) < std::tie(other.study, other.touches);
  }
};

struct RowsMeasure {
  RowStatistic take = RowStatistic::share;
};

struct CurvesMeasure {
  std::string along;                                ///< column
  std::vector<std::string> each;                    ///< columns: a curve for each combination of their values
  std::optional<std::pair<double, double>> within;  ///< of `along`, both ends included
  PointStatistic point = PointStatistic::median;
  double share = 0.8;  ///< of a point's trials that must have a value, else the point has none
  /// Share of a curve's points that must have a value, else the curve has no number, nor has what joins it to
  /// others. With 0 it is left out instead.
  double filled = 0.5;
  CurveNumber take = CurveNumber::mean;
  double at = 0.0;         ///< for CurveNumber::at
  double threshold = 0.0;  ///< for CurveNumber::width
  CurveJoin over = CurveJoin::mean;
};

struct RegionMeasure {
  std::string x, y;     ///< columns
  double share = 0.95;  ///< of the samples for which the condition must hold
  RegionNumber take = RegionNumber::share;
};

struct Measure {
  enum class Kind { rows, curves, region, ratio };
  Kind kind = Kind::rows;
  TableName table;
  std::string where;  ///< condition: only these rows are looked at; empty: all
  std::string of;     ///< formula
  RowsMeasure rows;
  CurvesMeasure curves;
  RegionMeasure region;
  std::vector<Measure> terms;  ///< of a ratio: above and below the line
};

/// What a measure reads.
struct Reading {
  double value = 0.0;     ///< NaN: there is nothing to read it from
  double coverage = 1.0;  ///< share of what it is read from that was there, 0 ... 1 (of the points of curves: that have
                          ///< a value)
  double low = 0.0,
         high = 0.0;  ///< 5 and 95 % of its values over resampled samples; NaN: not asked for, or not sampled
};

using Tables = std::map<TableName, Table>;

/// Names of the tables that the measure is read from.
void collect_tables(const Measure& measure, std::vector<TableName>& names);

/// Reads a measure. `resamples`: how many times the samples of every point are drawn anew, with replacement, for
/// Reading::low and high (bootstrap; all points share their draws, as they share their samples); 0: not at all.
/// Throws FormulaError, and std::out_of_range when a table or column is missing.
Reading read_measure(const Measure& measure, const Tables& tables, int resamples = 0);

/// A curve and the values of the columns in CurvesMeasure::each that it belongs to.
struct Curve {
  std::vector<double> each;
  CurvePoints points;
};

/// The curves that a measure of this kind is read from, in rising order of `each`. Throws like read_measure.
std::vector<Curve> curves_of(const Measure& measure, const Tables& tables);

/// The plane that a measure of a region is read from. Throws like read_measure.
Field field_of(const Measure& measure, const Tables& tables);

}  // namespace vibratory_alignment
