// What a contact's force adds up to during a piece of a segment, from the series of the force.
#pragma once

#include "mechanics/system.h"
#include "solver/segment.h"

namespace vibratory_alignment {

/// Integrals over time. World axes x right, y up; force of the base on the part.
struct ContactImpulse {
  double normal = 0.0;      ///< of N >= 0
  double friction = 0.0;    ///< of T, along t (MODEL.md "Contact")
  double x = 0.0, y = 0.0;  ///< of N n + T t

  ContactImpulse& operator+=(const ContactImpulse& other);
};

/// Of loaded contact `i` of the segment from `from` to `to` after its start.
ContactImpulse contact_impulse(const System& system, const Segment& segment, int i, double from, double to);

}  // namespace vibratory_alignment
