// A trial that people interfere with: a simulation read off at regular instants, whose excitation and press may change
// between two samples, and which can start again.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "model/scene.h"
#include "trial/sampler.h"
#include "trial/simulation.h"

namespace vibratory_alignment {

/// All numbers dimensionless. Changes enter at the instant of the sample that next() gave last, or as far beyond it as
/// a call of next() that gave none has come.
class TrialRun {
 public:
  /// Samples lie at n * interval, as `align trial --sample` has them. Throws as Simulation does.
  TrialRun(const Scene& scene, double interval);
  TrialRun(const TrialRun&) = delete;
  TrialRun& operator=(const TrialRun&) = delete;

  /// The next sample, the start of the trial first. False when the trial has ended, when `go_on`, asked now and then,
  /// said no, or when there is none up to the instant `latest` (Sampler::next): then it is not there yet, and the next
  /// call goes on from where this one was.
  bool next(Sample& sample, const std::function<bool()>& go_on = {},
            double latest = std::numeric_limits<double>::infinity());

  /// Instant of the next sample, unless the trial ends before it.
  double next_time() const;

  /// Instant of the last sample.
  double time() const { return last_.time; }

  bool ended() const { return ended_; }

  void set_excitations(const std::vector<Excitation>& excitations);
  void set_pressing_force(double pressing_force);

  /// Starts again as if the scene had had the present excitations and pressing force from the beginning. Throws as
  /// Simulation does; then the trial goes on as it was.
  void restart() { restart(scene_.trial); }

  /// The same with other limits.
  void restart(const TrialSettings& limits);

  /// Of the trial up to the last sample; the sums of the solver's steps and of the energy are up to a step further.
  TrialResult result() const;

 private:
  void apply_changes();

  Scene scene_;  ///< with all changes
  double interval_;
  std::optional<Simulation> simulation_;
  std::optional<Sampler> sampler_;
  Sample last_;                                  ///< that next() gave
  std::array<double, kSpotCount> peak_force_{};  ///< of all samples
  long sample_count_ = 0;
  bool ended_ = false;
  bool excitations_changed_ = false, pressing_force_changed_ = false;
};

}  // namespace vibratory_alignment
