// Newton's method on the equations of an implicit step with one Jacobian for all stages but for friction in the tanh
// layer, which every stage takes at its own V: T = -f N tanh(V/eps) changes from stage to stage as nothing else does
// (docs/implicit_steps.md).
#pragma once

#include "solver/stage_modes.h"

namespace vibratory_alignment {

/// Forces at the stages of a step, and normal forces there.
using StageForces = Collocation::Vector<Forces>;
using StageNormals = Collocation::Vector<NormalForces>;

class LayerCoupling {
 public:
  explicit LayerCoupling(const System& system) : system_(system) {}

  /// For a step with these modes of the Jacobian at its start, where the forces are `start`.
  void set(const StageModes& modes, double h, const ForceJacobian& jacobian, const Forces& start);

  /// The modes' correction where the stages have these forces, and `acting` are the normal forces that act.
  Stages correction(const Stages& residual, const StageForces& forces, const StageNormals& acting) const;

 private:
  static constexpr int kMost = Collocation::kStages * kSiteCount;

  const System& system_;
  const StageModes* modes_ = nullptr;
  double h_ = 0.0;
  const ForceJacobian* jacobian_ = nullptr;
  const Forces* start_ = nullptr;
  /// What pushes at layer contact [d] make of N and V at contact [c].
  std::array<std::array<StageModes::StageMatrix, kSiteCount>, kSiteCount> normal_, slip_;
};

}  // namespace vibratory_alignment
