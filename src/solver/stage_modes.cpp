#include "solver/stage_modes.h"

namespace vibratory_alignment {

VIBRATORY_ALIGNMENT_INLINE void StageModes::multiply(const Complex& a, const Complex& b, Complex& product) {
  product.real = a.real * b.real - a.imaginary * b.imaginary;
  product.imaginary = a.real * b.imaginary + a.imaginary * b.real;
}

void StageModes::set(double h, const ForceJacobian& jacobian) {
  const StageTable& table = stage_table();
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    z_.real = h * table.eigenvalue_real;
    z_.imaginary = h * table.eigenvalue_imaginary;
    multiply(z_, z_, z_squared_);
    Complex matrix[3][3];
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double by_v = jacobian.by_velocity(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(axis));
        const double by_q = jacobian.by_position(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(axis));
        matrix[row][axis].real = (row == axis ? 1.0 : 0.0) - z_.real * by_v - z_squared_.real * by_q;
        matrix[row][axis].imaginary = -z_.imaginary * by_v - z_squared_.imaginary * by_q;
      }
    // by the cofactors
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t r1 = (axis + 1) % 3, r2 = (axis + 2) % 3, c1 = (row + 1) % 3, c2 = (row + 2) % 3;
        Complex a, b;
        multiply(matrix[r1][c1], matrix[r2][c2], a);
        multiply(matrix[r1][c2], matrix[r2][c1], b);
        inverse_[row][axis] = {a.real - b.real, a.imaginary - b.imaginary};
      }
    Complex determinant{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Complex term;
      multiply(matrix[0][axis], inverse_[axis][0], term);
      determinant.real += term.real;
      determinant.imaginary += term.imaginary;
    }
    passes_over_growth_ = determinant.real[0] <= 0.0;
    const Quad size = determinant.real * determinant.real + determinant.imaginary * determinant.imaginary;
    const Complex over{determinant.real / size, -determinant.imaginary / size};
    for (auto& row : inverse_)
      for (Complex& entry : row) {
        const Complex cofactor = entry;
        multiply(cofactor, over, entry);
      }
  });
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t axis = 0; axis < 3; ++axis)
      filter_(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(axis)) = inverse_[row][axis].real[0];
}

void StageModes::response(const Eigen::RowVector3d& by_position, const Eigen::RowVector3d& by_velocity,
                          const Eigen::Vector3d& push, Rows& rows) const {
  const StageTable& table = stage_table();
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    Complex gain{};
    for (std::size_t row = 0; row < 3; ++row) {
      const auto index = static_cast<Eigen::Index>(row);
      Complex pushed{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        pushed.real += inverse_[row][axis].real * push[static_cast<Eigen::Index>(axis)];
        pushed.imaginary += inverse_[row][axis].imaginary * push[static_cast<Eigen::Index>(axis)];
      }
      const Complex weight{z_.real * by_velocity[index] + z_squared_.real * by_position[index],
                           z_.imaginary * by_velocity[index] + z_squared_.imaginary * by_position[index]};
      Complex term;
      multiply(weight, pushed, term);
      gain.real += term.real;
      gain.imaginary += term.imaginary;
    }
    gain.real *= table.weight;
    gain.imaginary *= table.weight;
    for (std::size_t i = 0; i < StageTable::kStages; ++i) {
      Complex at;
      multiply(gain, {table.mode[i].low, table.mode[i].high}, at);
      rows[i] = combine(table.dual, {at.real, at.imaginary});
    }
  });
}

}  // namespace vibratory_alignment
