// Energy ledger of a trial (MODEL.md "Energy ledger"), integrated over the segments by quadrature: an account of its
// own that does not use the equations of motion, so that its residual judges them. Only of an implicit step it takes
// the damper's force from the N that acts, for the velocities show what the step passes over (docs/implicit_steps.md).
#pragma once

#include <array>
#include <optional>

#include "mechanics/system.h"
#include "solver/base_recovery.h"
#include "solver/segment.h"
#include "trial/outcome.h"

namespace vibratory_alignment {

class EnergyAccount {
 public:
  explicit EnergyAccount(const System& system) : system_(system) {}

  /// Books a segment that has been passed to its end.
  void book(const Segment& segment);
  /// The gripper's anchor has moved: the energy that this puts into the spring counts as work of the excitation.
  void move_anchor_y(double anchor_y, const State& state);
  EnergyLedger ledger() const;

 private:
  using Relaxations = std::array<std::optional<Relaxation>, kSiteCount>;

  double mechanical(const State& state) const;
  Relaxations relaxations_in(const Segment& segment) const;
  void book_powers(const Segment& segment, const Relaxations& relaxations, double t, double weight);

  System system_;
  EnergyLedger ledger_;
  std::array<double, kSiteCount> base_energy_{};  ///< at the end of the last segment
  bool started_ = false;
};

}  // namespace vibratory_alignment
