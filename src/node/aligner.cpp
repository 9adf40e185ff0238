#include "node/aligner.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <ros/callback_queue.h>
#include <std_msgs/UInt32.h>

#include "model/scene.h"
#include "model/scene_error.h"
#include "node/scene_service.h"
#include "node/transforms.h"

namespace vibratory_alignment {
namespace {

constexpr std::chrono::milliseconds kPublishingTurn(20);   ///< then callbacks get theirs
constexpr std::chrono::milliseconds kPictureInterval(33);  ///< of wall time between two ~markers
constexpr std::chrono::seconds kPoseInterval(1);           ///< of wall time between two poses of a part at rest
constexpr std::chrono::milliseconds kLongestLag(500);      ///< behind the wall clock, then the pace starts anew
constexpr std::chrono::seconds kSubscriberPatience(30);
constexpr std::chrono::seconds kClockPatience(5);
constexpr std::chrono::milliseconds kSubscriberSettling(500);  ///< a recorder's other topics connect in this time
constexpr std::chrono::milliseconds kIdleWait(50);             ///< longest wait for callbacks
const ros::WallDuration kFarewell(0.1);                        ///< for what is still to be sent
const ros::Duration kWallClockCorrection(1.0);                 ///< back by less than this is no jump

}  // namespace

void warn_without_scales(const Scene& scene) {
  if (scene.scales) return;
  ROS_WARN("%s: the scene has no scales: 1 unit of length is published as 1 m, of time as 1 s, of force as 1 N",
           scene.name.c_str());
}

Aligner::Aligner(const ros::NodeHandle& private_handle, const Scene& scene, const NodeParameters& parameters,
                 int master)
    : handle_(private_handle),
      parameters_(parameters),
      frames_(frames_with_prefix(parameters.tf_prefix)),
      stage_(std::make_unique<Stage>(scene, DriveSettings(scene, parameters.time_scale), TrialLimits(), frames_,
                                     sample_interval(parameters, scene))),
      interval_{stage_->interval, stage_->seconds(1.0)},
      stamps_(ros::Time::isSimTime() ? ros::Duration() : kWallClockCorrection),
      samples_(private_handle, frames_),
      diagnostics_(private_handle),
      start_time_scale_(private_handle, "time_scale"),
      settings_server_(settings_mutex_, private_handle),
      align_server_(
          private_handle, parameters.feedback_rate, [this](const AlignGoal& goal) { on_goal(goal); },
          [this] { on_cancel(); }) {
  warn_without_scales(scene);
  if (parameters.publish_clock) sim_clock_.emplace(private_handle);
  pacer_.start(parameters.time_scale, Clock::now(), 0.0);
  advertise();
  tell_settings();
  settings_server_.setCallback([this](AlignerConfig& requested, std::uint32_t) { on_settings(requested); });
  start_time_scale_.restore();
  waiting_since_ = Clock::now();
  std::vector<std::string> services;
  for (const char* name : {"get_loggers", "set_logger_level", "set_parameters"}) {  // roscpp's own come first
    services.push_back(handle_.resolveName(name));
  }
  for (const ros::ServiceServer& service : services_) services.push_back(service.getService());
  master_watch_.emplace(std::move(services), master);
}

void Aligner::advertise() {
  publishers_ = samples_.publishers();
  publishers_["markers"] = handle_.advertise<visualization_msgs::MarkerArray>("markers", kQueueSize, true);
  publishers_["result"] = handle_.advertise<AlignerResult>("result", kQueueSize, true);
  services_ = {handle_.advertiseService("start", &Aligner::on_start, this),
               handle_.advertiseService("pause", &Aligner::on_pause, this),
               handle_.advertiseService("step", &Aligner::on_step, this),
               handle_.advertiseService("step_by", &Aligner::on_step_by, this),
               handle_.advertiseService("reset", &Aligner::on_reset, this),
               advertise_load_scene(handle_, [this](const Scene& scene) { return change_scene(scene); })};
  restart_publisher_ = handle_.advertise<std_msgs::UInt32>("restarts", kQueueSize, true);
  announce_restart();
  publish_static_transforms();
}

void Aligner::publish_static_transforms() {
  static_transforms_.sendTransform(static_transforms(stage_->scene, frames_, parameters_.slot_position, next_stamp()));
}

void Aligner::set_activity(Activity activity) {
  activity_ = activity;
  next_pose_ = Clock::now() + kPoseInterval;
  pace_meter_.set_running(activity == Activity::running, Clock::now());
}

/// The time until something is to be done, unless a request arrives [s].
double Aligner::due_in() const {
  Clock::time_point due = Clock::now() + kIdleWait;
  if (activity_ == Activity::running) due = std::min(due, pacer_.due(next_due()));
  if (align_server_.active()) due = std::min(due, align_server_.feedback_due());
  return std::max(0.0, std::chrono::duration<double>(due - Clock::now()).count());
}

void Aligner::spin(const std::function<bool()>& interrupted) {
  interrupted_ = interrupted;
  try {
    run_trials();
    end_goal("the node ends");
  } catch (const std::exception& error) {
    end_goal(std::string("the node ends: ") + error.what());
    throw;
  }
}

/// Before the node ends.
void Aligner::end_goal(const std::string& text) {
  if (align_server_.active()) align_server_.abort(stage_->messages, stage_->trial.result(), text);
  if (ros::ok()) kFarewell.sleep();
}

/// For what may take as long as it takes, but for the end of the node.
std::function<bool()> Aligner::not_interrupted() const {
  return [this] { return ros::ok() && !interrupted_(); };
}

void Aligner::run_trials() {
  while (not_interrupted()()) {
    if (activity_ == Activity::waiting) wait_for_subscribers();
    if (activity_ == Activity::running) publish_due_samples();
    if (activity_ == Activity::paused || activity_ == Activity::ended) tend_standstill();
    if (align_server_.active() && Clock::now() >= align_server_.feedback_due()) {
      align_server_.give_feedback(stage_->messages, activity_ != Activity::running);
    }
    if (sim_clock_) sim_clock_->repeat();
    if (diagnostics_.due()) report_health();
    warn_without_clock();
    if (activity_ == Activity::ended && parameters_.exit_when_done &&
        Clock::now() - ended_at_ >= std::chrono::duration<double>(parameters_.linger)) {
      return;
    }
    try {
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(due_in()));
    } catch (const std::runtime_error& error) {
      if (!align_server_.forget_times_to_come()) throw;
      ROS_ERROR("~align: a client's goal or cancel has a stamp that is not possible: %s", error.what());
    }
    start_time_scale_.restore();
  }
}

/// Publishes the start as soon as those who must not miss it are there.
void Aligner::wait_for_subscribers() {
  const Clock::time_point now = Clock::now();
  const auto& topics = parameters_.wait_for_subscribers;
  std::string missing;
  for (const std::string& topic : topics)
    if (publishers_.at(topic).getNumSubscribers() == 0) missing += (missing.empty() ? "~" : ", ~") + topic;
  const bool complete = missing.empty();
  if (complete && !all_subscribed_) all_subscribed_at_ = now;
  all_subscribed_ = complete;
  const bool settled = topics.empty() || (complete && now - all_subscribed_at_ >= kSubscriberSettling);
  const bool impatient = now - waiting_since_ >= kSubscriberPatience;
  if (!settled && !impatient) {
    if (!complete)
      ROS_INFO_THROTTLE(10.0, "Waiting for a subscriber to %s, for %lld s at most (~wait_for_subscribers)",
                        missing.c_str(), static_cast<long long>(kSubscriberPatience.count()));
    return;
  }
  if (!complete) ROS_WARN("No subscriber to %s (~wait_for_subscribers): starting without", missing.c_str());
  set_activity(Activity::paused);
  next_picture_ = {};
  publish_next(not_interrupted());
  if (activity_ != Activity::paused) return;
  if (parameters_.autostart)
    run();
  else
    ROS_INFO("%s: waits at its start for ~start or a goal", stage_->scene.name.c_str());
}

/// For those who have joined; for those who ask where the part is now; and for those whose buffers are empty because
/// somebody has set ROS time back.
void Aligner::tend_standstill() {
  if (!samples_.has_last()) return;
  const bool joined = samples_.serve_newcomers(stage_->messages);
  const ros::Time now = ros::Time::now();
  const bool set_back = !sim_clock_ && stamps_.set_back(now);
  const bool passed = !sim_clock_ && now > stamps_.last() && Clock::now() >= next_pose_;
  if (!joined && !set_back && !passed) return;
  next_pose_ = Clock::now() + kPoseInterval;
  const ros::Time stamp = next_stamp();
  samples_.repeat_transform(stage_->messages, stamp);
  if (set_back) publish_markers(stamp);
}

void Aligner::run() {
  const double time_scale = stage_->settings.config().time_scale;
  pacer_.start(time_scale, Clock::now(), stage_->seconds(stage_->trial.time()));
  std::ostringstream pace;
  if (time_scale > 0.0)
    pace << "with time_scale " << time_scale;
  else
    pace << "as fast as it goes";
  ROS_INFO("%s: runs from %s, %s", stage_->scene.name.c_str(), time_text().c_str(), pace.str().c_str());
  set_activity(Activity::running);
}

void Aligner::publish_due_samples() {
  Clock::time_point now = Clock::now();
  const Clock::time_point turn_end = now + kPublishingTurn;
  if (drop_lag(now)) return;  // held up since the last turn: not all that was due goes out at once
  Clock::time_point due = pacer_.due(next_due());
  while (activity_ == Activity::running && due <= now && now < turn_end) {
    if (!publish_next([&] { return Clock::now() < turn_end; })) break;
    due = pacer_.due(next_due());
    now = Clock::now();
  }
  if (activity_ == Activity::running && due > now) publish_end_if_due(turn_end);
  if (activity_ == Activity::running) drop_lag(now);
}

/// Starts the pace anew where the next sample is too late. False: it is not.
bool Aligner::drop_lag(Clock::time_point now) {
  const Clock::duration lag = now - pacer_.due(next_due());
  if (pacer_.time_scale() == 0.0 || lag <= kLongestLag) return false;
  ROS_WARN_THROTTLE(10.0, "Cannot keep up with ~time_scale %g: simulated time runs slower", pacer_.time_scale());
  pace_meter_.add_dropped(std::chrono::duration<double>(lag).count());
  pacer_.start(pacer_.time_scale(), now, stage_->seconds(stage_->trial.time()));
  return true;
}

/// Where the samples are far apart the motion is followed from one to the next, so that the end of the trial, which is
/// known only when it is there, need not wait for the next one.
void Aligner::publish_end_if_due(Clock::time_point turn_end) {
  const double last = stage_->seconds(stage_->trial.time());
  if (pacer_.due(next_due()) - pacer_.due(last) <= kIdleWait) return;
  const double reached = pacer_.simulated(Clock::now()) / stage_->seconds(1.0);
  publish_next([&] { return Clock::now() < turn_end; }, reached);
}

/// Takes as long as the solver does, but no longer than `go_on` says, and no further than to `latest`. False: there was
/// none, or none yet. A trial that fails in its first step ends without any.
bool Aligner::publish_next(const std::function<bool()>& go_on, double latest) {
  const double before = stage_->trial.time();
  Sample sample;
  start_fault_.clear();
  try {
    if (!stage_->trial.next(sample, go_on, latest)) {
      if (stage_->trial.ended()) finish();
      return false;
    }
  } catch (const SceneError& error) {
    // settings changed before the start may leave the scene without one
    start_fault_ = std::string("The trial cannot start with these settings: ") + error.what();
    ROS_ERROR("%s", start_fault_.c_str());
    set_activity(Activity::paused);
    if (align_server_.active()) align_server_.abort(stage_->messages, stage_->trial.result(), start_fault_);
    return false;
  }
  pace_meter_.add_sample(stage_->seconds(sample.time - before));
  publish(sample);
  if (stage_->trial.ended()) finish();
  return true;
}

void Aligner::publish(const Sample& sample) {
  const ros::Time stamp = next_stamp();
  samples_.publish(stage_->messages, sample, stamp);
  stage_->markers.add(sample);
  align_server_.add(sample);
  if (Clock::now() >= next_picture_) publish_markers(stamp);
}

void Aligner::publish_markers(const ros::Time& stamp) {
  next_picture_ = Clock::now() + kPictureInterval;
  publishers_["markers"].publish(stage_->markers.draw(stamp));
}

void Aligner::finish() {
  const TrialResult result = stage_->trial.result();
  const ros::Time stamp = samples_.has_last() ? stamps_.last() : next_stamp();
  stage_->markers.set_outcome(result.outcome);
  publish_markers(stamp);
  publishers_["result"].publish(stage_->messages.result(result, stamp));
  set_activity(Activity::ended);
  ended_at_ = Clock::now();
  std::string text = std::string(to_string(result.outcome)) + " at " + time_text();
  if (result.outcome == Outcome::failed) {
    text += ": " + result.failure;
    ROS_ERROR("%s: %s", result.scene.c_str(), text.c_str());
  } else {
    if (result.aligned_time && result.outcome != Outcome::aligned) {
      text += ", aligned at " + time_text(*result.aligned_time);
    }
    text += std::string(", mode ") + to_string(result.mode);
    ROS_INFO("%s: %s", result.scene.c_str(), text.c_str());
  }
  diagnostics_.set_last_outcome(result);
  if (align_server_.active()) align_server_.finish(stage_->messages, result, text);
}

/// A replay leaves /use_sim_time behind. The trial runs all the same, but whoever waits for ROS time waits for ever.
void Aligner::warn_without_clock() {
  if (clock_is_missed_ || !ros::Time::isSimTime() || !ros::Time::now().isZero()) return;
  if (Clock::now() - started_ < kClockPatience) return;
  clock_is_missed_ = true;
  ROS_WARN(
      "/use_sim_time is true, as a replay leaves it, but nobody publishes /clock: ROS time stands at 0, and a recorder "
      "records nothing. To run in wall time: rosparam delete /use_sim_time, and start all nodes again");
}

void Aligner::report_health() {
  static constexpr const char* kActivities[] = {"waiting", "paused", "running", "ended"};
  const Clock::time_point now = Clock::now();
  NodeStatus status;
  status.activity = kActivities[static_cast<int>(activity_)];
  status.goal_active = align_server_.active();
  status.trial = stage_->trial.result();
  status.tau_text = time_text();
  status.time_scale = stage_->settings.config().time_scale;
  status.sample_rate = status.time_scale / stage_->seconds(stage_->interval);
  if (activity_ == Activity::running && status.time_scale > 0.0) {
    status.lag = std::max(0.0, std::chrono::duration<double>(now - pacer_.due(next_due())).count());
  }
  status.pace = pace_meter_.take(now);
  diagnostics_.publish(status);
}

/// Samples of all scenes come after the same simulated time, except with ~time_scale 0.
double Aligner::interval_of(const Scene& scene) const {
  if (!parameters_.sample_interval && parameters_.time_scale == 0.0) return sample_interval(parameters_, scene);
  return interval_.of_scene * (interval_.time_unit / ros_units(scene).time);
}

ros::Time Aligner::next_stamp() {
  if (!sim_clock_) return stamps_.next(ros::Time::now());
  const ros::Time stamp = stamps_.next(sim_clock_->at(stage_->seconds(stage_->trial.time())));
  sim_clock_->publish(stamp);
  return stamp;
}

/// Tells that simulated time begins anew, before it does.
void Aligner::announce_restart() {
  std_msgs::UInt32 message;
  message.data = restarts_++;
  restart_publisher_.publish(message);
}

std::string Aligner::time_text(double tau) const {
  std::ostringstream text;
  text << "tau = " << tau;
  if (stage_->scene.scales) text << " (" << stage_->seconds(tau) << " s)";
  return text.str();
}

}  // namespace vibratory_alignment
