// The invariants that every single piece of a motion keeps: finite numbers, N >= 0, |T| <= f N, T V <= 0, and nobody
// inside the other body unnoticed. Geometry and base law are those of test/support/touch_point.h.
//
// Everything is allowed its last digits and what the solver's tolerance cuts off, no more: a depth is known to 1e-13 of
// the lengths that it is the difference of, so a force only to the base's stiffness times that.
#pragma once

#include <optional>

#include "fault.h"
#include "mechanics/system.h"
#include "solver/segment.h"

namespace vibratory_alignment::hunt {

/// What a trial is known to.
struct Digits {
  double tolerance;  ///< the solver's
  double fastest;    ///< largest speed of the part's points so far
  /// Places are known to the tolerance, also in the series that go on from an implicit step.
  bool by_implicit_steps = false;
};

/// The first breach in the segment, at its ends and some instants between.
std::optional<Fault> check_segment(const System& system, const Digits& digits, const Segment& segment);

/// Energy that the last digits of places in this segment are worth, and the creep of what sticks for the last
/// digits of its forces: what a ledger cannot know.
double energy_noise(const System& system, const Segment& segment);

}  // namespace vibratory_alignment::hunt
