#include "solver/collocation.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace vibratory_alignment {
namespace {

using Real = long double;
using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
constexpr int kStages = Collocation::kStages;

/// Legendre polynomials P_(s-1) - P_s at 2 t - 1, whose zeros are the nodes.
Real radau_polynomial(Real t) {
  const Real x = 2.0L * t - 1.0L;
  Real before = 1.0L, now = x;
  for (int n = 1; n < kStages; ++n) {
    const Real next = ((2 * n + 1) * x * now - n * before) / (n + 1);
    before = now;
    now = next;
  }
  return before - now;
}

/// Zeros in (0, 1] by bisection between sign changes on a fine grid.
std::vector<Real> radau_nodes() {
  std::vector<Real> nodes;
  constexpr int kGrid = 4096;
  for (int i = 0; i < kGrid; ++i) {
    Real low = static_cast<Real>(i) / kGrid, high = static_cast<Real>(i + 1) / kGrid;
    if (i + 1 == kGrid) break;  // the node 1 itself
    if (radau_polynomial(low) * radau_polynomial(high) > 0.0L) continue;
    const bool rising = radau_polynomial(high) > 0.0L;
    for (int halving = 0; halving < 80; ++halving) {
      const Real middle = 0.5L * (low + high);
      ((radau_polynomial(middle) > 0.0L) == rising ? high : low) = middle;
    }
    nodes.push_back(0.5L * (low + high));
  }
  nodes.push_back(1.0L);
  return nodes;
}

Collocation make_collocation() {
  Collocation table;
  const std::vector<Real> node = radau_nodes();
  const auto count = static_cast<Eigen::Index>(node.size());

  // a polynomial through values at the nodes: coefficients = powers^-1 values
  RealMatrix powers(count, count), integrals(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index k = 0; k < count; ++k) {
      powers(i, k) = std::pow(node[static_cast<std::size_t>(i)], static_cast<Real>(k));
      integrals(i, k) =
          std::pow(node[static_cast<std::size_t>(i)], static_cast<Real>(k + 1)) / static_cast<Real>(k + 1);
    }
  const RealMatrix coefficients = powers.fullPivLu().inverse();
  const RealMatrix a = integrals * coefficients, a2 = a * a;

  // likewise with the value at 0
  RealMatrix wide = RealMatrix::Zero(count + 1, count + 1);
  wide(0, 0) = 1.0L;
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index k = 0; k <= count; ++k)
      wide(i + 1, k) = std::pow(node[static_cast<std::size_t>(i)], static_cast<Real>(k));
  const RealMatrix wide_coefficients = wide.fullPivLu().inverse();

  for (int i = 0; i < kStages; ++i) {
    const auto row = static_cast<std::size_t>(i);
    table.node[row] = static_cast<double>(node[row]);
    table.at_start[row] = static_cast<double>(coefficients(0, i));
    for (int j = 0; j < kStages; ++j) {
      const auto column = static_cast<std::size_t>(j);
      table.velocity[row][column] = static_cast<double>(a(i, j));
      table.position[row][column] = static_cast<double>(a2(i, j));
      table.acceleration_power[row][column] = static_cast<double>(coefficients(i, j));
    }
  }
  for (int i = 0; i <= kStages; ++i)
    for (int j = 0; j <= kStages; ++j)
      table.value_power[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
          static_cast<double>(wide_coefficients(i, j));

  // eigenvalues with imaginary part >= 0, the real one first
  const Eigen::EigenSolver<Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>> solver(a);
  const auto vectors = solver.eigenvectors().eval();
  const auto inverse = vectors.fullPivLu().inverse().eval();
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < count; ++i)
    if (solver.eigenvalues()[i].imag() > -1e-12L) kept.push_back(i);
  std::sort(kept.begin(), kept.end(), [&](Eigen::Index i, Eigen::Index j) {
    return solver.eigenvalues()[i].imag() < solver.eigenvalues()[j].imag();
  });
  const auto narrow = [](const std::complex<Real>& z) {
    return std::complex<double>(static_cast<double>(z.real()), static_cast<double>(z.imag()));
  };
  for (std::size_t m = 0; m < table.eigenvalue.size(); ++m) {
    table.eigenvalue[m] = narrow(solver.eigenvalues()[kept[m]]);
    for (int i = 0; i < kStages; ++i) {
      table.mode[m][static_cast<std::size_t>(i)] = narrow(vectors(i, kept[m]));
      table.dual[m][static_cast<std::size_t>(i)] = narrow(inverse(kept[m], i));
    }
  }
  return table;
}

}  // namespace

const Collocation& collocation() {
  static const Collocation table = make_collocation();
  return table;
}

}  // namespace vibratory_alignment
