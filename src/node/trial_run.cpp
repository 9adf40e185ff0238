#include "node/trial_run.h"

#include <utility>

namespace vibratory_alignment {

TrialRun::TrialRun(const Scene& scene, double interval) : scene_(scene), interval_(interval) { restart(); }

void TrialRun::restart() { begin(Simulation(scene_)); }

void TrialRun::change_scene(const Scene& scene, double interval) {
  Simulation simulation(scene);
  scene_ = scene;
  interval_ = interval;
  begin(std::move(simulation));
}

void TrialRun::begin(Simulation simulation) {
  sampler_.reset();
  simulation_.emplace(std::move(simulation));
  sampler_.emplace(*simulation_, interval_);
  sample_count_ = 0;
  time_ = 0.0;
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
  simulation_->cut(sampler_->time());
  if (excitations_changed_) simulation_->set_excitations(scene_.excitations);
  if (pressing_force_changed_) simulation_->set_pressing_force(*scene_.gripper.pressing_force);
  excitations_changed_ = pressing_force_changed_ = false;
}

bool TrialRun::next(Sample& sample) {
  if (ended_) return false;
  apply_changes();
  if (!sampler_->next(sample)) {
    ended_ = true;
    return false;
  }
  ++sample_count_;
  time_ = sample.time;
  ended_ = sample.is_last;
  return true;
}

double TrialRun::next_time() const { return static_cast<double>(sample_count_) * interval_; }

}  // namespace vibratory_alignment
