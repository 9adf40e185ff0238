// Length of a step from the power series of the motion itself.
#pragma once

#include "solver/segment.h"

namespace vibratory_alignment {

/// Longest time over which the last two terms of every velocity's series stay below `tolerance` times that velocity's
/// largest leading term: the truncation error relative to each axis' own motion, whatever its scale.
/// Infinity for an axis at rest.
double series_step(const Segment& segment, double tolerance);

/// The part of `step` (finite) in which the tilt changes so little that the series of cos phi and sin phi, cut off at the
/// segment's order, are exact to `tolerance`; so are their products with a translation of the given `rate`, rad per unit
/// of time.
double limit_turn(const Segment& segment, double tolerance, double step, double rate);

/// Order of the series for a tolerance: each further order costs its share, each further digit is worth so many.
int series_order(double tolerance);

}  // namespace vibratory_alignment
