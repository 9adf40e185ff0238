// The node: drives a trial at the pace of the wall clock, publishes its samples, and answers services and settings.
//
// One thread does everything: spin() publishes what is due, then handles what has arrived (services, settings), and so
// on. A change of the settings therefore always falls between two samples, and enters the motion at the instant of the
// last one that was published. aligner.cpp runs and publishes, aligner_requests.cpp answers what has arrived.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <dynamic_reconfigure/server.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <vibratory_alignment/AlignerConfig.h>
#include <vibratory_alignment/StepBy.h>
#include <boost/thread/recursive_mutex.hpp>

#include "model/scene.h"
#include "node/align_server.h"
#include "node/diagnostics.h"
#include "node/master_watch.h"
#include "node/node_parameters.h"
#include "node/pace_meter.h"
#include "node/pacer.h"
#include "node/sample_topics.h"
#include "node/sim_clock.h"
#include "node/stage.h"
#include "node/stamps.h"
#include "node/start_value.h"

namespace vibratory_alignment {

/// Says that a scene without scales has no SI units.
void warn_without_scales(const Scene& scene);

class Aligner {
 public:
  /// Throws as Simulation does when the scene has no start, and ParameterError when it cannot publish the clock.
  /// `master`: as known to MasterWatch.
  Aligner(const ros::NodeHandle& private_handle, const Scene& scene, const NodeParameters& parameters, int master);

  /// Runs until ROS shuts down, interrupted() is true, or the trial is done and ~exit_when_done. What has been
  /// published then gets the time to go out.
  void spin(const std::function<bool()>& interrupted);

 private:
  using Clock = Pacer::Clock;
  using Trigger = std_srvs::Trigger;
  enum class Activity { waiting, paused, running, ended };

  void advertise();
  void run_trials();
  bool on_start(Trigger::Request&, Trigger::Response& response);
  bool on_pause(Trigger::Request&, Trigger::Response& response);
  bool on_step(Trigger::Request&, Trigger::Response& response);
  bool on_step_by(StepBy::Request& request, StepBy::Response& response);
  bool on_reset(Trigger::Request&, Trigger::Response& response);
  void on_settings(AlignerConfig& requested);
  void tell_settings();
  std::string change_scene(const Scene& scene);
  void on_goal(const AlignGoal& goal);
  void on_cancel();

  void change_stage(std::unique_ptr<Stage> next, bool other_scene);
  void set_clock_back();
  void show_start();
  std::string place_at_start() const;
  void tend_standstill();
  void set_activity(Activity activity);
  void wait_for_subscribers();
  void run();
  double due_in() const;
  void publish_due_samples();
  bool drop_lag(Clock::time_point now);
  void publish_end_if_due(Clock::time_point turn_end);
  bool publish_next(const std::function<bool()>& go_on, double latest = std::numeric_limits<double>::infinity());
  std::function<bool()> not_interrupted() const;
  void publish(const Sample& sample);
  void publish_markers(const ros::Time& stamp);
  void publish_static_transforms();
  void announce_restart();
  void finish();
  void end_goal(const std::string& text);
  void begin();
  struct Steps {
    long published = 0;
    bool cut_short = false;  ///< the solver takes too long
  };
  Steps step(long samples);
  std::string refusal_to_step();
  std::string place_after(const Steps& steps) const;
  void report_health();
  void warn_without_clock();

  double interval_of(const Scene& scene) const;
  double next_due() const { return stage_->seconds(stage_->trial.next_time()); }
  ros::Time next_stamp();
  std::string time_text() const { return time_text(stage_->trial.time()); }
  std::string time_text(double tau) const;

  ros::NodeHandle handle_;
  NodeParameters parameters_;
  Frames frames_;
  std::unique_ptr<Stage> stage_;
  /// Time between two samples, dimensionless, of the scene for which it was set, and that scene's unit of time [s].
  struct Interval {
    double of_scene, time_unit;
  };
  Interval interval_;
  Pacer pacer_;
  PaceMeter pace_meter_;
  std::function<bool()> interrupted_;  ///< set by spin()
  Activity activity_ = Activity::waiting;
  const Clock::time_point started_ = Clock::now();
  std::string start_fault_;       ///< why the present settings leave the trial without a start
  bool clock_is_missed_ = false;  ///< and that has been said
  Clock::time_point waiting_since_, all_subscribed_at_, next_picture_, next_pose_, ended_at_;
  bool all_subscribed_ = false;
  std::optional<SimClock> sim_clock_;
  Stamps stamps_;
  std::uint32_t restarts_ = 0;

  SampleTopics samples_;
  std::map<std::string, ros::Publisher> publishers_;  ///< by the names in topic_names()
  ros::Publisher restart_publisher_;
  std::vector<ros::ServiceServer> services_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;
  Diagnostics diagnostics_;
  StartValue start_time_scale_;
  boost::recursive_mutex settings_mutex_;
  dynamic_reconfigure::Server<AlignerConfig> settings_server_;
  AlignServer align_server_;
  std::optional<MasterWatch> master_watch_;
};

}  // namespace vibratory_alignment
