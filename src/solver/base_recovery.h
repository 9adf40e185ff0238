// A base that recovers (base.recovery): once the part has left it, its deformation u along the normal of the face it
// was under relaxes as u' = -(k/h) u (MODEL.md: the paper's base is massless, N = k u + h u' = 0). k and h are those
// along the normal of now: on a face of the part it turns, and where the base is not stiff and damped alike in all
// directions k/h changes with it. So long as the part could push no force on its foot, N < 0 of the motion of now, it
// is apart from the base as well: for g = u - d, h g' + k g = -N (docs/hybrid_step.md "Guards").
#pragma once

#include "mechanics/system.h"
#include "solver/contact_point.h"
#include "solver/segment.h"

namespace vibratory_alignment {

/// A deformation that is nothing (relative to lengths of order one).
inline constexpr double kNoDeformation = 1e-18;

/// True for a base that recovers at once under `face` at the tilt given: undamped, or faster than anything to be seen.
bool recovers_at_once(const System& system, Face face, double cos_phi, double sin_phi);

/// What a base that recovers keeps of a deformation under `face` that nothing holds any more: nothing where it recovers
/// at once, or of what is none.
Recovery left_behind(const System& system, double deformation, Face face, double cos_phi, double sin_phi);

/// k/h of a face at a tilt, 1/time, and its derivative by phi.
struct RelaxationRate {
  double value, slope;
};
RelaxationRate relaxation_rate(const System& system, Face face, double cos_phi, double sin_phi);

/// Bounds on the first and the second of its derivatives by phi, at any tilt.
struct RelaxationBounds {
  double slope, bend;
};
RelaxationBounds relaxation_bounds(const System& system, Face face);

/// True when k/h of `face` is the same however the part turns.
bool recovers_evenly(const System& system, Face face);

/// The series of u from the segment's start on, to the order of the segment, whose cos and sin of phi are known; at
/// rates so high that their powers might overflow to a lower one.
Series deformation_series(const System& system, const Segment& segment, const Recovery& recovery);

/// How u goes on in a segment that starts with `recovery`: u(t) = u(0) exp(-integral of k/h from 0 to t). The rate of a
/// base that does not recover evenly is taken from the segment's series, which a leap in flight does not have.
class Relaxation {
 public:
  Relaxation(const System& system, const Segment& segment, const Recovery& recovery);

  double deformation_at(double t) const;

 private:
  double start_;
  int order_;
  Series exponent_;  ///< the integral of k/h, up to this power
};

/// How far deformation_series() holds: no farther than h/k, and than the series of k/h does to the relative error
/// given.
double recovery_step(const System& system, const Segment& segment, const Recovery& recovery, double tolerance);

/// u after `elapsed`, from the states at both ends: exact where the base recovers evenly, otherwise k/h is integrated
/// by the trapezoid rule with corrected ends, of order 4.
double deformation_between(const System& system, const Recovery& recovery, const PlacedState& from,
                           const PlacedState& to, double elapsed);

}  // namespace vibratory_alignment
