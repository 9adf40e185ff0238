// k(n) and h(n) of a base stiffer or more damped one way, along the normal of a face of the part that turns: as series.
#pragma once

#include "mechanics/contact_frame.h"
#include "solver/segment.h"

namespace vibratory_alignment {

/// k(n) = c0 + c1 cos^2 phi on the faces of the part, power k. Power 0 is the sum of squares that it is: where the axis
/// that matters is the softer by far, c0 and c1 cos^2 phi would cancel.
inline void turning_term(const System& system, Face face, int k, const Segment& segment, double& stiffness,
                         double& damping) {
  if (k == 0) {
    stiffness = stiffness_of(system, face, segment.cos_phi[0], segment.sin_phi[0]);
    damping = damping_of(system, face, segment.cos_phi[0], segment.sin_phi[0]);
    return;
  }
  const double square = product_term(segment.cos_phi, segment.cos_phi, k), sign = face == Face::bottom ? 1.0 : -1.0;
  stiffness = sign * (system.stiffness_y - system.stiffness_x) * square;
  damping = sign * (system.damping_y - system.damping_x) * square;
}

}  // namespace vibratory_alignment
