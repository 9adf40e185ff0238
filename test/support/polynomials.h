// Polynomials for the tests of root finding: made from known roots, evaluated in 113 bits.
#pragma once

#include <vector>

#include "quad.h"
#include "solver/series.h"

namespace vibratory_alignment::test {

/// factor * (roots[0] - t) (roots[1] - t) ..., rounded once at the end.
inline Series from_roots(const std::vector<double>& roots, double factor = 1.0) {
  std::vector<Float128> c(1, factor);
  for (const double root : roots) {
    c.push_back(0);
    for (std::size_t k = c.size() - 1; k > 0; --k) c[k] = c[k] * Float128(root) - c[k - 1];
    c[0] *= Float128(root);
  }
  Series series{};
  for (std::size_t k = 0; k < c.size(); ++k) series[k] = static_cast<double>(c[k]);
  return series;
}

inline Float128 exact_value(const Series& g, int order, double t) {
  Float128 value = 0;
  for (int k = order; k >= 0; --k) value = value * Float128(t) + Float128(g[static_cast<std::size_t>(k)]);
  return value;
}

/// The last digits of g at t: eps * sum |g_k| t^k.
inline double noise(const Series& g, int order, double t) {
  double sum = 0.0, power = 1.0;
  for (int k = 0; k <= order; ++k, power *= t) {
    const double term = g[static_cast<std::size_t>(k)] * power;
    sum += term < 0.0 ? -term : term;
  }
  return 2.3e-16 * sum;
}

}  // namespace vibratory_alignment::test
