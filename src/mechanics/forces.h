// The equations of motion at one state (MODEL.md "Free motion", "Contact"): accelerations and contact forces, with the
// law that holds at each contact given.
#pragma once

#include "mechanics/contact_frame.h"
#include "mechanics/drive.h"

namespace vibratory_alignment {

struct ContactForce {
  Site site = Site::a1;
  double depth = 0.0;             ///< d
  double normal_force = 0.0;      ///< N = k d + h d', not cut off at zero
  double tangential_force = 0.0;  ///< T
  double friction_ratio = 0.0;    ///< T/N; 0 where the contact sticks
  double slip_velocity = 0.0;     ///< V
};

struct Forces {
  double ax = 0.0, ay = 0.0, alpha = 0.0;  ///< x'', y'', phi''
  int count = 0;
  std::array<ContactForce, kSiteCount> contact;  ///< of the loaded sites, in their order
};

/// `drive`: forces of the excitations at this instant. Sticking contacts get the T that keeps V' = 0.
void evaluate_forces(const System& system, const State& state, const Load3& drive, const ContactStates& contacts,
                     Forces& forces);

}  // namespace vibratory_alignment
