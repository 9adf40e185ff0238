#include "solver/gauss_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vibratory_alignment {
namespace {

using Real = long double;

constexpr std::size_t kTableCount = (GaussTable::kMost - GaussTable::kLeast) / GaussTable::kStep + 1;
constexpr Real kPi = 3.14159265358979323846264338327950288L;

using Polynomials = std::array<Real, GaussTable::kMost + 1>;

/// Legendre polynomials P_0 ... P_n at x.
Polynomials legendre(std::size_t n, Real x) {
  Polynomials p{1.0L, x};
  for (std::size_t k = 1; k < n; ++k) {
    const auto degree = static_cast<Real>(k);
    p[k + 1] = ((2.0L * degree + 1.0L) * x * p[k] - degree * p[k - 1]) / (degree + 1.0L);
  }
  return p;
}

/// P_n'(x), |x| < 1.
Real slope(std::size_t n, Real x, const Polynomials& p) {
  return static_cast<Real>(n) * (x * p[n] - p[n - 1]) / (x * x - 1.0L);
}

/// Zero i of P_n, in rising order, by Newton's method from its asymptotic place.
Real zero(std::size_t n, std::size_t i) {
  Real x = -std::cos(kPi * (static_cast<Real>(i) + 0.75L) / (static_cast<Real>(n) + 0.5L));
  for (int iteration = 0; iteration < 8; ++iteration) {
    const Polynomials p = legendre(n, x);
    x -= p[n] / slope(n, x, p);
  }
  return x;
}

GaussTable make(std::size_t n) {
  GaussTable table;
  table.count = n;
  std::array<Real, GaussTable::kMost> node, weight;
  std::array<Polynomials, GaussTable::kMost> p;
  table.barycentric[0] = n % 2 == 0 ? 1.0 : -1.0;  // 1/P_n(-1)
  for (std::size_t i = 0; i < n; ++i) {
    node[i] = zero(n, i);
    p[i] = legendre(n, node[i]);
    const Real steep = slope(n, node[i], p[i]);
    weight[i] = 2.0L / ((1.0L - node[i] * node[i]) * steep * steep);
    table.node[i / Octet::kSize][i % Octet::kSize] = static_cast<double>(node[i]);
    table.weight[i / Octet::kSize][i % Octet::kSize] = static_cast<double>(weight[i]);
    table.barycentric[i + 1] = static_cast<double>(1.0L / (steep * (node[i] + 1.0L)));
    for (std::size_t k = 0; k < 2; ++k)
      table.last[k][i / Octet::kSize][i % Octet::kSize] =
          static_cast<double>((static_cast<Real>(n - 2 + k) + 0.5L) * weight[i] * p[i][n - 2 + k]);
  }
  // a polynomial through values at the nodes is the sum of its coefficients (k + 1/2) weight P_k(node) times P_k, whose
  // integral is (P_(k+1) - P_(k-1))/(2 k + 1)
  using Values = std::array<double, GaussTable::kMost>;
  std::array<Values, GaussTable::kMost> integral_of_p;  // times k + 1/2
  for (std::size_t i = 0; i < n; ++i) {
    integral_of_p[0][i] = static_cast<double>(0.5L * (node[i] + 1.0L));
    for (std::size_t k = 1; k < n; ++k) integral_of_p[k][i] = static_cast<double>(0.5L * (p[i][k + 1] - p[i][k - 1]));
  }
  for (std::size_t j = 0; j < n; ++j) {
    Values sum{};
    for (std::size_t k = 0; k < n; ++k) {
      const auto coefficient = static_cast<double>(weight[j] * p[j][k]);
      for (std::size_t i = 0; i < n; ++i) sum[i] += coefficient * integral_of_p[k][i];
    }
    for (std::size_t i = 0; i < n; ++i) table.integral[j][i / Octet::kSize][i % Octet::kSize] = sum[i];
  }
  return table;
}

template <std::size_t kCount>
const GaussTable& table_of() {
  static const GaussTable table = make(kCount);
  return table;
}

template <std::size_t... kIndex>
constexpr auto tables(std::index_sequence<kIndex...>) {
  return std::array{&table_of<GaussTable::kLeast + kIndex * GaussTable::kStep>...};
}

}  // namespace

const GaussTable& gauss_table(std::size_t count) {
  constexpr auto kTables = tables(std::make_index_sequence<kTableCount>());
  const std::size_t least = std::max(count, GaussTable::kLeast) - GaussTable::kLeast;
  return kTables[std::min((least + GaussTable::kStep - 1) / GaussTable::kStep, kTableCount - 1)]();
}

}  // namespace vibratory_alignment
