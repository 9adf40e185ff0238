// Newton's method on the equations of an implicit step with one Jacobian for all stages but for friction in the tanh
// layer, which every stage takes at its own V: T = -f N tanh(V/eps) changes from stage to stage as nothing else does
// (docs/implicit_steps.md).
#pragma once

#include "mechanics/octet_forces.h"
#include "solver/stage_modes.h"

namespace vibratory_alignment {

class LayerCoupling {
 public:
  explicit LayerCoupling(const System& system) : system_(system) {}

  /// For a step with these modes of the Jacobian at its start, where the forces are `start`.
  void set(const StageModes& modes, double h, const ForceJacobian& jacobian, const Forces& start);

  /// The modes' correction where the stages have these forces, and `acting` are the normal forces that act.
  VIBRATORY_ALIGNMENT_INLINE void correction(const Stages& residual, const ForcesOctet& forces,
                                             const NormalForcesOctet& acting, Stages& correction) const {
    modes_->correction(residual, correction);
    if (jacobian_->layer_count > 0) correct_layer(residual, forces, acting, correction);
  }

 private:
  [[gnu::noinline]] void correct_layer(const Stages& residual, const ForcesOctet& forces,
                                       const NormalForcesOctet& acting, Stages& correction) const;
  template <std::size_t kMost>
  VIBRATORY_ALIGNMENT_INLINE void correct_layer_of(const Stages& residual, const ForcesOctet& forces,
                                                   const NormalForcesOctet& acting, Stages& correction) const;

  const System& system_;
  const StageModes* modes_ = nullptr;
  double h_ = 0.0;
  const ForceJacobian* jacobian_ = nullptr;
  const Forces* start_ = nullptr;
  /// What pushes at layer contact [d] make of N and V at contact [c].
  std::array<std::array<StageModes::Rows, kSiteCount>, kSiteCount> normal_, slip_;
};

}  // namespace vibratory_alignment
