// What happens next in a flight, told by bounds on third derivatives that hold for all of it: how long nothing can
// happen, and, where it is certain, the event after that (docs/hybrid_step.md "Leaps").
#pragma once

#include "solver/contact_events.h"
#include "solver/flight.h"

namespace vibratory_alignment {

struct FlightOutlook {
  double time = 0.0;   ///< from the segment's start: nothing happens before it
  bool lands = false;  ///< an event happens at `time`
  Event event;
  State end;  ///< the state at `time`
};

/// Looks from time t of the flight, at which its state is `state` (without velocity in coordinates that do not move),
/// at most `longest` ahead. `longest` is reached only when nothing happens until then; a shorter time without event
/// tells nothing about what follows. `recoveries`: what sites have left behind at t; none of these is seen to land.
[[gnu::noinline]] FlightOutlook look_ahead(const System& system, const Flight& flight, double t, const State& state,
                                           const ContactStates& contacts, const Pins& pins,
                                           const Recoveries& recoveries, const OutcomeGuards& outcomes, double longest);

}  // namespace vibratory_alignment
