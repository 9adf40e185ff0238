// Gauss-Legendre collocation on [-1, 1] with 16 to 56 nodes, laid out for values at eight nodes at once: integrals from
// the start to every node, and the polynomial through the value at the start and those at the nodes (Hairer, Norsett
// and Wanner, Solving Ordinary Differential Equations I, II.7; Berrut and Trefethen, Barycentric Lagrange
// interpolation).
#pragma once

#include <array>
#include <cstddef>

#include "mechanics/octet.h"

namespace vibratory_alignment {

struct GaussTable {
  static constexpr std::size_t kLeast = 16, kMost = 56, kStep = Octet::kSize, kOctets = kMost / kStep;

  std::size_t count = 0;  ///< n, of nodes
  std::array<Octet, kOctets> node, weight;
  /// By node j and octet of nodes i: what a value at j counts in the integral from -1 to i.
  std::array<std::array<Octet, kOctets>, kMost> integral;
  /// What a value at a node counts in the two last coefficients of Legendre polynomials, n - 2 and n - 1.
  std::array<std::array<Octet, kOctets>, 2> last;
  /// Barycentric weights of -1, in the first place, and the nodes.
  std::array<double, kMost + 1> barycentric{};

  std::size_t octets() const { return count / kStep; }
};

/// Of values at the nodes the one at node j.
VIBRATORY_ALIGNMENT_INLINE double of_node(const std::array<Octet, GaussTable::kOctets>& values, std::size_t j) {
  return values[j / Octet::kSize][j % Octet::kSize];
}

/// The table for at least so many nodes (at most kMost), computed on the first call.
const GaussTable& gauss_table(std::size_t count);

}  // namespace vibratory_alignment
