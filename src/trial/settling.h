// When a motion has settled: at rest, or repeating itself period after period (docs/hybrid_step.md "Settled motion").
//
// The state is compared once per period of the excitation with that of up to 8 periods before (subharmonics). It has
// settled when over 16 such instants every difference D is below
//     min(1e-9, 0.01 / R^2),  R = periods left until the time limit,
// and D does not grow; 1e-13, the rounding of a place, counts as none. So neither the drift that is left (R D) nor one
// that feeds on itself (D' ~ D^2, which needs about 1/sqrt(D) periods to get away) can still take the part anywhere
// before the time limit, up to some 3e5 periods.
#pragma once

#include <array>
#include <vector>

#include "model/scene.h"
#include "solver/segment.h"

namespace vibratory_alignment {

class SettlingWatch {
 public:
  SettlingWatch(const std::vector<Excitation>& excitations, double time_limit);

  /// Starts anew with other excitations from `now` on. Sweeps that have begun before go on (same_sweep).
  void restart(const std::vector<Excitation>& excitations, double now);

  /// Books a segment that has been passed to its end.
  void book(const Segment& segment);

  bool settled() const { return settled_; }

 private:
  static constexpr int kSubharmonics = 8;
  static constexpr int kInstants = 16;
  static constexpr int kHistory = kSubharmonics + kInstants;

  void compare();
  double difference(const State& a, const State& b) const;

  double time_limit_;
  std::vector<Excitation> excitations_;
  std::vector<double> sweep_ends_;  ///< of each excitation; 0 where it is no chirp
  double period_ = 0.0;             ///< common period of the excitations, 0: they have none
  double begin_ = 0.0;
  double rate_ = 1.0;  ///< fastest excitation, to weigh velocities
  long next_ = 0;      ///< index of the next instant
  std::array<State, kHistory> history_;
  bool settled_ = false;
};

/// Common period of all excitations with an amplitude; without any, a sixteenth of the gripper's own period 2 pi (a
/// motion without excitation that repeats itself after any time does so for ever); 0 when the frequencies have no
/// common measure.
double common_period(const std::vector<Excitation>& excitations);

/// Period of the slowest excitation.
double slowest_period(const std::vector<Excitation>& excitations);

}  // namespace vibratory_alignment
