// The fastest motion in a segment's power series, a ring of the base or of the tanh layer, as their last terms show it
// (docs/implicit_steps.md "Rings").
#pragma once

#include "mechanics/system.h"
#include "solver/segment.h"

namespace vibratory_alignment {

/// exp(lambda t), lambda complex or real.
struct FastMotion {
  double rate = 0.0;   ///< |lambda|, in 1/time; 0: there is no motion
  double speed = 0.0;  ///< at the segment's start, measured like StageEquations::size_of
};

/// Of the velocities, as their last four terms tell: these are of the fastest motion alone. The segment's order is at
/// least 3. The speed is that of the larger one of the last two terms: with lambda = -|lambda| exp(i theta) it may be
/// too small, by sin(theta/2). In an impact, where N is no single exponential, it is too small and the rate too large.
[[gnu::noinline]] FastMotion fast_motion(const System& system, const Segment& segment);

/// Bound of the change of a normal force over the time t that its powers from `lowest` on make, as a share of that
/// force: the largest of the contacts.
double normal_force_change(const Segment& segment, double t, int lowest = 1);

}  // namespace vibratory_alignment
