// What happens within a time in which nothing moves coincides (docs/hybrid_step.md, "Coincidence").
#pragma once

#include <cmath>

#include "mechanics/state.h"
#include "mechanics/system.h"

namespace vibratory_alignment {

/// Longest time in which nothing moves; it does all the same where speeds change in it by more than this part of them.
constexpr double kInstant = 1e-15, kNoChange = 1e-9;

/// Speeds of the part, or of their changes: those of its centre and of what turns about it.
inline double speed_scale(const System& system, double vx, double vy, double omega) {
  return std::abs(vx) + std::abs(vy) +
         std::abs(omega) * (system.half_width + system.base_distance + system.slot_half_width);
}

/// True when the changes `dvx`, `dvy`, `domega` of the speeds that the part begins with are nothing to them.
inline bool nothing_moves(const System& system, const State& begin, double dvx, double dvy, double domega) {
  return speed_scale(system, dvx, dvy, domega) <= kNoChange * speed_scale(system, begin.vx, begin.vy, begin.omega);
}

}  // namespace vibratory_alignment
