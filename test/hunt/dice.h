// Random numbers that are the same on every machine: splitmix64, one stream a seed.
#pragma once

#include <cmath>
#include <cstdint>

#include "study/scramble.h"

namespace vibratory_alignment::hunt {

class Dice {
 public:
  /// Scrambled, for the streams of one orbit would overlap.
  explicit Dice(std::uint64_t seed) : state_(scrambled(seed + kSplitmixStride)) {}

  /// In [0, 1).
  double uniform() { return unit_number(next()); }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Every decade between `low` and `high` is as likely.
  double decades(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  bool chance(double probability) { return uniform() < probability; }
  /// 0 ... count - 1.
  int below(int count) { return static_cast<int>(uniform() * count); }

 private:
  std::uint64_t next() { return scrambled(state_ += kSplitmixStride); }

  std::uint64_t state_;
};

}  // namespace vibratory_alignment::hunt
