// Newton's method on the equations of an implicit step with one Jacobian for all its stages: in the eigenvectors of A
// they fall into equations of size 3, (I - h lambda f_v - h^2 lambda^2 f_q) (docs/implicit_steps.md).
#pragma once

#include <Eigen/Core>

#include "mechanics/force_jacobian.h"
#include "solver/stage_table.h"

namespace vibratory_alignment {

/// Values of x, y, phi: at one instant, and at the stages of a step.
using StageAxes = std::array<double, 3>;
using Stages = std::array<Octet, 3>;

class StageModes {
 public:
  using Rows = std::array<Octet, StageTable::kStages>;  ///< of a matrix of the stages; last place 0

  /// For a step of length h.
  [[gnu::noinline]] void set(double h, const ForceJacobian& jacobian);

  /// (I - h lambda_0 f_v - h^2 lambda_0^2 f_q)^-1 for the real eigenvalue.
  const Eigen::Matrix3d& filter() const { return filter_; }

  /// True when a motion that grows is too fast for the step: the method would damp it. The determinant of the matrix of
  /// filter() is 1 for h = 0 and passes through zero at h lambda_0 = 1/rate.
  bool passes_over_growth() const { return passes_over_growth_; }

  /// Change of the accelerations that takes out a residual f - a.
  VIBRATORY_ALIGNMENT_INLINE void correction(const Stages& residual, Stages& correction) const;

  /// What accelerations `push` y_j at the stages j, corrected, make of a quantity with the derivatives `by_position`
  /// and `by_velocity` at the stages i: the matrix of the y_j.
  [[gnu::noinline]] void response(const Eigen::RowVector3d& by_position, const Eigen::RowVector3d& by_velocity,
                                  const Eigen::Vector3d& push, Rows& rows) const;

 private:
  /// One number for every mode.
  struct Complex {
    Quad real, imaginary;
  };
  static void multiply(const Complex& a, const Complex& b, Complex& product);

  Complex z_, z_squared_;                            ///< h lambda, h^2 lambda^2
  std::array<std::array<Complex, 3>, 3> inverse_{};  ///< rows
  Eigen::Matrix3d filter_;
  bool passes_over_growth_ = false;
};

VIBRATORY_ALIGNMENT_INLINE void StageModes::correction(const Stages& residual, Stages& correction) const {
  const StageTable& table = stage_table();
  constexpr std::size_t kModes = StageTable::kModes;
  Stages modes;
  for (std::size_t axis = 0; axis < 3; ++axis) modes[axis] = combine(table.to_modes, residual[axis]);
  for (std::size_t row = 0; row < 3; ++row) {
    Octet solved{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Complex& entry = inverse_[row][axis];
      solved.low += entry.real * modes[axis].low - entry.imaginary * modes[axis].high;
      solved.high += entry.real * modes[axis].high + entry.imaginary * modes[axis].low;
    }
    Octet sum = table.from_modes[0] * solved[0];
    for (std::size_t m = 1; m < 2 * kModes; ++m)
      if (m != kModes) sum += table.from_modes[m] * solved[m];  // the first mode is real
    correction[row] = sum;
  }
}

/// What by_position dq + by_velocity dv is at the stages of a step of length h, for changes of the accelerations there.
VIBRATORY_ALIGNMENT_INLINE Octet change_at_stages(const Eigen::RowVector3d& by_position,
                                                  const Eigen::RowVector3d& by_velocity, double h,
                                                  const Stages& change) {
  const StageTable& table = stage_table();
  Octet of_position{}, of_velocity{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    of_position += (h * h * by_position[static_cast<Eigen::Index>(axis)]) * change[axis];
    of_velocity += (h * by_velocity[static_cast<Eigen::Index>(axis)]) * change[axis];
  }
  return combine(table.position, of_position) + combine(table.velocity, of_velocity);
}

}  // namespace vibratory_alignment
