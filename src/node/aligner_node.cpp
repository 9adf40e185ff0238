// aligner_node: one alignment trial as a ROS node. docs/node.md lists its parameters, topics, services and settings.
// SIGINT, SIGTERM and `rosnode kill` end it in an orderly way. Exit status: 0 it ran, 1 it could not start (bad scene,
// bad parameters).
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <sstream>
#include <string>

#include <ros/ros.h>
#include <ros/xmlrpc_manager.h>

#include "node/aligner.h"
#include "node/drive_settings.h"
#include "node/master_watch.h"
#include "node/node_parameters.h"
#include "node/scene_from_params.h"
#include "node/unknown_parameters.h"

namespace {

/// How far the node has come. Until it spins it may wait for a master, in roscpp.
enum class Progress { before_start, starting, spinning };

std::atomic<bool> interrupted{false};
std::atomic<Progress> progress{Progress::before_start};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<Progress>::is_always_lock_free,
              "a signal handler uses them");

extern "C" void on_signal(int) {
  interrupted = true;
  if (progress == Progress::before_start) std::_Exit(EXIT_SUCCESS);  // nobody knows of the node as yet
  if (progress == Progress::starting) ros::requestShutdown();
}

/// `rosnode kill`, or another node that takes this one's name.
void on_shutdown_request(XmlRpc::XmlRpcValue&, XmlRpc::XmlRpcValue& answer) {
  interrupted = true;
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
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  ros::init(argc, argv, "aligner", ros::init_options::NoSigintHandler);
  const int master = master_process();
  progress = Progress::starting;
  const ros::NodeHandle private_handle("~");
  // roscpp's own answer would shut ROS down before a goal can be ended
  ros::XMLRPCManager::instance()->unbind("shutdown");
  ros::XMLRPCManager::instance()->bind("shutdown", on_shutdown_request);
  try {
    warn_of_unknown_parameters(private_handle);
    const Scene scene = scene_from_params(private_handle);
    const NodeParameters parameters = read_node_parameters(private_handle, scene);
    warn_of_unread_settings(private_handle, DriveSettings(scene, parameters.time_scale).config());
    Aligner aligner(private_handle, scene, parameters, master);
    progress = Progress::spinning;
    aligner.spin([] { return interrupted.load(); });
  } catch (const std::exception& error) {
    if (!interrupted) return fail(error.what());
  }
  return EXIT_SUCCESS;
}
