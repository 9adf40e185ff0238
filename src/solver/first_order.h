// The segment of a step of first order: the forces are those that acted, constant over the step, and everything that
// moves goes in lines from its begin to its end (docs/solvers.md "What they share").
#pragma once

#include "solver/step_method.h"

namespace vibratory_alignment {

/// Sets order, motion and drive; the segment's end is set.
void set_first_order_motion(const StepStart& start, const Load3& drive, Segment& segment);

/// Forces of a contact during a step.
struct StepForces {
  double normal = 0.0, tangential = 0.0;  ///< N, T
  bool sticks = false;                    ///< V = 0 at the end
};

/// Adds a contact that may push, if it is loaded. `end` is the segment's end.
void add_first_order_contact(const StepStart& start, Site site, const StepForces& forces, const PlacedState& end,
                             Segment& segment, std::array<Slip, kSiteCount>& slip_at_end);

}  // namespace vibratory_alignment
