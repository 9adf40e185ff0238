// Solver `semi_implicit`: the symplectic Euler method with dampers and friction solved for in the velocities at the end
// of the step; friction is set-valued, |T| <= f N, and what sticks has V = 0 there (docs/solvers.md "semi_implicit").
#pragma once

#include "solver/step_method.h"

namespace vibratory_alignment {

class SemiImplicit final : public StepMethod {
 public:
  int step(const StepStart& start, Segment& segment, std::array<Slip, kSiteCount>& slip_at_end) override;
};

}  // namespace vibratory_alignment
