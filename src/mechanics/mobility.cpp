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
  regular_ = count == 0 || (count == 1 && !holds_nothing_);
  if (count < 2 || holds_nothing_) return;
  Dense dense(count, count);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) dense(i, j) = matrix[i][j];
  safe_.setThreshold(kNearlySingular);
  safe_.compute(dense);
  full_.setThreshold(kSingular);
  full_.compute(dense);
  regular_ = safe_.rank() == count;
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

Mobility::Vector Mobility::spread(const Vector& noise) const {
  Vector error{};
  if (count_ == 0 || holds_nothing_) return error;
  if (count_ == 1) {
    error[0] = noise[0] / matrix_[0][0];
    return error;
  }
  const Dense inverse = safe_.pseudoInverse();
  for (int i = 0; i < count_; ++i)
    for (int j = 0; j < count_; ++j) error[i] += std::abs(inverse(i, j)) * noise[j];
  return error;
}

Mobility::Matrix mobility_of(const System& system, const Mobility::Directions& tangents, int count) {
  Mobility::Matrix matrix{};
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      const Load3 &a = tangents[i], &b = tangents[j];
      matrix[i][j] = a.x * b.x * system.x.inverse_inertia + a.y * b.y * system.y.inverse_inertia +
                     a.phi * b.phi * system.phi.inverse_inertia;
    }
  return matrix;
}

double typical_mobility(const System& system) {
  const double reach = system.half_width + system.base_distance;
  return system.x.inverse_inertia + system.y.inverse_inertia + reach * reach * system.phi.inverse_inertia;
}

}  // namespace vibratory_alignment
