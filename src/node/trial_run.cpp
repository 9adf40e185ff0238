#include "node/trial_run.h"

#include <algorithm>
#include <utility>

namespace vibratory_alignment {

TrialRun::TrialRun(const Scene& scene, double interval) : scene_(scene), interval_(interval) { restart(); }

void TrialRun::restart(const TrialSettings& limits) {
  Scene scene = scene_;
  scene.trial = limits;
  Simulation simulation(scene);
  scene_ = std::move(scene);
  sampler_.reset();
  simulation_.emplace(std::move(simulation));
  sampler_.emplace(*simulation_, interval_);
  last_ = {};
  peak_force_ = {};
  sample_count_ = 0;
  ended_ = excitations_changed_ = pressing_force_changed_ = false;
}

void TrialRun::set_excitations(const std::vector<Excitation>& excitations) {
  scene_.excitations = excitations;
  excitations_changed_ = true;
}

void TrialRun::set_pressing_force(double pressing_force) {
  scene_.gripper.pressing_force = pressing_force;
  scene_.gripper.anchor_y.reset();
  pressing_force_changed_ = true;
}

void TrialRun::apply_changes() {
  if (!excitations_changed_ && !pressing_force_changed_) return;
  if (sample_count_ == 0) return restart();
  // it may have come further than the last sample
  simulation_->cut(std::max(sampler_->time(), simulation_->segment().start.value()));
  if (excitations_changed_) simulation_->set_excitations(scene_.excitations);
  if (pressing_force_changed_) simulation_->set_pressing_force(*scene_.gripper.pressing_force);
  excitations_changed_ = pressing_force_changed_ = false;
}

bool TrialRun::next(Sample& sample, const std::function<bool()>& go_on, double latest) {
  if (ended_) return false;
  apply_changes();
  if (!sampler_->next(sample, go_on, latest)) {
    ended_ = sampler_->finished();
    return false;
  }
  ++sample_count_;
  last_ = sample;
  raise_peaks(sample, peak_force_);
  ended_ = sample.is_last;
  return true;
}

TrialResult TrialRun::result() const {
  TrialResult result = simulation_->result();
  if (ended_) return result;
  result.final_time = last_.time;
  result.final_state = last_.state;
  result.mode = last_.mode;
  result.impacts = last_.impacts;
  result.peak_force = peak_force_;
  const double largest = *std::max_element(peak_force_.begin(), peak_force_.end());
  result.force_limit_exceeded = scene_.trial.force_limit && largest > *scene_.trial.force_limit;
  return result;
}

double TrialRun::next_time() const { return static_cast<double>(sample_count_) * interval_; }

}  // namespace vibratory_alignment
