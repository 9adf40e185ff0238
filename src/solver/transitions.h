// What an event does: it changes the contacts before it to the contacts after it
// (docs/hybrid_step.md "Transitions").
#pragma once

#include "solver/contact_events.h"
#include "solver/friction_choice.h"

namespace vibratory_alignment {

/// Changes `mode`, that during the segment with its recoveries as they are at the end, to that after `events` at the
/// segment's end state. Friction is decided anew for every loaded contact that sticks or whose V is zero. Event kinds
/// are made definite: a V = 0 event becomes stick or slip_reversal.
[[gnu::noinline]] void apply_events(const System& system, const Segment& segment, const DriveForms& drives_at_end,
                                    FrictionChoice& friction, FoundEvents& events, ContactMode& mode);

/// Decides friction anew at the segment's end: the forces have jumped without an event. `zero_slip`: contacts whose V
/// is known to be zero.
void decide_friction_anew(const System& system, const Segment& segment, const DriveForms& drives,
                          const SiteFlags& zero_slip, FrictionChoice& friction, ContactMode& mode);

/// How far T of what sticks is beyond f N at the segment's start, at most, as a share of the f N that the next `step`
/// sees. T of contacts that hold nearly the same motion is not known to the last digit while that motion is; where it
/// becomes known it may be too large.
double excess_friction(const System& system, const Segment& segment, double step);

/// The mode of a start: loaded contacts get their sliding direction, or stick.
ContactMode start_mode(const System& system, const State& start, const DriveForms& drives, FrictionChoice& friction);

}  // namespace vibratory_alignment
