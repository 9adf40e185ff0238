// A trial that people interfere with: a simulation read off at regular instants, whose excitation and press may change
// between two samples, and which can start again.
#pragma once

#include <optional>
#include <vector>

#include "model/scene.h"
#include "trial/sampler.h"
#include "trial/simulation.h"

namespace vibratory_alignment {

/// All numbers dimensionless. Changes enter at the instant of the sample that next() gave last.
class TrialRun {
 public:
  /// Samples lie at n * interval, as `align trial --sample` has them. Throws as Simulation does.
  TrialRun(const Scene& scene, double interval);
  TrialRun(const TrialRun&) = delete;
  TrialRun& operator=(const TrialRun&) = delete;

  /// The next sample, the start of the trial first. False when the trial has ended.
  bool next(Sample& sample);

  /// Instant of the next sample, unless the trial ends before it.
  double next_time() const;

  /// Instant of the last sample.
  double time() const { return time_; }

  bool ended() const { return ended_; }

  void set_excitations(const std::vector<Excitation>& excitations);
  void set_pressing_force(double pressing_force);

  /// Starts again as if the scene had had the present excitations and pressing force from the beginning. Throws as
  /// Simulation does; then the trial goes on as it was.
  void restart();

  /// Puts another scene in the place of this one, at its start. Throws as Simulation does; then nothing changes.
  void change_scene(const Scene& scene, double interval);

  /// Of the trial so far.
  TrialResult result() const { return simulation_->result(); }

 private:
  void begin(Simulation simulation);
  void apply_changes();

  Scene scene_;  ///< with all changes
  double interval_;
  std::optional<Simulation> simulation_;
  std::optional<Sampler> sampler_;
  long sample_count_ = 0;
  double time_ = 0.0;
  bool ended_ = false;
  bool excitations_changed_ = false, pressing_force_changed_ = false;
};

}  // namespace vibratory_alignment
