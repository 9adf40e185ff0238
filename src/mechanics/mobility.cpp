#include "mechanics/mobility.h"

#include <algorithm>
#include <cmath>

namespace vibratory_alignment {
namespace {

/// Below this, relative to the largest, a pivot of G is rounding.
constexpr double kSingular = 2e-15;

/// Below this a pivot amplifies rounding too much to be used where it is not needed.
constexpr double kNearlySingular = 1e-8;

}  // namespace

void Mobility::set(const Matrix& matrix, int count, double typical) {
  matrix_ = matrix;
  count_ = count;
  double largest = 0.0;
  for (int i = 0; i < count; ++i) largest = std::max(largest, matrix[i][i]);
  holds_nothing_ = largest <= kSingular * typical;
  if (count < 2 || holds_nothing_) return;
  Dense dense(count, count);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) dense(i, j) = matrix[i][j];
  safe_.setThreshold(kNearlySingular);
  safe_.compute(dense);
  full_.setThreshold(kSingular);
  full_.compute(dense);
}

Mobility::Vector Mobility::solve(const Decomposition& decomposition, const Vector& rhs) const {
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kSiteCount, 1>;
  Column column(count_);
  for (int i = 0; i < count_; ++i) column[i] = rhs[i];
  const Column solution = decomposition.solve(column);
  Vector force{};
  for (int i = 0; i < count_; ++i) force[i] = solution[i];
  return force;
}

Mobility::Vector Mobility::hold(const Vector& rhs, const Vector& noise) const {
  Vector force{};
  if (count_ == 0 || holds_nothing_) return force;
  if (count_ == 1) {
    force[0] = rhs[0] / matrix_[0][0];
    return force;
  }
  force = solve(safe_, rhs);
  if (safe_.rank() == full_.rank()) return force;
  bool exact = true;
  for (int i = 0; i < count_; ++i) exact = exact && std::abs(left_over(i, rhs, force)) <= noise[i];
  return exact ? force : solve(full_, rhs);
}

double Mobility::left_over(int row, const Vector& rhs, const Vector& force) const {
  double left = -rhs[row];
  for (int j = 0; j < count_; ++j) left += matrix_[row][j] * force[j];
  return left;
}

double typical_mobility(const System& system) {
  const double reach = system.half_width + system.base_distance;
  return system.x.inverse_inertia + system.y.inverse_inertia + reach * reach * system.phi.inverse_inertia;
}

}  // namespace vibratory_alignment
