// Which contacts stick: the friction problem at V = 0 (MODEL.md "Contact", "Settled readings").
//
// Among the contacts whose sliding velocity is zero, find tangential forces |T_i| <= limit_i = f N_i with
//     V'_i = g_i + sum_j G_ij T_j,   V'_i = 0 where |T_i| < limit_i,   V'_i >= 0 where T_i = -limit_i,
//     V'_i <= 0 where T_i = +limit_i
// (the friction opposes the motion that is about to start). G is symmetric and positive semidefinite, so this is the
// minimum of 1/2 T.G.T + g.T in a box: it always exists and V' is unique.
#pragma once

#include <array>

#include "mechanics/contact.h"

namespace vibratory_alignment {

struct FrictionProblem {
  int count = 0;
  std::array<std::array<double, kSiteCount>, kSiteCount> mobility{};  ///< G
  std::array<double, kSiteCount> drift{};                             ///< g
  std::array<double, kSiteCount> drift_scale{};                       ///< size of the terms that g is the sum of
  std::array<double, kSiteCount> limit{};                             ///< f N, >= 0
};

struct FrictionSolution {
  std::array<Slip, kSiteCount> slip{};     ///< stick, or the direction in which sliding starts
  std::array<double, kSiteCount> force{};  ///< T
};

FrictionSolution solve_friction(const FrictionProblem& problem);

/// Solves G T = rhs for the first `count` unknowns; where G is singular (contacts that hold the same motion) the
/// smallest forces: they share equally. Not finite where a single contact cannot hold its motion at all (G = 0).
void solve_mobility(const std::array<std::array<double, kSiteCount>, kSiteCount>& mobility, int count,
                    const std::array<double, kSiteCount>& rhs, std::array<double, kSiteCount>& force);

}  // namespace vibratory_alignment
