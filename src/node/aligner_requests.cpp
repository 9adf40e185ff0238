// What services, settings and the action do to the trial.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "model/scaling.h"
#include "node/align_goal.h"
#include "node/aligner.h"

namespace vibratory_alignment {
namespace {

/// Samples of one step: as many as a subscriber's queue takes, so that none is lost, and the node soon answers again.
constexpr long kLongestStep = kQueueSize;
constexpr std::chrono::seconds kSteppingTurn(2);  ///< of wall time, then others get theirs
constexpr char kEnded[] = "the trial has ended; reset it first";
constexpr char kNotStarted[] = "not started yet";

}  // namespace

/// Before what goes on with the trial: publishes its start, where nobody has to be waited for. The last attempt may
/// have found that there is none.
void Aligner::begin() {
  if (activity_ == Activity::waiting) wait_for_subscribers();
  if (activity_ == Activity::paused && !samples_.has_last()) show_start();
}

bool Aligner::on_start(Trigger::Request&, Trigger::Response& response) {
  begin();
  response.success = activity_ != Activity::ended && start_fault_.empty();
  if (activity_ == Activity::waiting) {
    parameters_.autostart = true;
    response.message = "starts as soon as the subscribers are there";
  } else if (!response.success) {
    response.message = activity_ == Activity::ended ? kEnded : start_fault_;
  } else {
    if (activity_ == Activity::paused) run();
    response.message = "running";
  }
  return true;
}

bool Aligner::on_pause(Trigger::Request&, Trigger::Response& response) {
  response.success = activity_ != Activity::ended;
  if (activity_ == Activity::waiting) parameters_.autostart = false;
  if (activity_ == Activity::running) set_activity(Activity::paused);
  response.message = response.success ? "paused at " + time_text() : "the trial has ended";
  return true;
}

bool Aligner::on_step(Trigger::Request&, Trigger::Response& response) {
  response.message = refusal_to_step();
  response.success = response.message.empty();
  if (response.success) response.message = place_after(step(1));
  return true;
}

/// Why no step is possible now; empty if one is.
std::string Aligner::refusal_to_step() {
  begin();
  if (activity_ == Activity::ended) return kEnded;
  return activity_ == Activity::waiting ? kNotStarted : start_fault_;
}

/// Pauses, and publishes up to so many samples.
Aligner::Steps Aligner::step(long samples) {
  set_activity(Activity::paused);
  const Clock::time_point turn_end = Clock::now() + kSteppingTurn;
  const auto go_on = [&] { return Clock::now() < turn_end && not_interrupted()(); };
  Steps steps;
  while (steps.published < samples && activity_ == Activity::paused) {
    if (steps.published == samples - 1) next_picture_ = {};
    if (!go_on() || !publish_next(go_on)) break;
    ++steps.published;
  }
  steps.cut_short = steps.published < samples && activity_ == Activity::paused && Clock::now() >= turn_end;
  return steps;
}

std::string Aligner::place_after(const Steps& steps) const {
  std::ostringstream text;
  text << "at " << time_text();
  if (steps.cut_short) {
    text << "; the solver takes long: " << steps.published << " samples in " << kSteppingTurn.count()
         << " s, ask again for the others";
  }
  return text.str();
}

bool Aligner::on_step_by(StepBy::Request& request, StepBy::Response& response) {
  const bool by_samples = request.samples != 0;
  const double unit = output_units(stage_->scene).time;
  const double samples = by_samples ? request.samples : std::round(request.duration / unit / stage_->interval);
  std::ostringstream fault;
  if (by_samples && request.duration != 0.0) {
    fault << "samples: " << request.samples << " and duration: " << request.duration << ": give one, the other is 0";
  } else if (!(samples >= 1.0 && samples <= kLongestStep)) {
    const double least = by_samples ? 1.0 : stage_->interval * unit;
    fault << (by_samples ? "samples: " : "duration: ") << (by_samples ? request.samples : request.duration)
          << ": must be from " << least << " to " << kLongestStep * least;
    if (!by_samples)
      fault << (stage_->scene.units == Units::si ? " s" : " (dimensionless)") << ", 1 to " << kLongestStep
            << " samples";
  } else {
    fault << refusal_to_step();
  }
  response.success = fault.str().empty();
  response.message = fault.str();
  if (!response.success) return true;
  const Steps steps = step(static_cast<long>(samples));
  response.samples = static_cast<std::uint32_t>(steps.published);
  response.message = place_after(steps);
  return true;
}

bool Aligner::on_reset(Trigger::Request&, Trigger::Response& response) {
  const TrialResult so_far = stage_->trial.result();
  try {
    // the limits of a goal end with its trial, which is what is reset while the goal is active
    if (align_server_.active()) {
      stage_->trial.restart();
    } else {
      stage_->trial.restart(stage_->scene.trial);
    }
  } catch (const std::exception& error) {
    response.success = false;
    response.message = error.what();
    return true;
  }
  if (align_server_.active()) align_server_.abort(stage_->messages, so_far, "the trial was reset");
  parameters_.autostart = false;
  start_fault_.clear();
  announce_restart();
  if (sim_clock_) set_clock_back();
  samples_.forget_last();
  if (activity_ != Activity::waiting) {
    publishers_["markers"].publish(stage_->markers.clear(next_stamp()));
    show_start();
  }
  response.success = true;
  response.message = place_at_start();
  return true;
}

/// A listener of tf2 clears its buffer when it gets a transform and finds the clock behind where it was at the
/// transform before, which it may have got ahead of the clock's last step: so it gets one more, with the clock
/// standing.
void Aligner::set_clock_back() {
  if (samples_.has_last()) samples_.repeat_transform(stage_->messages, stamps_.one_more());
  SimClock::let_arrive();
  sim_clock_->set_back();
}

void Aligner::show_start() {
  set_activity(Activity::paused);
  next_picture_ = {};
  publish_next(not_interrupted());
}

/// A trial may have no start with the present settings, or fail in its first step.
std::string Aligner::place_at_start() const {
  if (activity_ != Activity::ended) return start_fault_.empty() ? "paused at the start" : start_fault_;
  return "the trial fails at the start: " + stage_->trial.result().failure;
}

/// The service ~load_scene.
std::string Aligner::change_scene(const Scene& scene) {
  NodeParameters parameters = parameters_;
  parameters.time_scale = stage_->settings.config().time_scale;
  double interval = interval_of(scene);
  // seconds mean nothing to one of the two
  const bool sets_anew = scene.scales.has_value() != stage_->scene.scales.has_value();
  if (sets_anew) {
    parameters.time_scale = usual_time_scale(scene);
    interval = sample_interval(parameters, scene);
  }
  auto next =
      std::make_unique<Stage>(scene, DriveSettings(scene, parameters.time_scale), TrialLimits(), frames_, interval);
  if (align_server_.active()) align_server_.abort(stage_->messages, stage_->trial.result(), "another scene was loaded");
  parameters_.autostart = false;
  change_stage(std::move(next), true);
  if (sets_anew) interval_ = {stage_->interval, stage_->seconds(1.0)};
  tell_settings();
  if (activity_ != Activity::waiting) show_start();
  return scene.name + ": " + place_at_start();
}

/// Puts a trial in the place of the present one.
void Aligner::change_stage(std::unique_ptr<Stage> next, bool other_scene) {
  if (other_scene) warn_without_scales(next->scene);
  publishers_["markers"].publish(stage_->markers.clear(next_stamp()));
  stage_ = std::move(next);
  start_fault_.clear();
  samples_.forget_last();
  announce_restart();
  if (sim_clock_) sim_clock_->begin_trial();
  if (other_scene) publish_static_transforms();
}

/// Tells dynamic_reconfigure's clients.
void Aligner::tell_settings() {
  settings_server_.updateConfig(stage_->settings.config());
  start_time_scale_.overwritten();
}

void Aligner::on_settings(AlignerConfig& requested) {
  start_time_scale_.overwritten();  // once this returns
  DriveSettings& settings = stage_->settings;
  TrialRun& trial = stage_->trial;
  const AlignerConfig before = settings.config();
  settings.undo_clamping(requested);
  for (const std::string& refusal : settings.change(requested)) ROS_WARN("Refused: %s", refusal.c_str());
  const AlignerConfig& after = settings.config();
  if (after.enabled != before.enabled || after.amplitude != before.amplitude || after.frequency != before.frequency ||
      after.phase != before.phase || after.waveform != before.waveform) {
    trial.set_excitations(settings.excitations());
  }
  if (after.pressing_force != before.pressing_force) trial.set_pressing_force(*settings.pressing_force());
  if (after.time_scale != before.time_scale) {
    const Clock::time_point now = Clock::now();
    const double reached = std::clamp(pacer_.simulated(now), stage_->seconds(trial.time()), next_due());
    pacer_.start(after.time_scale, now, reached);
  }
}

/// Puts the trial of the goal on the stage; spin() starts it.
void Aligner::on_goal(const AlignGoal& goal) {
  const bool other_scene = !goal.scene.empty();
  const GoalPlan plan = plan_goal(goal, stage_->scene, stage_->settings);
  const double interval = other_scene ? interval_of(plan.scene) : stage_->interval;
  auto next = std::make_unique<Stage>(plan.scene, plan.settings, plan.limits, frames_, interval);
  change_stage(std::move(next), other_scene);  // from here on nothing can go wrong
  if (other_scene || goal.set_excitation || goal.set_pressing_force) tell_settings();
  parameters_.autostart = true;
  waiting_since_ = Clock::now();
  set_activity(Activity::waiting);
}

void Aligner::on_cancel() {
  parameters_.autostart = false;
  if (activity_ == Activity::running) set_activity(Activity::paused);
  align_server_.preempt(stage_->messages, stage_->trial.result(), "cancelled at " + time_text());
}

}  // namespace vibratory_alignment
