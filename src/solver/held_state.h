// The state of a part that sticks.
#pragma once

#include "mechanics/contact.h"
#include "mechanics/state.h"
#include "mechanics/system.h"

namespace vibratory_alignment {

/// hold_sticking() where a contact sticks.
State take_out_slip(const System& system, const State& state, const ContactStates& contacts);

/// The state with the last digits of V taken out of sticking contacts, along M^-1 t: an impulse of the friction.
inline State hold_sticking(const System& system, const State& state, const ContactStates& contacts) {
  for (const ContactState& contact : contacts)
    if (contact.slip == Slip::stick) return take_out_slip(system, state, contacts);
  return state;
}

}  // namespace vibratory_alignment
