// Everything discrete that the hybrid state holds besides the motion: which law holds at every site, and what is known
// to be exactly zero because an event has just put it there.
#pragma once

#include <array>

#include "mechanics/contact.h"

namespace vibratory_alignment {

/// Zeros that the guards of a site are known to have at the start of a segment.
struct SitePins {
  int normal = 0;                     ///< of N (loaded) or of the force that would load (unloaded)
  int slip = 0;                       ///< of V
  int hold_plus = 0, hold_minus = 0;  ///< of f N - T and f N + T
  Face face = Face::none;             ///< the face on which an outside point lies
};
using Pins = std::array<SitePins, kSiteCount>;

/// A base that recovers (base_recovery.h): what a site has left behind, at the start of a segment.
struct Recovery {
  double deformation = 0.0;  ///< u along the normal of `face`; 0: nothing
  Face face = Face::none;
};
using Recoveries = std::array<Recovery, kSiteCount>;

struct ContactMode {
  ContactStates contacts;
  Pins pins;
  Recoveries recoveries;
  double unheld_slip_rate = 0.0;  ///< V' of what sticks that no T took out when friction was decided last
};

}  // namespace vibratory_alignment
