// Publishes simulated time as ROS time on /clock.
//
// It starts at kStartTime, as bags do (bag_writer.h), is never 0, advances with every sample, and goes back, to
// kStartTime, in set_back() alone. A new trial goes on from the instant that was reached.
#pragma once

#include <chrono>

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/time.h>

namespace vibratory_alignment {

class SimClock {
 public:
  using Clock = std::chrono::steady_clock;

  /// Throws ParameterError unless /use_sim_time is true and nobody else publishes /clock.
  explicit SimClock(const ros::NodeHandle& private_handle);

  /// ROS time of the simulated instant `seconds` since the start of the trial. Throws std::runtime_error where ROS time
  /// does not go as far.
  ros::Time at(double seconds) const;

  void publish(const ros::Time& time);

  /// Publishes the present time again for those who came late, a few times a second of wall time.
  void repeat();

  /// A new trial begins now.
  void begin_trial() { start_ = now_; }

  /// A new trial begins at kStartTime. Publishes that and gives it the time to arrive before what is stamped with it:
  /// who has it first knows that the data of before are of no use any more.
  void set_back();

  /// Waits until all have what has been published.
  static void let_arrive();

 private:
  ros::Publisher publisher_;
  ros::Time start_, now_;
  Clock::time_point repeat_at_;
};

}  // namespace vibratory_alignment
