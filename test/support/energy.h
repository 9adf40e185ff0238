// Energy of the part and its springs, summed up from the state and the depths, without the ledger.
#pragma once

#include <cmath>

#include "model/scene.h"
#include "solver/segment.h"

namespace vibratory_alignment::test {

/// At the end of the segment: kinetic energy and springs of the gripper, weight, springs of an isotropic base.
inline double energy(const Scene& s, const Segment& g) {
  const State& q = g.end;
  double e = 0.5 * q.vy * q.vy + 0.5 * std::pow(q.y - *s.gripper.anchor_y, 2) + s.weight * q.y;
  if (s.gripper.x.moves) e += 0.5 * q.vx * q.vx + 0.5 * s.gripper.x.stiffness * std::pow(q.x - s.gripper.anchor_x, 2);
  if (s.gripper.phi.moves)
    e += 0.5 * s.gripper.phi.inertia * q.omega * q.omega +
         0.5 * s.gripper.phi.stiffness * std::pow(q.phi - s.gripper.anchor_phi, 2);
  for (int i = 0; i < g.loaded_count; ++i) {
    const double d = contact_at(g, i, g.duration).depth;
    e += 0.5 * s.base.stiffness_y * d * d;
  }
  return e;
}

}  // namespace vibratory_alignment::test
