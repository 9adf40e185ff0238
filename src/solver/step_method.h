// One step of a method with a fixed step: what the solvers rk4, semi_implicit and ode differ in. What they share, the
// loop of the steps and the book of the contacts, is in fixed_step.h (docs/solvers.md).
#pragma once

#include "solver/contact_book.h"
#include "solver/drive_loads.h"

namespace vibratory_alignment {

/// What holds at the start of a step.
struct StepStart {
  const System& system;
  const SiteTable& sites;
  const ContactBook& book;   ///< with the state
  const DriveLoads& drives;  ///< at(t), t after the start
  double duration;           ///< of the step, > 0
};

class StepMethod {
 public:
  virtual ~StepMethod() = default;

  /// Computes a step. Fills in `segment` the end, order, series and loaded contacts (their phase and slip as they are
  /// during the step); cos and sin of the tilt are left to the caller. Sets `slip_at_end` of every loaded contact.
  /// Returns the number of evaluations of the forces. A result that is not finite is a failure, which the caller
  /// reports. Depends on nothing but its arguments and what it was made with.
  virtual int step(const StepStart& start, Segment& segment, std::array<Slip, kSiteCount>& slip_at_end) = 0;
};

/// The series of a step: polynomials up to power segment.order that take given values at both ends.
inline void set_constant(Series& series, int order, double value) {
  series[0] = value;
  for (int k = 1; k <= order; ++k) series[static_cast<std::size_t>(k)] = 0.0;
}

inline void set_line(Series& series, int order, double begin, double end, double duration) {
  set_constant(series, order, begin);
  series[1] = (end - begin) / duration;
}

/// Cubic with given slopes at both ends.
inline void set_cubic(Series& series, int order, double begin, double slope_begin, double end, double slope_end,
                      double duration) {
  const double chord = (end - begin) / duration;
  set_constant(series, order, begin);
  series[1] = slope_begin;
  series[2] = (3.0 * chord - 2.0 * slope_begin - slope_end) / duration;
  series[3] = (slope_begin + slope_end - 2.0 * chord) / (duration * duration);
}

}  // namespace vibratory_alignment
