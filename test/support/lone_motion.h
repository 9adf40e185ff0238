// A FreeMotion with waves of its own, for what asks one axis for its motion at one time.
#pragma once

#include "mechanics/free_motion.h"

namespace vibratory_alignment::test {

/// An axis that moves.
inline Axis axis_of(double inertia, double damping, double stiffness, double anchor) {
  Axis axis;
  axis.moves = true;
  axis.inertia = inertia;
  axis.inverse_inertia = 1.0 / inertia;
  axis.damping = damping;
  axis.stiffness = stiffness;
  axis.anchor = anchor;
  return axis;
}

class LoneMotion : public FreeMotion {
 public:
  using FreeMotion::FreeMotion;

  void settle() {
    waves_.clear();
    FreeMotion::settle(waves_);
  }

  void at(double t, double& q, double& v) const {
    Waves::Values values;
    waves_.at(t, values);
    FreeMotion::at(t, values, q, v);
  }

  Outlook outlook(double t, double end) const {
    Waves::Values values;
    waves_.at(t, values);
    return FreeMotion::outlook(t, end, values);
  }

 private:
  Waves waves_;
};

}  // namespace vibratory_alignment::test
