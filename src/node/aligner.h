// The node: drives a trial at the pace of the wall clock, publishes its samples, and answers services and settings.
//
// One thread does everything: spin() publishes what is due, then handles what has arrived (services, settings), and so
// on. A change of the settings therefore always falls between two samples, and enters the motion at the instant of the
// last one that was published.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <dynamic_reconfigure/server.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <vibratory_alignment/AlignerConfig.h>
#include <boost/thread/recursive_mutex.hpp>

#include "model/scene.h"
#include "node/drive_settings.h"
#include "node/markers.h"
#include "node/messages.h"
#include "node/node_parameters.h"
#include "node/pacer.h"
#include "node/sample_topic.h"
#include "node/trial_run.h"

namespace vibratory_alignment {

class Aligner {
 public:
  /// Throws as Simulation does when the scene has no start.
  Aligner(const ros::NodeHandle& private_handle, const Scene& scene, const NodeParameters& parameters);

  /// Runs until ROS shuts down, or until the trial is done and ~exit_when_done.
  void spin();

 private:
  using Clock = Pacer::Clock;
  using Trigger = std_srvs::Trigger;
  enum class Activity { waiting, paused, running, ended };

  void advertise();
  template <class Message>
  SampleTopic advertise_samples(const std::string& name);
  bool on_start(Trigger::Request&, Trigger::Response& response);
  bool on_pause(Trigger::Request&, Trigger::Response& response);
  bool on_step(Trigger::Request&, Trigger::Response& response);
  bool on_reset(Trigger::Request&, Trigger::Response& response);
  void on_settings(AlignerConfig& requested);
  std::string change_scene(const Scene& scene);
  void show_start();

  void wait_for_subscribers();
  void run();
  void publish_due_samples();
  void publish_next();
  void publish(const Sample& sample);
  void publish_markers(const ros::Time& stamp);
  void finish();

  ros::Time next_stamp();
  double to_seconds(double time) const { return time * messages_.units().time; }
  std::string time_text() const;

  ros::NodeHandle handle_;
  Scene scene_;
  NodeParameters parameters_;
  Messages messages_;
  Markers markers_;
  TrialRun trial_;
  DriveSettings settings_;
  Pacer pacer_;
  Activity activity_ = Activity::waiting;
  Clock::time_point waiting_since_, all_subscribed_at_, next_picture_, ended_at_;
  bool all_subscribed_ = false;
  ros::Time last_stamp_;

  std::map<std::string, ros::Publisher> publishers_;  ///< by the names in topic_names()
  std::vector<ros::ServiceServer> services_;
  SampleTopic transforms_, state_, reaction_a1_, reaction_a2_, contacts_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;
  boost::recursive_mutex settings_mutex_;
  dynamic_reconfigure::Server<AlignerConfig> settings_server_;
};

}  // namespace vibratory_alignment
