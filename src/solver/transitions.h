// What an event does: a pure function from the contacts before it to the contacts after it
// (docs/hybrid_step.md "Transitions").
#pragma once

#include "solver/contact_events.h"

namespace vibratory_alignment {

/// Everything discrete that the hybrid state holds.
struct ContactMode {
  ContactStates contacts;
  Pins pins;
  Recoveries recoveries;
};

/// The mode after `events` at the segment's end state; `before` is the mode during the segment with its recoveries
/// as they are at the end. Friction of every loaded contact is decided anew. Event kinds are made definite: a V = 0
/// event becomes stick or slip_reversal.
ContactMode apply_events(const System& system, const Segment& segment, const ContactMode& before,
                         const DriveForms& drives_at_end, FoundEvents& events);

/// Decides the friction of every loaded contact anew in `state`: the forces have jumped without an event.
void decide_friction_anew(const System& system, const State& state, const DriveForms& drives, ContactMode& mode);

/// What the base keeps of its deformation when the contact at `site` is released.
Recovery release_recovery(const System& system, const State& state, Site site, Face face);

/// The mode of a start: loaded contacts get their sliding direction, or stick.
ContactMode start_mode(const System& system, const State& start, const DriveForms& drives);

/// The state with the last digits of V taken out of sticking contacts.
State hold_sticking(const System& system, const State& state, const ContactStates& contacts);

}  // namespace vibratory_alignment
