// Radau IIA collocation by what defines it: the polynomials that it integrates exactly, its order, its stability.
#include "solver/collocation.h"

#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Dense>

namespace vibratory_alignment {
namespace {

constexpr int kStages = Collocation::kStages;
using Complex = std::complex<double>;

TEST(Collocation, nodes_rise_to_one) {
  const Collocation& table = collocation();
  EXPECT_GT(table.node[0], 0.0);
  for (std::size_t i = 1; i < kStages; ++i) EXPECT_GT(table.node[i], table.node[i - 1]);
  EXPECT_DOUBLE_EQ(table.node[kStages - 1], 1.0);
}

// Collocation: a' = k t^(k-1) is integrated exactly to every node for k <= s; to the end, as a quadrature, for k <=
// 2s-1.
TEST(Collocation, integrates_polynomials_exactly) {
  const Collocation& table = collocation();
  for (int k = 1; k <= 2 * kStages - 1; ++k)
    for (std::size_t i = 0; i < kStages; ++i) {
      if (k > kStages && i + 1 < kStages) continue;
      double sum = 0.0;
      for (std::size_t j = 0; j < kStages; ++j) sum += table.velocity[i][j] * k * std::pow(table.node[j], k - 1);
      EXPECT_NEAR(sum, std::pow(table.node[i], k), 1e-14) << "power " << k << ", node " << i;
    }
}

TEST(Collocation, the_quadrature_has_order_2s_minus_1_and_no_more) {
  const Collocation& table = collocation();
  constexpr int k = 2 * kStages;
  double sum = 0.0;
  for (std::size_t j = 0; j < kStages; ++j) sum += table.velocity[kStages - 1][j] * k * std::pow(table.node[j], k - 1);
  EXPECT_GT(std::abs(sum - 1.0), 1e-10);
}

TEST(Collocation, positions_are_velocities_integrated) {
  const Collocation& table = collocation();
  for (std::size_t i = 0; i < kStages; ++i)
    for (std::size_t j = 0; j < kStages; ++j) {
      double sum = 0.0;
      for (std::size_t m = 0; m < kStages; ++m) sum += table.velocity[i][m] * table.velocity[m][j];
      EXPECT_NEAR(table.position[i][j], sum, 1e-14);
    }
}

TEST(Collocation, polynomials_pass_through_their_values) {
  const Collocation& table = collocation();
  for (std::size_t j = 0; j < kStages; ++j)
    for (std::size_t i = 0; i < kStages; ++i) {
      double a = 0.0, value = 0.0;
      for (std::size_t k = 0; k < kStages; ++k) a += table.acceleration_power[k][j] * std::pow(table.node[i], k);
      for (std::size_t k = 0; k <= kStages; ++k) value += table.value_power[k][j + 1] * std::pow(table.node[i], k);
      EXPECT_NEAR(a, i == j ? 1.0 : 0.0, 1e-11);
      EXPECT_NEAR(value, i == j ? 1.0 : 0.0, 1e-11);
    }
}

TEST(Collocation, modes_make_up_the_matrix) {
  const Collocation& table = collocation();
  EXPECT_NEAR(table.eigenvalue[0].imag(), 0.0, 1e-14);
  for (std::size_t i = 0; i < kStages; ++i)
    for (std::size_t j = 0; j < kStages; ++j) {
      double sum = 0.0;
      for (std::size_t m = 0; m < table.eigenvalue.size(); ++m)
        sum += (m == 0 ? 1.0 : 2.0) * (table.mode[m][i] * table.eigenvalue[m] * table.dual[m][j]).real();
      EXPECT_NEAR(sum, table.velocity[i][j], 1e-13);
    }
}

/// R(z) of y' = lambda y, z = lambda h: 1 + z b (I - z A)^-1 1, b the last row of A.
Complex stability(Complex z) {
  const Collocation& table = collocation();
  Eigen::MatrixXcd matrix = Eigen::MatrixXcd::Identity(kStages, kStages);
  for (int i = 0; i < kStages; ++i)
    for (int j = 0; j < kStages; ++j)
      matrix(i, j) -= z * table.velocity[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  const Eigen::VectorXcd inner = matrix.partialPivLu().solve(Eigen::VectorXcd::Ones(kStages));
  return inner[kStages - 1];  // stiffly accurate: the last stage is the end
}

TEST(Collocation, is_l_stable) {
  for (const double y : {0.1, 1.0, 3.0, 10.0, 30.0, 100.0, 1e4})
    EXPECT_LE(std::abs(stability({0.0, y})), 1.0 + 1e-12) << y;
  for (const double x : {1e6, 1e9}) EXPECT_LT(std::abs(stability({-x, 0.0})), 100.0 / x);
  EXPECT_LT(std::abs(stability({0.0, 1e8})), 1e-5);
}

TEST(Collocation, follows_the_exponential_with_order_13) {
  // one step: local error of order 14
  const double coarse = std::abs(stability({0.0, 4.0}) - std::exp(Complex(0.0, 4.0)));
  const double fine = std::abs(stability({0.0, 2.0}) - std::exp(Complex(0.0, 2.0)));
  EXPECT_NEAR(std::log2(coarse / fine), 2.0 * kStages, 0.7);
}

}  // namespace
}  // namespace vibratory_alignment
