// Eight numbers at once: values at the stages of an implicit step. All go through the same operations.
#pragma once

#include <cmath>
#include <cstddef>

#include "mechanics/quad.h"

namespace vibratory_alignment {

struct Octet {
  static constexpr std::size_t kSize = 8;

  Quad low, high;

  Octet() = default;  ///< not initialised; Octet{}: zeros
  VIBRATORY_ALIGNMENT_INLINE Octet(double all) : low{all, all, all, all}, high{all, all, all, all} {}
  VIBRATORY_ALIGNMENT_INLINE Octet(const Quad& first, const Quad& last) : low(first), high(last) {}

  VIBRATORY_ALIGNMENT_INLINE double operator[](std::size_t i) const { return reinterpret_cast<const double*>(this)[i]; }
  VIBRATORY_ALIGNMENT_INLINE double& operator[](std::size_t i) { return reinterpret_cast<double*>(this)[i]; }

  VIBRATORY_ALIGNMENT_INLINE Octet& operator+=(const Octet& other) {
    low += other.low;
    high += other.high;
    return *this;
  }
  VIBRATORY_ALIGNMENT_INLINE Octet& operator-=(const Octet& other) {
    low -= other.low;
    high -= other.high;
    return *this;
  }
};

VIBRATORY_ALIGNMENT_INLINE Octet operator-(const Octet& a) { return {-a.low, -a.high}; }
VIBRATORY_ALIGNMENT_INLINE Octet operator+(const Octet& a, const Octet& b) { return {a.low + b.low, a.high + b.high}; }
VIBRATORY_ALIGNMENT_INLINE Octet operator-(const Octet& a, const Octet& b) { return {a.low - b.low, a.high - b.high}; }
VIBRATORY_ALIGNMENT_INLINE Octet operator*(const Octet& a, const Octet& b) { return {a.low * b.low, a.high * b.high}; }
VIBRATORY_ALIGNMENT_INLINE Octet operator/(const Octet& a, const Octet& b) { return {a.low / b.low, a.high / b.high}; }

VIBRATORY_ALIGNMENT_INLINE Octet abs(const Octet& a) {
  return {a.low < 0.0 ? -a.low : a.low, a.high < 0.0 ? -a.high : a.high};
}

/// Each `a`, but 0 where `what` is at most `limit`; what is no number stays so.
VIBRATORY_ALIGNMENT_INLINE Octet zero_up_to(const Octet& limit, const Octet& what, const Octet& a) {
  return {what.low <= limit.low ? Quad{} : a.low, what.high <= limit.high ? Quad{} : a.high};
}

/// Largest and sum of the eight; the largest is any of them if one is no number.
VIBRATORY_ALIGNMENT_INLINE double largest(const Octet& a) {
  const Quad most = a.low > a.high ? a.low : a.high;
  const double left = most[0] > most[1] ? most[0] : most[1], right = most[2] > most[3] ? most[2] : most[3];
  return left > right ? left : right;
}
VIBRATORY_ALIGNMENT_INLINE double sum(const Octet& a) {
  const Quad both = a.low + a.high;
  return (both[0] + both[1]) + (both[2] + both[3]);
}
VIBRATORY_ALIGNMENT_INLINE bool all_finite(const Octet& a) { return std::isfinite(sum(a)); }

}  // namespace vibratory_alignment
