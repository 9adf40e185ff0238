// Random bits as a function of a number, the same on every machine: the output function of splitmix64 (Steele, Lea,
// Flood, "Fast splittable pseudorandom number generators", 2014).
#pragma once

#include <cstdint>

namespace vibratory_alignment {

constexpr std::uint64_t kSplitmixStride = 0x9E3779B97F4A7C15u;

/// One to one; neighbouring numbers give unrelated bits.
constexpr std::uint64_t scrambled(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

/// In [0, 1), from the highest 53 bits.
constexpr double unit_number(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1.0p-53; }

}  // namespace vibratory_alignment
