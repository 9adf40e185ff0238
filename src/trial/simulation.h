// One trial while it runs: solver plus everything that watches it (impacts, peaks, mode, energy, outcome).
// Front ends drive it segment by segment, or through a Sampler at regular instants.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mechanics/system.h"
#include "model/scene.h"
#include "solver/segment.h"
#include "trial/outcome.h"

namespace vibratory_alignment {

struct SimulationOptions {
  bool energy = true;           ///< keep the ledger
  std::optional<double> until;  ///< run exactly to this time, whatever the outcome
};

class Simulation {
 public:
  /// Throws SceneError when the scene has no start (no y_touch, no static equilibrium) and std::invalid_argument for an
  /// unknown solver. Allocates here and in set_excitations(), and else only for more than 1024 changes of mode.
  explicit Simulation(const Scene& scene, const SimulationOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Books the current segment (peaks, energy, outcome) and computes the next one. False when the trial has ended.
  [[gnu::noinline]] bool advance();

  /// The segment that the motion is in; valid after the first advance().
  const Segment& segment() const;

  /// Ends the current segment at time t inside it, so that changes enter at t. The next advance() starts there. With a
  /// t outside, or none at all (NaN, infinite), nothing is cut: changes enter at the segment's end.
  void cut(double t);

  /// Changes of the running excitation and press; call them between cut() and advance() or before the first advance().
  /// They enter where the current segment ends, also where that is cut once more. The phase of an excitation stays
  /// continuous when its frequency changes; a sweep of other frequencies or time begins anew. Where fewer excitations
  /// are given than the scene has, the others go on.
  void set_excitations(const std::vector<Excitation>& excitations);
  void set_pressing_force(double pressing_force);

  const Scene& scene() const;
  /// What the scene has become for the solver; its `start` is that of the trial, its axes follow set_pressing_force().
  const System& system() const;
  /// End of what has been booked so far.
  double time() const;
  State state() const;
  bool ended() const;
  Mode mode() const;  ///< up to segment(), in its contacts; once ended() that of the result
  long impacts(Spot spot) const;
  /// The result so far; final once ended() is true.
  TrialResult result() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vibratory_alignment
