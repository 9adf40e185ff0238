// How far the power series of a step in contact hold, and whether a few more of their terms bring what ends the step
// within reach (docs/hybrid_step.md "Step").
#pragma once

#include "solver/motion_series.h"

namespace vibratory_alignment {

class SeriesReach : public OrderChoice {
 public:
  /// Truncation errors: of a step, relative to the motion (in a scene with the tanh law of one in the layer), and of
  /// friction in the layer, relative to its limit.
  SeriesReach(const System& system, double tolerance, double force_tolerance);

  /// Time over which the series of the segment hold.
  double time(const Segment& segment) const;

  /// Begins a step of at most `longest`.
  void begin(double longest) {
    longest_ = longest;
    more_ = 0;
  }

  /// The power to go on to: that of the segment, where nothing is to be gained.
  [[gnu::noinline]] int next_order(const Segment& segment) override;

  /// Time over which the series of the last next_order() hold.
  double last_time() const { return last_time_; }

 private:
  /// Powers of a step at the end of which it may end, as in an impact, and of one that nothing ends, as in a ring.
  struct Orders {
    int impact = 0, ring = 0;
  };

  double layer_step(const Segment& segment) const;
  Orders orders_for(const Segment& segment) const;
  bool may_go_on(const Segment& segment) const;
  static bool is_in_layer(const Segment& segment);
  static double last_terms(const Segment& segment);
  bool ends_by(const Segment& segment, double time) const;

  const System& system_;
  double tolerance_, outer_tolerance_;  ///< of a step, and of one in which no contact is in the tanh layer
  double force_tolerance_;
  Orders straight_, turning_;
  double longest_ = 0.0, last_time_ = 0.0;
  bool rings_ = false;  ///< nothing was near that would have ended the last step of which that was asked
  int more_ = 0;        ///< powers beyond those asked for at first
};

}  // namespace vibratory_alignment
