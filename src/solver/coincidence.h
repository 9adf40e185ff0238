// When a state has not moved to speak of (docs/hybrid_step.md, "Coincidence").
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

/// True when two states are the same but for last digits of their positions and what is nothing to their speeds.
inline bool is_unmoved(const System& system, const State& begin, const State& end) {
  constexpr double last_digits = 3e-16;
  const double length = system.half_width + system.base_distance + system.slot_half_width;
  const double way = std::abs(end.x - begin.x) + std::abs(end.y - begin.y) + std::abs(end.phi - begin.phi) * length;
  return way <= last_digits * (std::abs(begin.x) + std::abs(begin.y) + length) &&
         nothing_moves(system, begin, end.vx - begin.vx, end.vy - begin.vy, end.omega - begin.omega);
}

}  // namespace vibratory_alignment
