#include "node/align_server.h"

#include <exception>
#include <limits>
#include <utility>

namespace vibratory_alignment {
namespace {

AlignResult to_result(const Messages& messages, const TrialResult& result, const std::string& text) {
  const AlignerResult trial = messages.result(result, ros::Time());
  AlignResult message;
  message.outcome = trial.outcome;
  message.text = text;
  message.mode = trial.mode;
  message.duration_tau = result.aligned_time.value_or(std::numeric_limits<double>::quiet_NaN());
  message.duration = trial.duration;
  message.tau = trial.tau;
  message.time = trial.time;
  message.peak_force = trial.peak_force;
  message.impacts = trial.impacts;
  message.force_limit_exceeded = trial.force_limit_exceeded;
  message.energy_residual = trial.energy.residual;
  return message;
}

}  // namespace

AlignServer::AlignServer(const ros::NodeHandle& private_handle, double feedback_rate, Begin begin, Stop stop)
    : server_(
          private_handle, "align", [this](Server::GoalHandle handle) { on_goal(std::move(handle)); },
          [this](Server::GoalHandle handle) { on_cancel(std::move(handle)); }, false),
      begin_(std::move(begin)),
      stop_(std::move(stop)),
      feedback_interval_(
          std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / feedback_rate))) {
  server_.start();
}

bool AlignServer::Server::forget_times_to_come() {
  const boost::recursive_mutex::scoped_lock lock(lock_);
  const ros::Time now = ros::Time::now();
  bool any = last_cancel_ > now;
  if (any) last_cancel_ = now;  // else it would cancel all goals to come
  for (auto& status : status_list_) {
    if (status.handle_destruction_time_ <= now) continue;
    status.handle_destruction_time_ = now;
    any = true;
  }
  return any;
}

void AlignServer::on_goal(Server::GoalHandle handle) {
  if (goal_) {
    const std::string busy = "another goal is being carried out (" + goal_->getGoalID().id + "); cancel it or wait";
    ROS_WARN("~align: goal rejected: %s", busy.c_str());
    handle.setRejected(AlignResult(), busy);
    return;
  }
  try {
    begin_(*handle.getGoal());
  } catch (const std::exception& error) {
    ROS_WARN("~align: goal rejected: %s", error.what());
    handle.setRejected(AlignResult(), error.what());
    return;
  }
  handle.setAccepted();
  goal_ = handle;
  sample_.reset();
  peak_force_ = {};
  feedback_due_ = Clock::now();
}

void AlignServer::on_cancel(Server::GoalHandle handle) {
  if (goal_ && handle == *goal_) stop_();
}

void AlignServer::add(const Sample& sample) {
  if (!goal_) return;
  sample_ = sample;
  raise_peaks(sample, peak_force_);
}

void AlignServer::give_feedback(const Messages& messages, bool paused) {
  const Clock::time_point now = Clock::now();
  feedback_due_ += feedback_interval_;
  if (feedback_due_ < now) feedback_due_ = now + feedback_interval_;
  if (!sample_) return;  // it has not started yet
  const AlignerState state = messages.state(*sample_, ros::Time());
  AlignFeedback feedback;
  feedback.progress = state.progress;
  feedback.misalignment = state.misalignment;
  feedback.mode = state.mode;
  feedback.reaction_a1 = messages.reaction(*sample_, Site::a1, ros::Time()).wrench.force;
  feedback.reaction_a2 = messages.reaction(*sample_, Site::a2, ros::Time()).wrench.force;
  for (std::size_t i = 0; i < kSpotCount; ++i) feedback.peak_force[i] = peak_force_[i] * messages.units().force;
  feedback.impacts = state.impacts;
  feedback.tau = state.tau;
  feedback.time = state.time;
  feedback.paused = paused;
  goal_->publishFeedback(feedback);
  peak_force_ = {};
}

void AlignServer::finish(const Messages& messages, const TrialResult& result, const std::string& text) {
  const AlignResult message = to_result(messages, result, text);
  if (result.outcome == Outcome::aligned || result.outcome == Outcome::inserted) {
    goal_->setSucceeded(message, text);
  } else {
    goal_->setAborted(message, text);
  }
  goal_.reset();
}

void AlignServer::abort(const Messages& messages, const TrialResult& so_far, const std::string& text) {
  goal_->setAborted(to_result(messages, so_far, text), text);
  goal_.reset();
}

void AlignServer::preempt(const Messages& messages, const TrialResult& so_far, const std::string& text) {
  goal_->setCanceled(to_result(messages, so_far, text), text);
  goal_.reset();
}

}  // namespace vibratory_alignment
