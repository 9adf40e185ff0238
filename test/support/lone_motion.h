// A FreeMotion with waves of its own, for what asks one axis for its motion at one time.
#pragma once

#include "mechanics/free_motion.h"

namespace vibratory_alignment::test {

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

  double acceleration(double t) const {
    Waves::Values values;
    waves_.at(t, values);
    double q = 0.0, v = 0.0;
    FreeMotion::at(t, values, q, v);
    return FreeMotion::acceleration(t, values, q, v);
  }

 private:
  Waves waves_;
};

}  // namespace vibratory_alignment::test
