// Numbers of 113 bits, for reference values that must be right in the last digit of a double.
#pragma once

#include <vector>

namespace vibratory_alignment::test {

__extension__ typedef __float128 Float128;

/// 2 pi as the sum of three doubles.
inline Float128 two_pi() {
  return static_cast<Float128>(6.283185307179586232) + static_cast<Float128>(2.449293598294706414e-16) +
         static_cast<Float128>(-5.989539619436679332e-33);
}

/// The angle in [0, 2 pi).
inline Float128 wrapped(Float128 angle) {
  const Float128 turns = angle / two_pi();
  const auto whole = static_cast<long long>(turns);
  const Float128 rest = angle - static_cast<Float128>(whole) * two_pi();
  return rest < 0 ? rest + two_pi() : rest;
}

using Float128Matrix = std::vector<std::vector<Float128>>;

inline Float128Matrix product(const Float128Matrix& a, const Float128Matrix& b) {
  const std::size_t n = a.size();
  Float128Matrix c(n, std::vector<Float128>(n, 0));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k)
      if (a[i][k] != 0)
        for (std::size_t j = 0; j < n; ++j) c[i][j] += a[i][k] * b[k][j];
  return c;
}

/// exp(a): Taylor series of a / 2^m, squared m times.
inline Float128Matrix exponential(Float128Matrix a) {
  const std::size_t n = a.size();
  Float128 norm = 0;
  for (const auto& row : a) {
    Float128 sum = 0;
    for (const Float128 entry : row) sum += entry < 0 ? -entry : entry;
    if (sum > norm) norm = sum;
  }
  int squarings = 0;
  for (; norm > static_cast<Float128>(0.125); norm /= 2) ++squarings;
  for (auto& row : a)
    for (Float128& entry : row)
      for (int i = 0; i < squarings; ++i) entry /= 2;
  Float128Matrix sum(n, std::vector<Float128>(n, 0)), term = sum;
  for (std::size_t i = 0; i < n; ++i) sum[i][i] = term[i][i] = 1;
  for (int k = 1; k <= 26; ++k) {
    term = product(term, a);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) sum[i][j] += (term[i][j] /= static_cast<Float128>(k));
  }
  for (int i = 0; i < squarings; ++i) sum = product(sum, sum);
  return sum;
}

}  // namespace vibratory_alignment::test
