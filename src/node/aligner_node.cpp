// aligner_node: one alignment trial as a ROS node. docs/node.md lists its parameters, topics, services and settings.
// SIGINT, SIGTERM, SIGHUP and `rosnode kill` end it in an orderly way. Exit status: 0 it ran, 1 it could not start (bad
// scene, bad parameters).
#include <atomic>
#include <chrono>
#include <clocale>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <sstream>
#include <string>
#include <thread>

#include <unistd.h>

#include <ros/ros.h>
#include <ros/xmlrpc_manager.h>

#include "node/aligner.h"
#include "node/drive_settings.h"
#include "node/master_watch.h"
#include "node/node_parameters.h"
#include "node/scene_from_params.h"
#include "node/unknown_parameters.h"

namespace {

std::atomic<bool> interrupted{false}, initialized{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler uses them");

/// The longest that an orderly end takes where the master, which roscpp asks without end, does not answer [s].
constexpr unsigned kLongestEnd = 2;

constexpr double kMasterPatience = 0.05;  ///< for a master that has gone [s]

extern "C" void on_alarm(int) { std::_Exit(EXIT_SUCCESS); }

extern "C" void on_signal(int) {
  interrupted = true;
  alarm(kLongestEnd);
  // ros::init() waits for a master to give it the command line's parameters; nobody knows of the node as yet
  if (!initialized) std::_Exit(EXIT_SUCCESS);
}

/// The process of the master, once one answers: waits for it as roscpp would, but not beyond a signal, then 0.
int wait_for_master() {
  constexpr std::chrono::milliseconds kInterval(50);
  for (bool told = false; !interrupted; told = true, std::this_thread::sleep_for(kInterval)) {
    if (const int master = vibratory_alignment::master_process()) return master;
    if (!told) ROS_ERROR("No master answers at %s. Waiting for one ...", ros::master::getURI().c_str());
  }
  return 0;
}

/// Waits until ROS time is known where somebody else tells it, but no longer than such clocks take to their next
/// message: what is published before would be stamped near 0.
void wait_for_clock() {
  constexpr std::chrono::milliseconds kInterval(10), kPatience(1000);
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!interrupted && !ros::Time::isValid() && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(kInterval);
}

/// `rosnode kill`, or another node that takes this one's name: the second parameter says which.
void on_shutdown_request(XmlRpc::XmlRpcValue& request, XmlRpc::XmlRpcValue& answer) {
  std::ostringstream reason;
  if (request.getType() == XmlRpc::XmlRpcValue::TypeArray && request.size() > 1) request[1].write(reason);
  ROS_WARN("Told to end: %s", reason.str().c_str());
  interrupted = true;
  alarm(kLongestEnd);
  answer = ros::xmlrpc::responseInt(1, "", 0);
}

/// One log entry a line: a scene may have many faults.
int fail(const std::string& message) {
  std::istringstream lines(message);
  for (std::string line; std::getline(lines, line);) ROS_FATAL("%s", line.c_str());
  return EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace vibratory_alignment;
  std::setlocale(LC_CTYPE, "C.UTF-8");  // the log has the names of scenes as they are
  // roscpp's log goes to stdout, which buffers whole blocks where it is no terminal: each line is to be seen at once
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup
  std::signal(SIGALRM, on_alarm);
  try {
    ros::init(argc, argv, "aligner", ros::init_options::NoSigintHandler);
  } catch (const ros::Exception& error) {
    return fail(error.what());
  }
  initialized = true;
  const int master = wait_for_master();
  if (master == 0) return EXIT_SUCCESS;
  // From here on a master that dies stops nothing. What it has not been told then, MasterWatch tells the next one.
  ros::master::setRetryTimeout(ros::WallDuration(kMasterPatience));
  const ros::NodeHandle private_handle("~");
  // roscpp's own answer would shut ROS down before a goal can be ended
  ros::XMLRPCManager::instance()->unbind("shutdown");
  ros::XMLRPCManager::instance()->bind("shutdown", on_shutdown_request);
  // The first line that roscpp logs to ~rosout asks for this, and tells the master of this node as it does so: once
  // another one has taken the name, that would end the other one
  bool unused = false;
  ros::param::getCached("/rosout_disable_topics_generation", unused);
  if (!ros::ok()) return EXIT_SUCCESS;  // told to end before that was bound
  std::optional<Scene> scene;
  NodeParameters parameters;
  std::string fault;
  try {
    warn_of_unknown_parameters(private_handle);
    scene = scene_from_params(private_handle);
    parameters = read_node_parameters(private_handle, *scene);
    warn_of_unread_settings(private_handle, DriveSettings(*scene, parameters.time_scale).config());
  } catch (const std::exception& error) {
    fault = error.what();
  }
  // what a master that goes does not tell looks as if it were not set
  if (master_process() != master) fault = "the master went while the parameters were read: start the node again";
  if (!fault.empty()) return fail(fault);
  if (!parameters.publish_clock) wait_for_clock();
  try {
    Aligner aligner(private_handle, *scene, parameters, master);
    aligner.spin([] { return interrupted.load(); });
  } catch (const std::exception& error) {
    return fail(error.what());
  }
  return EXIT_SUCCESS;
}
