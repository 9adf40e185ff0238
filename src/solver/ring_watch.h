// Solver `implicit`: while the base rings the series follow, and implicit steps pass over what is left of the ring
// (docs/implicit_steps.md "Rings").
#pragma once

#include "solver/implicit_step.h"

namespace vibratory_alignment {

class RingWatch {
 public:
  /// True when the next step in contact is one of the series.
  bool series_follow() const { return series_follow_; }

  /// The normal forces jump, or velocities have to: the base rings.
  void ring();

  /// Bounds of the implicit step that is due, of at most `longest`.
  StepBounds bounds(double longest) const;

  /// An implicit step was taken; `follows_base`: it is so short that it follows the base.
  void settle_implicit(bool follows_base);

  /// An implicit step was given up.
  void give_up_implicit();

  /// The series go `step`. True when it is to be asked whether what still rings can be passed over.
  bool asks(double step);

  /// What still rings can be passed over.
  void pass_over();

 private:
  bool series_follow_ = false;
  bool first_ = false;        ///< the implicit step that is due is the first one after steps of the series
  double series_step_ = 0.0;  ///< last step of the series; 0 before there was one
  int short_steps_ = 0;       ///< implicit steps in a row that followed the base
  int most_short_steps_ = 2;  ///< of these, before the series follow instead
  int steps_ = 0, wait_ = 0;  ///< of the series since an implicit step was given up, and before the next one
};

}  // namespace vibratory_alignment
