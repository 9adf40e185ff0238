// Gauss-Legendre collocation by what defines it: the polynomials that it integrates and interpolates exactly.
#include "solver/gauss_table.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vibratory_alignment {
namespace {

class GaussTableOf : public testing::TestWithParam<std::size_t> {
 protected:
  const GaussTable& table_ = gauss_table(GetParam());
};
INSTANTIATE_TEST_SUITE_P(nodes, GaussTableOf, testing::Values(16, 24, 32, 40, 48, 56));

TEST_P(GaussTableOf, has_rising_nodes_within_the_interval) {
  ASSERT_EQ(table_.count, GetParam());
  double before = -1.0;
  for (std::size_t i = 0; i < table_.count; ++i) {
    EXPECT_GT(of_node(table_.node, i), before);
    before = of_node(table_.node, i);
  }
  EXPECT_LT(before, 1.0);
}

// Order 2 n: x^(2n - 1) and all below.
TEST_P(GaussTableOf, integrates_polynomials_to_the_end) {
  for (std::size_t k = 0; k < 2 * table_.count; ++k) {
    double sum = 0.0;
    for (std::size_t i = 0; i < table_.count; ++i)
      sum += of_node(table_.weight, i) * std::pow(of_node(table_.node, i), static_cast<double>(k));
    EXPECT_NEAR(sum, k % 2 == 0 ? 2.0 / static_cast<double>(k + 1) : 0.0, 1e-15) << k;
  }
}

TEST_P(GaussTableOf, integrates_polynomials_to_every_node) {
  for (std::size_t k = 0; k < table_.count; ++k)
    for (std::size_t i = 0; i < table_.count; ++i) {
      const double power = static_cast<double>(k + 1), x = of_node(table_.node, i);
      double sum = 0.0;
      for (std::size_t j = 0; j < table_.count; ++j)
        sum += of_node(table_.integral[j], i) * std::pow(of_node(table_.node, j), power - 1.0);
      EXPECT_NEAR(sum, (std::pow(x, power) - std::pow(-1.0, power)) / power, 2e-15) << k << ", node " << i;
    }
}

// Legendre's polynomials are orthogonal: the last two coefficients of others vanish, their own are one.
TEST_P(GaussTableOf, tells_the_last_two_coefficients) {
  for (unsigned k = 0; k < table_.count; ++k)
    for (std::size_t last = 0; last < 2; ++last) {
      double sum = 0.0;
      for (std::size_t i = 0; i < table_.count; ++i)
        sum += of_node(table_.last[last], i) * std::legendre(k, of_node(table_.node, i));
      EXPECT_NEAR(sum, k == table_.count - 2 + last ? 1.0 : 0.0, 1e-13) << k << ", " << last;
    }
}

// Through the value at -1 and those at the nodes: degree n.
TEST_P(GaussTableOf, interpolates_polynomials) {
  for (const double x : {-0.99, -0.3, 0.0, 0.123, 0.7, 1.0})
    for (std::size_t k = 0; k <= table_.count; ++k) {
      const double power = static_cast<double>(k);
      double sum = table_.barycentric[0] / (x + 1.0) * std::pow(-1.0, power), total = table_.barycentric[0] / (x + 1.0);
      for (std::size_t j = 0; j < table_.count; ++j) {
        const double share = table_.barycentric[j + 1] / (x - of_node(table_.node, j));
        sum += share * std::pow(of_node(table_.node, j), power);
        total += share;
      }
      EXPECT_NEAR(sum / total, std::pow(x, power), 2e-13) << k << " at " << x;
    }
}

TEST(GaussTable, has_as_many_nodes_as_asked_for_at_least) {
  EXPECT_EQ(gauss_table(0).count, 16U);
  EXPECT_EQ(gauss_table(16).count, 16U);
  EXPECT_EQ(gauss_table(17).count, 24U);
  EXPECT_EQ(gauss_table(56).count, 56U);
  EXPECT_EQ(gauss_table(57).count, 56U);
}

}  // namespace
}  // namespace vibratory_alignment
