// How exactly the series of a segment are known: what rounding leaves undetermined in forces and sliding velocities.
// The state counts as exact, but for what an event has just brought to zero: there its own rounding shows.
#pragma once

#include "mechanics/system.h"
#include "solver/segment.h"

namespace vibratory_alignment {

/// Errors during [0, h], at most. A coefficient g_k with |g_k| h^k below the error of g is no more than rounding.
struct SeriesNoise {
  double h = 0.0;
  std::array<double, kSiteCount> normal_force{};  ///< N, per entry of segment.loaded
  std::array<double, kSiteCount> slip_rate{};     ///< V'
  std::array<double, kSiteCount> mobility{};      ///< V' per unit of T
  double held_slip_rate = 0.0;                    ///< V' of what sticks, after T has taken out what it can
  /// What the rounding of the state makes of a contact's own N, and of its V' through it.
  std::array<double, kSiteCount> state_normal_force{}, state_slip_rate{};

  bool is_finite() const;
};

/// Factor on rounding up to which limits of T are asked: beyond it T of any size would be at its limit on a stiff base,
/// where N is about to be zero.
constexpr double kMostLimitAllowance = 1e2;

/// `allowance`: factor on all errors; on those of the state at most kMostLimitAllowance.
SeriesNoise series_noise(const System& system, const Segment& segment, double h, double allowance);

}  // namespace vibratory_alignment
