// What can be measured on the results of a study: statistics of a set of numbers, curves of medians, regions.
// Pure functions of numbers. A quantity that cannot be told from what is given (no value, too few points) is NaN.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace vibratory_alignment {

/// A quantity that cannot be told.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Of those that are not NaN; of an even number of them the mean of the middle two.
double median(std::vector<double> values);

/// The value below which the share q of those that are not NaN lies, linear between neighbours in rank.
double quantile(std::vector<double> values, double q);

/// Of those that are not NaN.
double mean(const std::vector<double>& values);

/// One point of a curve.
struct CurvePoint {
  double at = 0.0;               ///< where it stands
  double value = 0.0;            ///< NaN: it has none
  double low = 0.0, high = 0.0;  ///< quartiles of what the value is the median of
  double share = 0.0;            ///< of its trials that have a value
};

/// Points in rising order of `at`. The functions below pass over points without a value.
using CurvePoints = std::vector<CurvePoint>;

double least(const CurvePoints& points);
double largest(const CurvePoints& points);
double mean(const CurvePoints& points);

/// Where the least / the largest value is; the first of equal ones.
double place_of_least(const CurvePoints& points);
double place_of_largest(const CurvePoints& points);

/// Largest less least; the same over the mean of the values.
double spread(const CurvePoints& points);
double relative_spread(const CurvePoints& points);

/// On the straight line between the neighbours of `at`; NaN when it lies outside or a neighbour has no value.
double value_at(const CurvePoints& points, double at);

/// How much of the variance a straight line explains (1: all on a line); of at least 3 points. 1 when the values are
/// all the same: a level line.
double r_squared(const CurvePoints& points);

/// Spearman's: 1 when the value rises from each point to the next, -1 when it falls. Ties share their ranks. Of at
/// least 2 points; 0 when the values are all the same.
double rank_correlation(const CurvePoints& points);

/// Length of the axis on which the value is at least `threshold`, straight lines between the points. A point without
/// value counts as one far below the threshold.
double width(const CurvePoints& points, double threshold);

/// A quantity over a rectangular grid, NaN where unknown.
struct Field {
  std::vector<double> x, y;    ///< rising
  std::vector<double> values;  ///< values[i * y.size() + j] at x[i], y[j]

  double at(std::size_t i, std::size_t j) const { return values[i * y.size() + j]; }
};

/// Share of the grid's points at which the value is at least `threshold`: the region.
double region_share(const Field& field, double threshold);

/// Share of the region's points that belong to its largest piece (neighbours along x or y are of one piece).
double largest_piece(const Field& field, double threshold);

/// Share of the region's points that lie on the border of the grid at its least y, largest y or largest x.
double region_open(const Field& field, double threshold);

/// Rank correlation of x with the width of the region along y there.
double region_narrowing(const Field& field, double threshold);

}  // namespace vibratory_alignment
