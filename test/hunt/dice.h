// Random numbers that are the same on every machine: splitmix64 (Steele, Lea, Flood 2014), one stream a seed.
#pragma once

#include <cmath>
#include <cstdint>

namespace vibratory_alignment::hunt {

class Dice {
 public:
  /// Scrambled, for the streams of one orbit would overlap.
  explicit Dice(std::uint64_t seed) : state_(scrambled(seed + kStride)) {}

  /// In [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Every decade between `low` and `high` is as likely.
  double decades(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  bool chance(double probability) { return uniform() < probability; }
  /// 0 ... count - 1.
  int below(int count) { return static_cast<int>(uniform() * count); }

 private:
  static constexpr std::uint64_t kStride = 0x9E3779B97F4A7C15u;

  static std::uint64_t scrambled(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }

  std::uint64_t next() { return scrambled(state_ += kStride); }

  std::uint64_t state_;
};

}  // namespace vibratory_alignment::hunt
