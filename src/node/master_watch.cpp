#include "node/master_watch.h"

#include <chrono>
#include <utility>

#include <XmlRpc.h>
#include <ros/connection_manager.h>
#include <ros/console.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>

namespace vibratory_alignment {
namespace {

using XmlRpc::XmlRpcValue;

constexpr std::chrono::seconds kWatchInterval(1);

/// A call to the master. False when it does not answer.
bool ask_master(const char* method, XmlRpcValue& request, XmlRpcValue& answer) {
  XmlRpcValue response;
  request[0] = ros::this_node::getName();
  return ros::master::execute(method, request, response, answer, false);
}

/// True as well when the master does not answer.
bool master_knows(const std::string& service) {
  XmlRpcValue request, response, answer;
  request[0] = ros::this_node::getName();
  request[1] = service;
  if (ros::master::execute("lookupService", request, response, answer, false)) return true;
  return response.getType() != XmlRpcValue::TypeArray;
}

/// A call to this node's own slave API (http://wiki.ros.org/ROS/Slave_API), which lists and connects its topics.
XmlRpcValue ask_self(const char* method, XmlRpcValue request) {
  const auto port = static_cast<int>(ros::XMLRPCManager::instance()->getServerPort());
  XmlRpc::XmlRpcClient client(ros::network::getHost().c_str(), port, "/");
  XmlRpcValue response;
  request[0] = ros::this_node::getName();
  const bool answered = client.execute(method, request, response) && response.getType() == XmlRpcValue::TypeArray;
  return answered && response.size() == 3 ? response[2] : XmlRpcValue();
}

void register_topics(const char* list_method, const char* register_method, bool connect) {
  XmlRpcValue topics = ask_self(list_method, {});
  for (int i = 0; topics.getType() == XmlRpcValue::TypeArray && i < topics.size(); ++i) {
    XmlRpcValue request, answer;
    request[1] = topics[i][0];
    request[2] = topics[i][1];
    request[3] = ros::XMLRPCManager::instance()->getServerURI();
    if (!ask_master(register_method, request, answer) || !connect) continue;
    XmlRpcValue update;
    update[1] = topics[i][0];
    update[2] = answer;  // those who publish it
    ask_self("publisherUpdate", update);
  }
}

/// The first service first: the master that knows it is told the rest as well, or goes before.
void register_all(const std::vector<std::string>& services) {
  const std::string uri =
      "rosrpc://" + ros::network::getHost() + ":" + std::to_string(ros::ConnectionManager::instance()->getTCPPort());
  for (const std::string& service : services) {
    XmlRpcValue request, answer;
    request[1] = service;
    request[2] = uri;
    request[3] = ros::XMLRPCManager::instance()->getServerURI();
    ask_master("registerService", request, answer);
  }
  register_topics("getPublications", "registerPublisher", false);
  register_topics("getSubscriptions", "registerSubscriber", true);
}

}  // namespace

int master_process() {
  XmlRpcValue request, answer;
  return ask_master("getPid", request, answer) ? static_cast<int>(answer) : 0;
}

MasterWatch::MasterWatch(std::vector<std::string> services, int known) : services_(std::move(services)) {
  thread_ = std::thread([this, known] { watch(known); });
}

MasterWatch::~MasterWatch() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  stopped_.notify_all();
  thread_.join();
}

void MasterWatch::watch(int known) {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopped_.wait_for(lock, kWatchInterval, [this] { return stop_; })) {
    lock.unlock();
    const int now = master_process();
    // a master that was started anew may have the process number of the one before, as in a container
    if (now != 0 && (now != known || !master_knows(services_.front()))) {
      ROS_WARN("A new master: telling it of this node");
      register_all(services_);
      known = now;
    }
    lock.lock();
  }
}

}  // namespace vibratory_alignment
