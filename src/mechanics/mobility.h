// Tangential forces that hold contacts where only their mobility G is known, the Delassus matrix of the tangents: the
// friction of a step (box_friction.h). holding_forces.h has the rows that G is made of, and is the more exact one.
//
// T_j changes V'_i by G_ij T_j, G_ij = t_i . M^-1 . t_j with t_i = (t_x, t_y, r x t): symmetric, positive semidefinite.
// Contacts that hold the same motion make G singular, nearly equal levers make it nearly so: then only the sum of
// their forces is determined, and the smallest forces are taken (they share equally).
#pragma once

#include <array>

#include <Eigen/QR>

#include "mechanics/contact.h"
#include "mechanics/system.h"

namespace vibratory_alignment {

class Mobility {
 public:
  using Vector = std::array<double, kSiteCount>;
  using Matrix = std::array<Vector, kSiteCount>;

  /// The first `count` rows of G. A G that is rounding beside `typical` holds nothing.
  void set(const Matrix& matrix, int count, double typical);

  /// The smallest T with |G T - rhs| <= noise; if none is as exact, the smallest of those that come nearest.
  Vector hold(const Vector& rhs, const Vector& noise) const;

  /// G T - rhs of one row.
  double left_over(int row, const Vector& rhs, const Vector& force) const;

 private:
  using Dense = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kSiteCount, kSiteCount>;
  using Decomposition = Eigen::CompleteOrthogonalDecomposition<Dense>;
  Vector solve(const Decomposition& decomposition, const Vector& rhs) const;

  Matrix matrix_{};
  int count_ = 0;
  bool holds_nothing_ = false;
  Decomposition safe_, full_;  ///< without the nearly common motions, and with all that is not rounding
};

/// Mobility of a point of the part about as far from its centre as any.
double typical_mobility(const System& system);

}  // namespace vibratory_alignment
