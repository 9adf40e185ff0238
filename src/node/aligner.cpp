#include "node/aligner.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include <ros/callback_queue.h>
#include <tf2_msgs/TFMessage.h>

#include "model/scene_loader.h"
#include "node/scene_service.h"
#include "node/transforms.h"

namespace vibratory_alignment {
namespace {

constexpr std::uint32_t kQueueSize = 1000;                 ///< messages kept for a slow subscriber
constexpr std::chrono::milliseconds kPublishingTurn(20);   ///< then callbacks get theirs
constexpr std::chrono::milliseconds kPictureInterval(33);  ///< of wall time between two ~markers
constexpr std::chrono::milliseconds kLongestLag(500);      ///< behind the wall clock, then the pace starts anew
constexpr std::chrono::seconds kSubscriberPatience(30);
constexpr std::chrono::milliseconds kSubscriberSettling(500);  ///< a recorder's other topics connect in this time
constexpr double kIdleWait = 0.05;                             ///< longest wait for callbacks [s]
constexpr double kMasterPatience = 0.5;                        ///< for a master that does not answer [s]

}  // namespace

Aligner::Aligner(const ros::NodeHandle& private_handle, const Scene& scene, const NodeParameters& parameters)
    : handle_(private_handle),
      scene_(scene),
      parameters_(parameters),
      messages_(scene, frames_with_prefix(parameters.tf_prefix)),
      markers_(scene, messages_.frames()),
      trial_(scene, sample_interval(parameters, scene)),
      settings_(scene, parameters.time_scale),
      settings_server_(settings_mutex_, private_handle) {
  if (!scene.scales) {
    ROS_WARN("%s: the scene has no scales: 1 unit of length is published as 1 m, of time as 1 s, of force as 1 N",
             scene.name.c_str());
  }
  pacer_.start(parameters.time_scale, Clock::now(), 0.0);
  advertise();
  settings_server_.updateConfig(settings_.config());
  settings_server_.setCallback([this](AlignerConfig& requested, std::uint32_t) { on_settings(requested); });
  waiting_since_ = Clock::now();
  // From here on a dead master must not stop the trial: a changed setting is told to it, and that blocks until it
  // answers.
  ros::master::setRetryTimeout(ros::WallDuration(kMasterPatience));
}

template <class Message>
SampleTopic Aligner::advertise_samples(const std::string& name) {
  return SampleTopic(publishers_[name] = handle_.advertise<Message>(name, kQueueSize));
}

void Aligner::advertise() {
  transforms_ = SampleTopic(ros::NodeHandle().advertise<tf2_msgs::TFMessage>("/tf", kQueueSize));
  state_ = advertise_samples<AlignerState>("state");
  reaction_a1_ = advertise_samples<geometry_msgs::WrenchStamped>("reaction/a1");
  reaction_a2_ = advertise_samples<geometry_msgs::WrenchStamped>("reaction/a2");
  contacts_ = advertise_samples<AlignerContacts>("contacts");
  publishers_["markers"] = handle_.advertise<visualization_msgs::MarkerArray>("markers", kQueueSize, true);
  publishers_["result"] = handle_.advertise<AlignerResult>("result", 1, true);
  services_ = {handle_.advertiseService("start", &Aligner::on_start, this),
               handle_.advertiseService("pause", &Aligner::on_pause, this),
               handle_.advertiseService("step", &Aligner::on_step, this),
               handle_.advertiseService("reset", &Aligner::on_reset, this),
               advertise_load_scene(handle_, [this](const Scene& scene) { return change_scene(scene); })};
  static_transforms_.sendTransform(
      static_transforms(scene_, messages_.frames(), parameters_.slot_position, next_stamp()));
}

void Aligner::spin() {
  while (ros::ok()) {
    double wait = kIdleWait;
    if (activity_ == Activity::waiting) wait_for_subscribers();
    if (activity_ == Activity::running) publish_due_samples();
    if (activity_ == Activity::running) {
      const std::chrono::duration<double> to_next = pacer_.due(to_seconds(trial_.next_time())) - Clock::now();
      wait = std::clamp(to_next.count(), 0.0, kIdleWait);
    }
    if (activity_ == Activity::ended && parameters_.exit_when_done &&
        Clock::now() - ended_at_ >= std::chrono::duration<double>(parameters_.linger)) {
      return;
    }
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(wait));
  }
}

/// Publishes the start as soon as those who must not miss it are there.
void Aligner::wait_for_subscribers() {
  const Clock::time_point now = Clock::now();
  const auto& topics = parameters_.wait_for_subscribers;
  const bool complete = std::all_of(topics.begin(), topics.end(), [this](const std::string& topic) {
    return publishers_.at(topic).getNumSubscribers() > 0;
  });
  if (complete && !all_subscribed_) all_subscribed_at_ = now;
  all_subscribed_ = complete;
  const bool settled = topics.empty() || (complete && now - all_subscribed_at_ >= kSubscriberSettling);
  const bool impatient = now - waiting_since_ >= kSubscriberPatience;
  if (!settled && !impatient) {
    ROS_INFO_THROTTLE(10.0, "Waiting for subscribers to the topics of ~wait_for_subscribers");
    return;
  }
  if (!settled) ROS_WARN("~wait_for_subscribers: not all topics have a subscriber; starting without them");
  activity_ = Activity::paused;
  publish_next();
  if (parameters_.autostart && activity_ == Activity::paused) run();
}

void Aligner::run() {
  pacer_.start(settings_.config().time_scale, Clock::now(), to_seconds(trial_.time()));
  activity_ = Activity::running;
}

void Aligner::publish_due_samples() {
  const Clock::time_point turn_end = Clock::now() + kPublishingTurn;
  Clock::time_point now = Clock::now();
  Clock::time_point due = pacer_.due(to_seconds(trial_.next_time()));
  while (activity_ == Activity::running && due <= now && now < turn_end) {
    publish_next();
    due = pacer_.due(to_seconds(trial_.next_time()));
    now = Clock::now();
  }
  if (activity_ == Activity::running && pacer_.time_scale() > 0.0 && now - due > kLongestLag) {
    ROS_WARN_THROTTLE(10.0, "Cannot keep up with ~time_scale %g: simulated time runs slower", pacer_.time_scale());
    pacer_.start(pacer_.time_scale(), now, to_seconds(trial_.time()));
  }
}

void Aligner::publish_next() {
  Sample sample;
  try {
    if (trial_.next(sample)) publish(sample);
  } catch (const SceneError& error) {
    // settings changed before the start may leave the scene without one
    ROS_ERROR("The trial cannot start with these settings: %s", error.what());
    activity_ = Activity::paused;
    return;
  }
  if (trial_.ended()) finish();
}

void Aligner::publish(const Sample& sample) {
  const ros::Time stamp = next_stamp();
  bool queued = transforms_.queue([&] {
    tf2_msgs::TFMessage moving;
    moving.transforms = {part_transform(sample.state, messages_.units().length, messages_.frames(), stamp)};
    return moving;
  });
  queued |= state_.queue([&] { return messages_.state(sample, stamp); });
  queued |= reaction_a1_.queue([&] { return messages_.reaction(sample, Site::a1, stamp); });
  queued |= reaction_a2_.queue([&] { return messages_.reaction(sample, Site::a2, stamp); });
  queued |= contacts_.queue([&] { return messages_.contacts(sample, stamp); });
  if (queued) send_queued_messages();
  markers_.add(sample);
  if (activity_ != Activity::running || Clock::now() >= next_picture_) publish_markers(stamp);
}

void Aligner::publish_markers(const ros::Time& stamp) {
  next_picture_ = Clock::now() + kPictureInterval;
  publishers_["markers"].publish(markers_.draw(stamp));
}

void Aligner::finish() {
  const TrialResult result = trial_.result();
  markers_.set_outcome(result.outcome);
  publish_markers(last_stamp_);
  publishers_["result"].publish(messages_.result(result, last_stamp_));
  activity_ = Activity::ended;
  ended_at_ = Clock::now();
  if (result.outcome == Outcome::failed) {
    ROS_ERROR("%s: failed at %s: %s", result.scene.c_str(), time_text().c_str(), result.failure.c_str());
  } else {
    ROS_INFO("%s: %s at %s, mode %s", result.scene.c_str(), to_string(result.outcome), time_text().c_str(),
             to_string(result.mode));
  }
}

/// ROS time, but never 0 and never the same twice, whatever the clock does; a clock that was set back is followed.
ros::Time Aligner::next_stamp() {
  const ros::Time now = ros::Time::now();
  const bool set_back = now + ros::Duration(1.0) < last_stamp_;
  const ros::Time least = last_stamp_ + ros::Duration(0, 1);
  last_stamp_ = now < least && !(set_back && !now.isZero()) ? least : now;
  return last_stamp_;
}

std::string Aligner::time_text() const {
  std::ostringstream text;
  text << "tau = " << trial_.time();
  if (scene_.scales) text << " (" << to_seconds(trial_.time()) << " s)";
  return text.str();
}

bool Aligner::on_start(Trigger::Request&, Trigger::Response& response) {
  response.success = activity_ != Activity::ended;
  if (activity_ == Activity::waiting) {
    parameters_.autostart = true;
    response.message = "starts as soon as the subscribers are there";
  } else if (activity_ == Activity::ended) {
    response.message = "the trial has ended; reset it first";
  } else {
    if (activity_ == Activity::paused) run();
    response.message = "running";
  }
  return true;
}

bool Aligner::on_pause(Trigger::Request&, Trigger::Response& response) {
  response.success = activity_ != Activity::ended;
  if (activity_ == Activity::waiting) parameters_.autostart = false;
  if (activity_ == Activity::running) activity_ = Activity::paused;
  response.message = response.success ? "paused at " + time_text() : "the trial has ended";
  return true;
}

bool Aligner::on_step(Trigger::Request&, Trigger::Response& response) {
  response.success = activity_ == Activity::running || activity_ == Activity::paused;
  if (!response.success) {
    response.message = activity_ == Activity::ended ? "the trial has ended; reset it first" : "not started yet";
    return true;
  }
  activity_ = Activity::paused;
  publish_next();
  response.message = "at " + time_text();
  return true;
}

bool Aligner::on_reset(Trigger::Request&, Trigger::Response& response) {
  try {
    trial_.restart();
  } catch (const std::exception& error) {
    response.success = false;
    response.message = error.what();
    return true;
  }
  show_start();
  response.success = true;
  response.message = "paused at the start";
  return true;
}

/// Publishes the start of the trial in the place of what is shown.
void Aligner::show_start() {
  if (activity_ == Activity::waiting) return;
  activity_ = Activity::paused;
  publishers_["markers"].publish(markers_.clear(next_stamp()));
  publish_next();
}

std::string Aligner::change_scene(const Scene& scene) {
  // A scene without scales has another time, for which another slow motion is of use.
  const bool same_time = scene.scales.has_value() == scene_.scales.has_value();
  NodeParameters parameters = parameters_;
  parameters.time_scale = same_time ? settings_.config().time_scale : usual_time_scale(scene);
  const DriveSettings settings(scene, parameters.time_scale);
  trial_.change_scene(scene, sample_interval(parameters, scene));
  scene_ = scene;
  settings_ = settings;
  messages_ = Messages(scene, messages_.frames());
  markers_ = Markers(scene, messages_.frames());
  static_transforms_.sendTransform(
      static_transforms(scene_, messages_.frames(), parameters_.slot_position, next_stamp()));
  settings_server_.updateConfig(settings_.config());
  show_start();
  return scene.name + ": paused at the start";
}

void Aligner::on_settings(AlignerConfig& requested) {
  const AlignerConfig before = settings_.config();
  for (const std::string& refusal : settings_.change(requested)) ROS_WARN("Refused: %s", refusal.c_str());
  const AlignerConfig& after = settings_.config();
  if (after.enabled != before.enabled || after.amplitude != before.amplitude || after.frequency != before.frequency ||
      after.phase != before.phase || after.waveform != before.waveform) {
    trial_.set_excitations(settings_.excitations());
  }
  if (after.pressing_force != before.pressing_force) trial_.set_pressing_force(*settings_.pressing_force());
  if (after.time_scale != before.time_scale) {
    const Clock::time_point now = Clock::now();
    const double reached = std::clamp(pacer_.simulated(now), to_seconds(trial_.time()), to_seconds(trial_.next_time()));
    pacer_.start(after.time_scale, now, reached);
  }
}

}  // namespace vibratory_alignment
