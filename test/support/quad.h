// Numbers of 113 bits, for reference values that must be right in the last digit of a double.
#pragma once

#include <vector>

namespace vibratory_alignment::test {

__extension__ typedef __float128 Quad;

/// 2 pi as the sum of three doubles.
inline Quad two_pi() {
  return static_cast<Quad>(6.283185307179586232) + static_cast<Quad>(2.449293598294706414e-16) +
         static_cast<Quad>(-5.989539619436679332e-33);
}

/// The angle in [0, 2 pi).
inline Quad wrapped(Quad angle) {
  const Quad turns = angle / two_pi();
  const auto whole = static_cast<long long>(turns);
  const Quad rest = angle - static_cast<Quad>(whole) * two_pi();
  return rest < 0 ? rest + two_pi() : rest;
}

using QuadMatrix = std::vector<std::vector<Quad>>;

inline QuadMatrix product(const QuadMatrix& a, const QuadMatrix& b) {
  const std::size_t n = a.size();
  QuadMatrix c(n, std::vector<Quad>(n, 0));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k)
      if (a[i][k] != 0)
        for (std::size_t j = 0; j < n; ++j) c[i][j] += a[i][k] * b[k][j];
  return c;
}

/// exp(a): Taylor series of a / 2^m, squared m times.
inline QuadMatrix exponential(QuadMatrix a) {
  const std::size_t n = a.size();
  Quad norm = 0;
  for (const auto& row : a) {
    Quad sum = 0;
    for (const Quad entry : row) sum += entry < 0 ? -entry : entry;
    if (sum > norm) norm = sum;
  }
  int squarings = 0;
  for (; norm > static_cast<Quad>(0.125); norm /= 2) ++squarings;
  for (auto& row : a)
    for (Quad& entry : row)
      for (int i = 0; i < squarings; ++i) entry /= 2;
  QuadMatrix sum(n, std::vector<Quad>(n, 0)), term = sum;
  for (std::size_t i = 0; i < n; ++i) sum[i][i] = term[i][i] = 1;
  for (int k = 1; k <= 26; ++k) {
    term = product(term, a);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) sum[i][j] += (term[i][j] /= static_cast<Quad>(k));
  }
  for (int i = 0; i < squarings; ++i) sum = product(sum, sum);
  return sum;
}

}  // namespace vibratory_alignment::test
