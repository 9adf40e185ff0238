// Powers of two and their logarithms to a few digits, read off the bits of a number: for sizes that are compared.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

namespace vibratory_alignment {

/// Base-2 logarithm of a normal positive number, too small by at most 0.09: exponent and leading digits. Zero counts as
/// 2^-1023.
inline double rough_log2(double value) {
  std::int64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return static_cast<double>(bits) * 0x1p-52 - 1023.0;
}

/// 2^exponent to 0.33 %; infinity from 2^1024 on, and 2^-1022 at least. What is not a number stays so.
inline double rough_exp2(double exponent) {
  if (!(exponent < 1024.0)) return exponent > 0.0 ? INFINITY : exponent;
  if (exponent < -1022.0) return 0x1p-1022;
  const auto towards_zero = static_cast<std::int64_t>(exponent);
  const std::int64_t whole = towards_zero - (static_cast<double>(towards_zero) > exponent ? 1 : 0);
  const double part = exponent - static_cast<double>(whole);
  const std::int64_t bits = (whole + 1023) << 52;
  double power = 0.0;
  std::memcpy(&power, &bits, sizeof power);
  return power * (1.0 + part * (0.6565 + 0.3435 * part));
}

}  // namespace vibratory_alignment
