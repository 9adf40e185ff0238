// Radau IIA collocation on [0, 1]: s nodes, the last one 1; order 2s - 1, L-stable (Hairer and Wanner, Solving Ordinary
// Differential Equations II, IV.5).
#pragma once

#include <array>
#include <complex>

namespace vibratory_alignment {

struct Collocation {
  static constexpr int kStages = 7;
  static constexpr int kPairs = kStages / 2;  ///< complex pairs of eigenvalues of A, besides one real

  template <typename T>
  using Vector = std::array<T, kStages>;
  template <typename T>
  using Matrix = std::array<std::array<T, kStages>, kStages>;

  Vector<double> node{};                ///< c_i
  Matrix<double> velocity{};            ///< A: v(c_i) = v0 + h sum A_ij a_j
  Matrix<double> position{};            ///< A^2: q(c_i) = q0 + c_i h v0 + h^2 sum (A^2)_ij a_j
  Matrix<double> acceleration_power{};  ///< a(t) = sum_k t^k sum_j (..)_kj a_j
  /// Values at 0 and the nodes to powers of t, the polynomial of degree s.
  std::array<std::array<double, kStages + 1>, kStages + 1> value_power{};
  Vector<double> at_start{};  ///< a(0) = sum_j (..)_j a_j

  /// A = modes diag(eigenvalue) modes^-1; the real one first, then one of each pair.
  std::array<std::complex<double>, 1 + kPairs> eigenvalue{};
  std::array<Vector<std::complex<double>>, 1 + kPairs> mode{};  ///< columns of `modes`
  std::array<Vector<std::complex<double>>, 1 + kPairs> dual{};  ///< rows of modes^-1
};

/// The tables, computed once.
const Collocation& collocation();

}  // namespace vibratory_alignment
