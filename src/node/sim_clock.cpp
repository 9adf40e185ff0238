#include "node/sim_clock.h"

#include <stdexcept>
#include <string>

#include <XmlRpc.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <rosgraph_msgs/Clock.h>

#include "model/number_text.h"
#include "node/bag_writer.h"
#include "node/node_parameters.h"

namespace vibratory_alignment {
namespace {

const ros::Time kStartTime(BagWriter::kStartTime);
constexpr std::chrono::milliseconds kRepeatInterval(100);
const ros::WallDuration kArrival(0.05);
constexpr double kPatience = 1.0;  ///< with a node that may be dead [s]

/// False for a node that was killed, which the master knows nothing of.
bool is_alive(const std::string& node) {
  XmlRpc::XmlRpcValue request, response, uri, answer;
  request[0] = ros::this_node::getName();
  XmlRpc::XmlRpcValue caller = request;
  request[1] = node;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::master::execute("lookupNode", request, response, uri, false)) return false;
  if (!ros::network::splitURI(static_cast<std::string>(uri), host, port)) return false;
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  if (!client.executeNonBlock("getPid", caller)) return false;
  XmlRpc::XmlRpcDispatch dispatch;
  dispatch.addSource(&client, XmlRpc::XmlRpcDispatch::WritableEvent | XmlRpc::XmlRpcDispatch::Exception);
  dispatch.work(kPatience);
  dispatch.removeSource(&client);
  return client.executeCheckDone(answer) && answer.valid();
}

/// A node that publishes /clock, empty if there is none.
std::string clock_publisher() {
  XmlRpc::XmlRpcValue request, response, state;
  request[0] = ros::this_node::getName();
  if (!ros::master::execute("getSystemState", request, response, state, false)) return "";
  XmlRpc::XmlRpcValue& topics = state[0];
  for (int i = 0; i < topics.size(); ++i) {
    if (static_cast<std::string>(topics[i][0]) != "/clock") continue;
    for (int j = 0; j < topics[i][1].size(); ++j) {
      const std::string node = topics[i][1][j];
      if (is_alive(node)) return node;
    }
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

ros::Time SimClock::at(double seconds) const {
  try {
    return start_ + ros::Duration(seconds);
  } catch (const std::runtime_error&) {
    throw std::runtime_error("/clock: ROS time has no instant " + number_text(seconds) +
                             " s after the start of the trial: ~publish_clock is not for such a scene");
  }
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
