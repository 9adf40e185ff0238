// The state of a part that sticks.
#pragma once

#include "mechanics/contact.h"
#include "mechanics/state.h"
#include "mechanics/system.h"

namespace vibratory_alignment {

/// The state with the last digits of V taken out of sticking contacts, along M^-1 t: an impulse of the friction.
State hold_sticking(const System& system, const State& state, const ContactStates& contacts);

}  // namespace vibratory_alignment
