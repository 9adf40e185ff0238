// Polynomials on [0, 1] by their Bernstein coefficients: g = sum b_j C(n, j) t^j (1 - t)^(n - j). The polynomial lies
// between the least and the largest of them, far closer than the powers tell where large terms cancel, and it has at
// most as many zeros as they have changes of sign, and as many but for an even number (docs/hybrid_step.md "Finding
// events"; Farouki, The Bernstein polynomial basis: a centennial retrospective, CAGD 29, 2012).
#pragma once

#include <array>

#include "solver/series.h"

namespace vibratory_alignment {

/// Bounds of a polynomial on [0, 1].
struct Range {
  double low, high;
};

struct BernsteinForm {
  int degree = 0;
  alignas(32) std::array<double, kMaxOrder / 4 * 4 + 4> b;  ///< up to `degree`; the rest is room for four at a time

  double at_start() const { return b[0]; }
  double at_end() const { return b[static_cast<std::size_t>(degree)]; }
};

/// Of g (powers up to `order`).
void set_bernstein(const Series& g, int order, BernsteinForm& form);

Range range_of(const BernsteinForm& form);

/// Changes of sign from each coefficient to the next, zeros left out. Of none g has no zero in (0, 1), of one it has
/// one; of more it may have as many, or fewer by an even number.
int sign_changes(const BernsteinForm& form);

/// Where the line through the coefficients, b_j at j/n, first changes its sign: near a zero. `form` has such a change.
double zero_of_coefficients(const BernsteinForm& form);

/// The left and right half of [0, 1], each as a form on [0, 1]: means of neighbours (de Casteljau).
void halve(const BernsteinForm& whole, BernsteinForm& left, BernsteinForm& right);

}  // namespace vibratory_alignment
