// The modes of an implicit step against the equations of all its stages at once, made of A by Kronecker's product.
#include "solver/stage_modes.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

namespace vibratory_alignment {
namespace {

constexpr int kStages = Collocation::kStages, kUnknowns = 3 * kStages;
using Whole = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;

/// What accelerations at the stages make of the velocities and positions there, over h and h^2: A and A^2 for each
/// axis.
Whole of_all_axes(const Collocation::Matrix<double>& a, const Eigen::Matrix3d& by) {
  Whole whole;
  for (int i = 0; i < kStages; ++i)
    for (int j = 0; j < kStages; ++j) whole.block<3, 3>(3 * i, 3 * j) = a[i][j] * by;
  return whole;
}

class StageModesTest : public testing::Test {
 protected:
  StageModesTest() {
    const auto number = [this] { return u_(random_); };
    jacobian_.by_position = 300.0 * Eigen::Matrix3d::NullaryExpr(number);
    jacobian_.by_velocity = 10.0 * Eigen::Matrix3d::NullaryExpr(number);
    modes_.set(h_, jacobian_);
    whole_ = Whole::Identity() - h_ * of_all_axes(collocation().velocity, jacobian_.by_velocity) -
             h_ * h_ * of_all_axes(collocation().position, jacobian_.by_position);
  }

  std::mt19937 random_{11};
  std::uniform_real_distribution<double> u_{-1.0, 1.0};
  const double h_ = 0.1;
  ForceJacobian jacobian_;
  StageModes modes_;
  Whole whole_;
};

TEST_F(StageModesTest, correction_solves_the_equations_of_all_stages) {
  Stages residual, correction;
  Unknowns right;
  for (int i = 0; i < kStages; ++i)
    for (int axis = 0; axis < 3; ++axis) right[3 * i + axis] = residual[axis][i] = u_(random_);
  for (Octet& axis : residual) axis[kStages] = 1e6;  // the place that no stage has counts nothing
  modes_.correction(residual, correction);
  const Unknowns solved = whole_.fullPivLu().solve(right);
  for (int i = 0; i < kStages; ++i)
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(correction[axis][i], solved[3 * i + axis], 1e-12 * solved.norm());
  for (const Octet& axis : correction) EXPECT_EQ(axis[kStages], axis[kStages - 1]);
}

TEST_F(StageModesTest, response_is_what_pushes_at_the_stages_make_of_a_quantity) {
  const Eigen::RowVector3d by_position(40.0, -30.0, 7.0), by_velocity(2.0, 1.0, -3.0);
  const Eigen::Vector3d push(0.7, -0.2, 1.3);
  StageModes::Rows rows;
  modes_.response(by_position, by_velocity, push, rows);
  for (int j = 0; j < kStages; ++j) {
    Unknowns right = Unknowns::Zero();
    right.segment<3>(3 * j) = push;
    const Unknowns a = whole_.fullPivLu().solve(right);
    for (int i = 0; i < kStages; ++i) {
      double quantity = 0.0;
      for (int k = 0; k < kStages; ++k)
        quantity += h_ * h_ * collocation().position[i][k] * by_position.dot(a.segment<3>(3 * k)) +
                    h_ * collocation().velocity[i][k] * by_velocity.dot(a.segment<3>(3 * k));
      EXPECT_NEAR(rows[i][j], quantity, 1e-12) << i << " " << j;
    }
  }
  for (const Octet& row : rows) EXPECT_EQ(row[kStages], 0.0);
}

TEST_F(StageModesTest, filter_is_that_of_the_real_mode) {
  const double z = h_ * collocation().eigenvalue[0].real();
  const Eigen::Matrix3d product =
      modes_.filter() * (Eigen::Matrix3d::Identity() - z * jacobian_.by_velocity - z * z * jacobian_.by_position);
  EXPECT_LT((product - Eigen::Matrix3d::Identity()).norm(), 1e-14);
}

// What grows exponentially is followed by a step that is short for it, and damped by a longer one; what is damped or
// rings may be passed over at any rate.
TEST(StageModes, tell_growth_that_is_too_fast_for_the_step) {
  const double h = 0.1, rate = 1.0 / (h * collocation().eigenvalue[0].real());
  const auto passes_over_growth = [&](double by_position, double by_velocity) {
    ForceJacobian jacobian;
    jacobian.by_position = jacobian.by_velocity = Eigen::Matrix3d::Zero();
    jacobian.by_position(1, 1) = by_position;
    jacobian.by_velocity(1, 1) = by_velocity;
    jacobian.by_position(0, 2) = 1e3;
    StageModes modes;
    modes.set(h, jacobian);
    return modes.passes_over_growth();
  };
  EXPECT_FALSE(passes_over_growth(0.0, 0.9 * rate));
  EXPECT_TRUE(passes_over_growth(0.0, 1.1 * rate));
  EXPECT_FALSE(passes_over_growth(0.9 * rate * rate, 0.0));
  EXPECT_TRUE(passes_over_growth(1.1 * rate * rate, 0.0));
  for (const double faster : {1.0, 1e3, 1e12}) {
    EXPECT_FALSE(passes_over_growth(0.0, -faster * rate));
    EXPECT_FALSE(passes_over_growth(-faster * rate * rate, 0.0));
  }
}

}  // namespace
}  // namespace vibratory_alignment
