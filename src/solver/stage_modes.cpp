#include "solver/stage_modes.h"

#include <Eigen/LU>

namespace vibratory_alignment {
namespace {

constexpr std::size_t kStages = Collocation::kStages;

/// A complex mode comes with its conjugate.
double weight(std::size_t mode) { return mode == 0 ? 1.0 : 2.0; }

}  // namespace

void StageModes::set(double h, const ForceJacobian& jacobian) {
  h_ = h;
  const Collocation& table = collocation();
  for (std::size_t m = 0; m < inverse_.size(); ++m) {
    const std::complex<double> z = h * table.eigenvalue[m];
    const Eigen::Matrix3cd matrix =
        Eigen::Matrix3cd::Identity() - z * jacobian.by_velocity - z * z * jacobian.by_position;
    inverse_[m] = matrix.inverse();
  }
  filter_ = inverse_[0].real();
}

Stages StageModes::correction(const Stages& residual) const {
  const Collocation& table = collocation();
  Stages correction{};
  for (std::size_t m = 0; m < inverse_.size(); ++m) {
    StageAxes real{}, imaginary{};
    for (std::size_t i = 0; i < kStages; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        real[axis] += table.dual[m][i].real() * residual[i][axis];
        imaginary[axis] += table.dual[m][i].imag() * residual[i][axis];
      }
    for (std::size_t row = 0; row < 3; ++row) {
      double solved_real = 0.0, solved_imaginary = 0.0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::complex<double>& entry =
            inverse_[m](static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(axis));
        solved_real += entry.real() * real[axis] - entry.imag() * imaginary[axis];
        solved_imaginary += entry.real() * imaginary[axis] + entry.imag() * real[axis];
      }
      for (std::size_t i = 0; i < kStages; ++i)
        correction[i][row] +=
            weight(m) * (table.mode[m][i].real() * solved_real - table.mode[m][i].imag() * solved_imaginary);
    }
  }
  return correction;
}

StageModes::StageMatrix StageModes::response(const Eigen::RowVector3d& by_position,
                                             const Eigen::RowVector3d& by_velocity, const Eigen::Vector3d& push) const {
  const Collocation& table = collocation();
  StageMatrix response = StageMatrix::Zero();
  for (std::size_t m = 0; m < inverse_.size(); ++m) {
    const std::complex<double> z = h_ * table.eigenvalue[m];
    std::complex<double> gain = 0.0;
    for (Eigen::Index row = 0; row < 3; ++row) {
      std::complex<double> pushed = 0.0;
      for (Eigen::Index axis = 0; axis < 3; ++axis) pushed += inverse_[m](row, axis) * push[axis];
      gain += (z * by_velocity[row] + z * z * by_position[row]) * pushed;
    }
    gain *= weight(m);
    for (std::size_t i = 0; i < kStages; ++i) {
      const std::complex<double> at = gain * table.mode[m][i];
      for (std::size_t j = 0; j < kStages; ++j)
        response(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) +=
            at.real() * table.dual[m][j].real() - at.imag() * table.dual[m][j].imag();
    }
  }
  return response;
}

}  // namespace vibratory_alignment
