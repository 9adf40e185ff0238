// Newton's method on the equations of an implicit step with one Jacobian for all its stages: in the eigenvectors of A
// they fall into equations of size 3, (I - h lambda f_v - h^2 lambda^2 f_q) (docs/implicit_steps.md).
#pragma once

#include <Eigen/Core>

#include "mechanics/force_jacobian.h"
#include "solver/collocation.h"

namespace vibratory_alignment {

/// Values of x, y, phi at the stages of a step.
using StageAxes = std::array<double, 3>;
using Stages = Collocation::Vector<StageAxes>;

class StageModes {
 public:
  using StageMatrix = Eigen::Matrix<double, Collocation::kStages, Collocation::kStages>;

  /// For a step of length h.
  void set(double h, const ForceJacobian& jacobian);

  /// (I - h lambda_0 f_v - h^2 lambda_0^2 f_q)^-1 for the real eigenvalue.
  const Eigen::Matrix3d& filter() const { return filter_; }

  /// Change of the accelerations that takes out a residual f - a.
  Stages correction(const Stages& residual) const;

  /// What accelerations `push` y_j at the stages j, corrected, make of a quantity with the derivatives `by_position`
  /// and `by_velocity` at the stages i: the matrix of the y_j.
  StageMatrix response(const Eigen::RowVector3d& by_position, const Eigen::RowVector3d& by_velocity,
                       const Eigen::Vector3d& push) const;

 private:
  double h_ = 0.0;
  Eigen::Matrix3d filter_;
  std::array<Eigen::Matrix3cd, 1 + Collocation::kPairs> inverse_;
};

}  // namespace vibratory_alignment
