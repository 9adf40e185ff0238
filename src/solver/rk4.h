// Solver `rk4`: the classical Runge-Kutta method on the whole right-hand side, contacts and regularised friction
// included (docs/solvers.md "rk4").
#pragma once

#include "solver/step_method.h"

namespace vibratory_alignment {

class Rk4 final : public StepMethod {
 public:
  /// `step`: on which the width of the friction layer depends where the scene gives none.
  explicit Rk4(double step) : step_(step) {}

  int step(const StepStart& start, Segment& segment, std::array<Slip, kSiteCount>& slip_at_end) override;

 private:
  double step_;
};

}  // namespace vibratory_alignment
