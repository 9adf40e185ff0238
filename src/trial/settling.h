// When a motion has settled: at rest, or repeating itself period after period (docs/hybrid_step.md "Settled motion").
//
// The state is compared once per period of the excitation with that of up to 8 periods before (subharmonics). It has
// settled when over 16 such instants every difference D is below
//     min(1e-9, 0.01 / R^2),  R = periods left until the time limit,
// and D does not grow in any coordinate; 1e-13, the rounding of a place, counts as none. So neither the drift that is
// left (R D) nor one that feeds on itself (D' ~ D^2, which needs about 1/sqrt(D) periods to get away) can still take
// the part anywhere before the time limit, up to some 3e5 periods.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "model/scene.h"
#include "solver/segment.h"

namespace vibratory_alignment {

class SettlingWatch {
 public:
  SettlingWatch(const std::vector<Excitation>& excitations, double time_limit);

  /// Starts anew with other excitations from `now` on. Sweeps that have begun before go on (same_sweep).
  void restart(const std::vector<Excitation>& excitations, double now);

  /// Books the segment after those booked before. The time since its start at which the motion has settled, if it has
  /// in this one. Of more than 1024 instants in one segment it looks at as many only.
  std::optional<double> book(const Segment& segment);

  /// Takes back the last segment, which has been cut and is booked once more.
  void take_back();

  bool settled() const { return seen_.settled; }

 private:
  static constexpr int kSubharmonics = 8;
  static constexpr int kInstants = 16;
  static constexpr int kHistory = kSubharmonics + kInstants;

  /// How far instants have been seen.
  struct Seen {
    long next = 0;  ///< index of the next instant
    long from = 0;  ///< index of the first instant in a row
    bool settled = false;
  };

  State& state_of(long index) { return states_[static_cast<std::size_t>(index % kHistory)]; }
  void see(const State& state);
  void compare();
  /// Of x, y and phi, with their rates.
  std::array<double, 3> differences(const State& a, const State& b) const;

  double time_limit_;
  std::vector<Excitation> excitations_;
  std::vector<double> sweep_ends_;  ///< of each excitation; 0 where it is no chirp
  double period_ = 0.0;             ///< common period of the excitations, 0: they have none
  double begin_ = 0.0;
  double rate_ = 1.0;        ///< fastest excitation, to weigh velocities
  Seen seen_, seen_before_;  ///< with the last segment, and without it
  std::array<State, kHistory> states_;
  std::array<State, kHistory> replaced_;  ///< the first of states_ that those of the last segment replaced
  long replaced_count_ = 0;
};

/// Common period of all excitations with an amplitude, up to 1000 periods of the slowest; without any, a sixteenth of
/// the gripper's own period 2 pi (a motion without excitation that repeats itself after any time does so for ever); 0
/// when the frequencies have no such common measure.
double common_period(const std::vector<Excitation>& excitations);

/// Period of the slowest excitation.
double slowest_period(const std::vector<Excitation>& excitations);

}  // namespace vibratory_alignment
