// The tangential forces that hold sticking contacts (mechanics/holding_forces.h) at eight states at once.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "mechanics/holding_forces.h"
#include "mechanics/octet_forces.h"

namespace vibratory_alignment {

/// A sticking contact: its row of J, and what the velocities alone make of V'.
struct StickingOctet {
  std::size_t index;  ///< in ForcesOctet::contact
  Octet x, y, moment;
  Octet slip_rate;
};

/// Numbers of the axes x, y, phi.
using RowOctet = std::array<Octet, 3>;

VIBRATORY_ALIGNMENT_INLINE Octet dot(const RowOctet& u, const RowOctet& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

/// What forces leave of an acceleration that they change by so much.
VIBRATORY_ALIGNMENT_INLINE void take_out(const Octet& change, Octet& acceleration) {
  const Octet left = acceleration + change;
  acceleration = zero_up_to(kRest * abs(acceleration), abs(left), left);
}

/// As HoldingForces::hold_motion_of_one(). False, with nothing done, where that is delicate.
VIBRATORY_ALIGNMENT_INLINE bool hold_single(const System& system, const StickingOctet& row, ForcesOctet& forces) {
  const SingleHold single = single_hold(system);
  if (single.delicate) return false;
  const Octet of_x = system.x.inverse_inertia * row.x, of_y = system.y.inverse_inertia * row.y,
              of_phi = system.phi.inverse_inertia * row.moment;
  const Octet mobility = of_x * row.x + of_y * row.y + of_phi * row.moment;
  const Octet rate = row.x * forces.ax + row.y * forces.ay + row.moment * forces.alpha;
  const Octet force = zero_up_to(single.least_mobility, mobility, (-rate - row.slip_rate) / mobility);
  forces.contact[row.index].tangential_force = force;
  take_out(of_x * force, forces.ax);
  take_out(of_y * force, forces.ay);
  take_out(of_phi * force, forces.alpha);
  return true;
}

/// Two contacts, whatever motion they leave the part. With a_i the rows of A = J M^-1/2, b the part of a_2 across a_1,
/// a_2 = p a_1 + b, and z = M^1/2 q'',
///     T_2 = -(b.z + s_2 - p s_1)/b.b,    T_1 = -(a_1.z + s_1)/a_1.a_1 - p T_2
/// which forms neither G nor V' (docs/implicit_steps.md). False, with nothing done, where that is delicate: an axis
/// that is not locked is far less mobile than others, or rows of J or A are nearly parallel in a state.
VIBRATORY_ALIGNMENT_INLINE bool hold_pair(const System& system, const StickingOctet& first, const StickingOctet& second,
                                          ForcesOctet& forces) {
  constexpr double kLeastAngle = 1e-2;  // its sine, between the rows of J and those of A
  const double reach = system.half_width + system.base_distance;
  const std::array<double, 3> mobility = {system.x.inverse_inertia, system.y.inverse_inertia,
                                          reach * reach * system.phi.inverse_inertia};
  // a locked axis takes no part
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  std::array<double, 3> free{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(mobility[axis] > 0.0)) continue;
    least = std::min(least, mobility[axis]);
    most = std::max(most, mobility[axis]);
    free[axis] = 1.0;
  }
  if (!(most < kUnequalMobility * least)) return false;
  const double per_reach = free[2] / reach;
  const RowOctet j1 = {free[0] * first.x, free[1] * first.y, per_reach * first.moment},
                 j2 = {free[0] * second.x, free[1] * second.y, per_reach * second.moment};
  const RowOctet across = {j1[1] * j2[2] - j1[2] * j2[1], j1[2] * j2[0] - j1[0] * j2[2], j1[0] * j2[1] - j1[1] * j2[0]};
  const Octet short_of_j = (kLeastAngle * kLeastAngle) * dot(j1, j1) * dot(j2, j2) - dot(across, across);

  const std::array<double, 3> scale = {std::sqrt(system.x.inverse_inertia), std::sqrt(system.y.inverse_inertia),
                                       std::sqrt(system.phi.inverse_inertia)};
  const RowOctet a1 = {scale[0] * first.x, scale[1] * first.y, scale[2] * first.moment},
                 a2 = {scale[0] * second.x, scale[1] * second.y, scale[2] * second.moment};
  const Octet size = dot(a1, a1);
  Octet p{};
  RowOctet b = a2;
  for (int pass = 0; pass < 2; ++pass) {  // what rounding leaves of a_1 is taken out once more
    const Octet along = dot(b, a1) / size;
    p += along;
    for (std::size_t axis = 0; axis < 3; ++axis) b[axis] -= along * a1[axis];
  }
  const Octet rest = dot(b, b), short_of_a = (kLeastAngle * kLeastAngle) * dot(a2, a2) - rest;
  if (!(largest(short_of_j) < 0.0 && largest(short_of_a) < 0.0)) return false;
  const auto over_scale = [&](const Octet& rate, std::size_t axis) {
    return free[axis] > 0.0 ? rate / scale[axis] : Octet{};
  };
  const RowOctet z = {over_scale(forces.ax, 0), over_scale(forces.ay, 1), over_scale(forces.alpha, 2)};
  const Octet of_first = -(dot(a1, z) + first.slip_rate) / size;  // T_1 + p T_2
  const Octet force = -(dot(b, z) + second.slip_rate - p * first.slip_rate) / rest;
  forces.contact[first.index].tangential_force = of_first - p * force;
  forces.contact[second.index].tangential_force = force;
  take_out(scale[0] * (of_first * a1[0] + force * b[0]), forces.ax);
  take_out(scale[1] * (of_first * a1[1] + force * b[1]), forces.ay);
  take_out(scale[2] * (of_first * a1[2] + force * b[2]), forces.alpha);
  return true;
}

/// Any contacts, state by state.
inline void hold_one_by_one(const System& system, const StickingOctet* rows, int count, ForcesOctet& forces) {
  for (std::size_t i = 0; i < Octet::kSize; ++i) {
    HoldingForces::Rows of_state;
    HoldingForces::Vector slip_rates;
    for (std::size_t m = 0; m < static_cast<std::size_t>(count); ++m) {
      of_state[m] = {rows[m].x[i], rows[m].y[i], rows[m].moment[i]};
      slip_rates[m] = rows[m].slip_rate[i];
    }
    HoldingForces holding;
    holding.set(system, of_state, count);
    const HoldingForces::Answer held =
        holding.hold_motion({{}, forces.ax[i], forces.ay[i], forces.alpha[i]}, slip_rates);
    for (std::size_t m = 0; m < static_cast<std::size_t>(count); ++m)
      forces.contact[rows[m].index].tangential_force[i] = held.force[m];
    forces.ax[i] = held.x;
    forces.ay[i] = held.y;
    forces.alpha[i] = held.phi;
  }
}

}  // namespace vibratory_alignment
