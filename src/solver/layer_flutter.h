// A contact in the tanh layer whose ring grows: N and V drive each other through friction (docs/implicit_steps.md "What
// rings and grows"). The method of an implicit step would damp what it does not follow.
#pragma once

#include "mechanics/force_jacobian.h"

namespace vibratory_alignment {

/// True when N and V of the only contact that the part has, which is in the tanh layer, ring with an amplitude that
/// grows, and too fast for a step of length h to follow. `jacobian`: of the accelerations there. False for several
/// contacts.
bool flutters_within(double h, const ForceJacobian& jacobian);

}  // namespace vibratory_alignment
