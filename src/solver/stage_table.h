// The tables of the collocation (solver/collocation.h) laid out for values at all stages at once: an Octet holds what
// belongs to the stages, in the last place that of the last stage once more; or the modes of A, real parts of the four
// before imaginary ones; or the powers of t.
#pragma once

#include "mechanics/octet.h"
#include "solver/collocation.h"

namespace vibratory_alignment {

struct StageTable {
  static constexpr std::size_t kStages = Collocation::kStages;
  static constexpr std::size_t kModes = 1 + Collocation::kPairs;
  static_assert(kStages + 1 == Octet::kSize && 2 * kModes == Octet::kSize);

  Octet node;
  std::array<Octet, kStages> velocity, position;  ///< by stage j, what a_j counts at every stage
  Octet at_start;                                 ///< what a_j counts at 0; last place 0
  Octet last_power;                               ///< what a_j counts in the highest power of t; last place 0
  std::array<Octet, kStages> acceleration_power;  ///< by stage j, what a_j counts in every power of t; last place 0
  std::array<Octet, kStages> lagrange;            ///< by power of t, its coefficient in the polynomial that is 1 at j
  std::array<Octet, kStages + 1> value_power;     ///< likewise of the values at 0 and the stages
  Quad eigenvalue_real, eigenvalue_imaginary, weight;  ///< of the modes; a complex one comes with its conjugate
  std::array<Octet, kStages> to_modes;                 ///< by stage j, what a value there counts in the modes
  std::array<Octet, 2 * kModes>
      from_modes;                      ///< by part of a mode, what it counts at every stage, weight and sign included
  std::array<Octet, kStages> mode;     ///< by stage i, its part of every mode
  std::array<Octet, 2 * kModes> dual;  ///< by part of a mode, to_modes and its sign for every stage j; last place 0
};

/// The tables, computed once.
const StageTable& stage_table();

/// sum_j columns_j values_j
template <std::size_t kCount>
VIBRATORY_ALIGNMENT_INLINE Octet combine(const std::array<Octet, kCount>& columns, const Octet& values) {
  Octet sum = columns[0] * values[0];
  for (std::size_t j = 1; j < kCount; ++j) sum += columns[j] * values[j];
  return sum;
}

/// Of values at the stages, whose last one is there twice.
VIBRATORY_ALIGNMENT_INLINE double weighted_sum(const Octet& weights, const Octet& values) {
  return sum(weights * values);
}

}  // namespace vibratory_alignment
