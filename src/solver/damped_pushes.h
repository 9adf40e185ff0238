// Normal forces of a few contacts at once that push and never pull, in an implicit step: a linear complementarity
// problem
//
//     N_i = max(0, a_i - h_i sum_j G_ij N_j)
//
// with a_i = k d_i + h_i d'_i, d' without contacts, and G_ij = what a unit of N_j takes off d'_i: symmetric, positive
// semidefinite. I + h G, h diagonal, is then a P-matrix, and the answer is unique.
#pragma once

#include "mechanics/mobility.h"

namespace vibratory_alignment {

struct DampedPushes {
  int count = 0;
  Mobility::Matrix mobility{};  ///< G [velocity per force]
  Mobility::Vector offered{};   ///< a
  Mobility::Vector damping{};   ///< h >= 0
};

/// N of all contacts.
Mobility::Vector solve_damped_pushes(const DampedPushes& problem);

}  // namespace vibratory_alignment
