// Contacts in any state: which sites touch which faces under which law, and a part on a base that is stiffer one way.
#pragma once

#include <cstddef>
#include <vector>

#include "mechanics/contact.h"
#include "mechanics/system.h"
#include "scenes.h"

namespace vibratory_alignment::test {

struct TouchWithSlip {
  Site site;
  Face face;
  Slip slip;
};

inline System anisotropic_system() {
  System system = make_system(scene_of(plain));
  system.has_floor = true;
  system.floor_depth = 0.41;
  system.x.stiffness = 0.7;
  system.x.damping = 0.3;
  system.weight = 0.2;
  system.friction = 0.4;
  system.regularization = 0.5;
  system.stiffness_x = 31.0;
  system.stiffness_y = 17.0;
  system.damping_x = 3.0;
  system.damping_y = 5.0;
  return system;
}

inline ContactStates states_of(const std::vector<TouchWithSlip>& touches) {
  ContactStates contacts{};
  for (const TouchWithSlip& touch : touches) {
    ContactState& contact = contacts[static_cast<std::size_t>(touch.site)];
    contact.phase = Phase::loaded;
    contact.face = touch.face;
    contact.slip = touch.slip;
  }
  return contacts;
}

}  // namespace vibratory_alignment::test
