// Statistics, curves and regions against values worked out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "study/metrics.h"

namespace vibratory_alignment {
namespace {

CurvePoints curve(const std::vector<double>& at, const std::vector<double>& values) {
  CurvePoints points;
  for (std::size_t i = 0; i < at.size(); ++i) points.push_back({at[i], values[i], 0.0, 0.0, 1.0});
  return points;
}

TEST(Quantile, lies_between_ranks) {
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_EQ(quantile({10.0, 20.0, 30.0, 40.0, 50.0}, 0.25), 20.0);
  EXPECT_DOUBLE_EQ(quantile({0.0, 1.0}, 0.3), 0.3);
}

TEST(Quantile, passes_over_what_is_no_number) {
  EXPECT_EQ(median({kNone, 5.0, kNone}), 5.0);
  EXPECT_TRUE(std::isnan(median({kNone})));
  EXPECT_TRUE(std::isnan(median({})));
}

TEST(Quantile, of_values_that_are_infinite) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(median({1.0, 2.0, infinity}), 2.0);
  EXPECT_EQ(quantile({1.0, infinity}, 1.0), infinity);
  EXPECT_EQ(quantile({1.0, infinity}, 0.0), 1.0);
}

TEST(Mean, passes_over_what_is_no_number) {
  EXPECT_EQ(mean(std::vector<double>{1.0, kNone, 4.0}), 2.5);
  EXPECT_TRUE(std::isnan(mean(std::vector<double>{})));
}

TEST(Extremes, and_where_they_are) {
  const CurvePoints points = curve({1.0, 2.0, 3.0, 4.0}, {5.0, kNone, 2.0, 7.0});
  EXPECT_EQ(least(points), 2.0);
  EXPECT_EQ(largest(points), 7.0);
  EXPECT_EQ(place_of_least(points), 3.0);
  EXPECT_EQ(place_of_largest(points), 4.0);
  EXPECT_EQ(spread(points), 5.0);
  EXPECT_DOUBLE_EQ(relative_spread(points), 5.0 / (14.0 / 3.0));
}

TEST(Extremes, of_equal_values_are_at_the_first) {
  const CurvePoints points = curve({1.0, 2.0, 3.0}, {4.0, 4.0, 4.0});
  EXPECT_EQ(place_of_least(points), 1.0);
  EXPECT_EQ(place_of_largest(points), 1.0);
}

TEST(Extremes, of_nothing_are_no_numbers) {
  const CurvePoints points = curve({1.0, 2.0}, {kNone, kNone});
  EXPECT_TRUE(std::isnan(least(points)));
  EXPECT_TRUE(std::isnan(place_of_largest(points)));
  EXPECT_TRUE(std::isnan(spread(points)));
}

TEST(ValueAt, is_on_the_line_between_neighbours) {
  const CurvePoints points = curve({1.0, 2.0, 4.0}, {10.0, 20.0, 0.0});
  EXPECT_EQ(value_at(points, 1.0), 10.0);
  EXPECT_EQ(value_at(points, 4.0), 0.0);
  EXPECT_EQ(value_at(points, 1.5), 15.0);
  EXPECT_EQ(value_at(points, 2.5), 15.0);
  EXPECT_TRUE(std::isnan(value_at(points, 0.9)));
  EXPECT_TRUE(std::isnan(value_at(points, 4.1)));
}

TEST(ValueAt, needs_both_neighbours) {
  const CurvePoints points = curve({1.0, 2.0, 3.0}, {10.0, kNone, 30.0});
  EXPECT_TRUE(std::isnan(value_at(points, 1.5)));
  EXPECT_TRUE(std::isnan(value_at(points, 2.0)));
  EXPECT_EQ(value_at(points, 3.0), 30.0);
}

TEST(RSquared, of_a_line_is_one) {
  EXPECT_DOUBLE_EQ(r_squared(curve({0.0, 1.0, 3.0}, {5.0, 3.0, -1.0})), 1.0);
  EXPECT_EQ(r_squared(curve({0.0, 1.0, 2.0}, {4.0, 4.0, 4.0})), 1.0);
}

// y = x^2 at -1, 0, 1: symmetric, no line explains anything. At 0, 1, 2: Sxy = 4, Sxx = 2, Syy = 26/3.
TEST(RSquared, of_a_parabola) {
  EXPECT_NEAR(r_squared(curve({-1.0, 0.0, 1.0}, {1.0, 0.0, 1.0})), 0.0, 1e-15);
  EXPECT_DOUBLE_EQ(r_squared(curve({0.0, 1.0, 2.0}, {0.0, 1.0, 4.0})), 12.0 / 13.0);
}

TEST(RSquared, needs_three_points) { EXPECT_TRUE(std::isnan(r_squared(curve({0.0, 1.0, 2.0}, {1.0, kNone, 2.0})))); }

TEST(RankCorrelation, sees_order_alone) {
  EXPECT_DOUBLE_EQ(rank_correlation(curve({1.0, 2.0, 3.0, 10.0}, {1.0, 10.0, 11.0, 1000.0})), 1.0);
  EXPECT_DOUBLE_EQ(rank_correlation(curve({1.0, 2.0, 3.0}, {3.0, 2.0, -5.0})), -1.0);
  EXPECT_EQ(rank_correlation(curve({1.0, 2.0, 3.0}, {2.0, 2.0, 2.0})), 0.0);
}

// Without ties it is 1 - 6 sum d^2 / (n (n^2 - 1)): ranks 1 3 2 4 differ by 0 1 1 0.
TEST(RankCorrelation, of_one_swap) {
  EXPECT_DOUBLE_EQ(rank_correlation(curve({1.0, 2.0, 3.0, 4.0}, {0.1, 0.3, 0.2, 0.4})), 1.0 - 6.0 * 2.0 / 60.0);
}

// Ranks 1, 2.5, 2.5, 4 against 1, 2, 3, 4: Sxy = 4.5, Sxx = 5, Syy = 4.5.
TEST(RankCorrelation, of_a_tie) {
  EXPECT_DOUBLE_EQ(rank_correlation(curve({1.0, 2.0, 3.0, 4.0}, {0.0, 7.0, 7.0, 8.0})), 4.5 / std::sqrt(22.5));
}

TEST(Width, is_cut_where_the_line_crosses_the_threshold) {
  // above 0.8 from 1 + 0.8 to 3 and from 3 to 4 - 0.6
  EXPECT_DOUBLE_EQ(width(curve({0.0, 1.0, 2.0, 3.0, 4.0}, {0.0, 0.0, 1.0, 1.0, 0.5}), 0.8), 0.2 + 1.0 + 0.4);
  EXPECT_EQ(width(curve({0.0, 1.0, 2.0}, {1.0, 0.8, 1.0}), 0.8), 2.0);
  EXPECT_EQ(width(curve({0.0, 1.0, 2.0}, {0.0, 0.7, 0.0}), 0.8), 0.0);
}

TEST(Width, adds_up_pieces) {
  EXPECT_DOUBLE_EQ(width(curve({0.0, 1.0, 2.0, 3.0, 4.0}, {1.0, 0.0, 0.0, 0.0, 1.0}), 0.5), 1.0);
}

TEST(Width, ends_at_a_point_without_value) { EXPECT_EQ(width(curve({0.0, 1.0, 2.0}, {1.0, 1.0, kNone}), 0.5), 1.0); }

/// A field with x = 0, 1, ... from top to bottom of the picture, y = 0, 1, ... to the right; # is 1, . is 0.
Field field(const std::vector<std::string>& picture) {
  Field f;
  for (std::size_t i = 0; i < picture.size(); ++i) f.x.push_back(static_cast<double>(i));
  for (std::size_t j = 0; j < picture[0].size(); ++j) f.y.push_back(static_cast<double>(j));
  for (const std::string& line : picture)
    for (const char c : line) f.values.push_back(c == '#' ? 1.0 : 0.0);
  return f;
}

TEST(Region, counts_its_points) {
  EXPECT_EQ(region_share(field({"#...", ".##."}), 0.5), 3.0 / 8.0);
  EXPECT_EQ(region_share(field({"...."}), 0.5), 0.0);
}

TEST(Region, is_of_pieces_that_touch_along_the_axes) {
  EXPECT_EQ(largest_piece(field({"##..", "#..#", "..##"}), 0.5), 0.5);
  EXPECT_EQ(largest_piece(field({"#.", ".#"}), 0.5), 0.5);
  EXPECT_EQ(largest_piece(field({"###", "#.#", "###"}), 0.5), 1.0);
  EXPECT_TRUE(std::isnan(largest_piece(field({"..", ".."}), 0.5)));
}

// Open is what lies at the least y, the largest y or the largest x; the least x does not count.
TEST(Region, is_open_at_three_sides) {
  EXPECT_EQ(region_open(field({".#.", ".#.", "..."}), 0.5), 0.0);
  EXPECT_EQ(region_open(field({"##.", "#..", ".##"}), 0.5), 4.0 / 5.0);
  EXPECT_TRUE(std::isnan(region_open(field({"."}), 0.5)));
}

TEST(Region, narrows_with_x) {
  EXPECT_DOUBLE_EQ(region_narrowing(field({"#####", ".###.", "..#.."}), 0.5), -1.0);
  EXPECT_DOUBLE_EQ(region_narrowing(field({"..#..", ".###.", "#####"}), 0.5), 1.0);
  EXPECT_EQ(region_narrowing(field({".###.", ".###."}), 0.5), 0.0);
}

TEST(Region, needs_the_share) {
  Field f = field({"##"});
  f.values = {0.94, 0.95};
  EXPECT_EQ(region_share(f, 0.95), 0.5);
}

}  // namespace
}  // namespace vibratory_alignment
