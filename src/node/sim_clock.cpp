#include "node/sim_clock.h"

#include <string>

#include <ros/master.h>
#include <ros/this_node.h>
#include <rosgraph_msgs/Clock.h>

#include "node/node_parameters.h"

namespace vibratory_alignment {
namespace {

const ros::Time kStartTime(1, 0);  ///< as in the bags of `align trial --bag`
constexpr std::chrono::milliseconds kRepeatInterval(100);
const ros::WallDuration kArrival(0.05);

/// A node that publishes /clock, empty if there is none.
std::string clock_publisher() {
  XmlRpc::XmlRpcValue request, response, state;
  request[0] = ros::this_node::getName();
  if (!ros::master::execute("getSystemState", request, response, state, false)) return "";
  XmlRpc::XmlRpcValue& topics = state[0];
  for (int i = 0; i < topics.size(); ++i) {
    if (static_cast<std::string>(topics[i][0]) == "/clock" && topics[i][1].size() > 0) return topics[i][1][0];
  }
  return "";
}

}  // namespace

SimClock::SimClock(const ros::NodeHandle& private_handle) : start_(kStartTime), now_(kStartTime) {
  const std::string name = private_handle.resolveName("publish_clock");
  if (!ros::Time::isSimTime()) {
    throw ParameterError(name + ": true: /use_sim_time must be true before the nodes start that follow the clock");
  }
  const std::string other = clock_publisher();
  if (!other.empty()) throw ParameterError(name + ": true: " + other + " publishes /clock already");
  publisher_ = ros::NodeHandle().advertise<rosgraph_msgs::Clock>("/clock", 1000, true);
  publish(kStartTime);
}

void SimClock::publish(const ros::Time& time) {
  now_ = time;
  repeat_at_ = Clock::now() + kRepeatInterval;
  rosgraph_msgs::Clock message;
  message.clock = time;
  publisher_.publish(message);
}

void SimClock::repeat() {
  if (Clock::now() >= repeat_at_) publish(now_);
}

void SimClock::set_back() {
  start_ = kStartTime;
  publish(kStartTime);
  let_arrive();
}

void SimClock::let_arrive() { kArrival.sleep(); }

}  // namespace vibratory_alignment
