// Length of a step from the power series of the motion itself.
#pragma once

#include "mechanics/system.h"
#include "solver/segment.h"

namespace vibratory_alignment {

/// Truncation error below which rounding is all that is left.
constexpr double kSmallestTolerance = 1e-16;

/// Longest time over which the last two terms of every velocity's series stay below `tolerance` times that velocity's
/// largest leading term: the truncation error relative to each axis' own motion, whatever its scale. Where the last two
/// vanish, as in a function of t^3, the one before them counts; so it does in all of these.
/// Likewise for T of sticking contacts, relative to T and to the force f N that it may reach.
/// Infinity for what is at rest, or held by contacts: what rounding of their forces leaves has no time scale.
[[gnu::noinline]] double series_step(const System& system, const Segment& segment, double tolerance);

/// The same for a step in contact, over which the last two terms of T of every contact in the tanh layer also stay
/// below `force_tolerance` times T and f N: where friction hardly moves the part, its velocities do not tell how far
/// the series of T holds.
[[gnu::noinline]] double contact_step(const System& system, const Segment& segment, double tolerance,
                                      double force_tolerance);

/// Longest time over which the last two terms of a pair of series stay below `tolerance`, absolute.
[[gnu::noinline]] double pair_step(const PairSeries& series, int order, double tolerance);

/// Of a step over which x, y and cos phi, sin phi are these polynomials, the part over which the products of a place
/// with a direction lose less than `tolerance`, absolute, by powers above the order.
[[gnu::noinline]] double turned_place_step(const Segment& segment, const PairSeries& direction, double step,
                                           double tolerance);

/// Order of the series for a tolerance: the number of its digits and a constant, where a step costs least for its
/// length.
int series_order(double tolerance);

/// Order at which the series of a ring hold for so many radians of it: for linear motion, of which a power costs a few
/// products, however high. Where rounding of its terms would leave more than the tolerance, for fewer radians; but the
/// order above at least.
int straight_series_order(double tolerance, double radians);

}  // namespace vibratory_alignment
