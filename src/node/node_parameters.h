// The node's private parameters besides the scene, read once at the start.
#pragma once

#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <ros/node_handle.h>

#include "model/scene.h"

namespace vibratory_alignment {

/// Parameters that cannot be used; what() has one line for each: name, value, what is allowed.
class ParameterError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct NodeParameters {
  double time_scale = 1.0;      ///< ~time_scale: simulated per wall time, >= 0; default 0.002, without scales 1
  double publish_rate = 100.0;  ///< ~publish_rate [1/s of wall time], > 0: sets the sample interval
  std::optional<double> sample_interval;  ///< ~sample_interval, in the scene's unit of time, > 0: instead of the rate
  bool autostart = true;                  ///< ~autostart: false waits for ~start
  bool exit_when_done = false;            ///< ~exit_when_done: the node ends after the result ...
  double linger = 1.0;                    ///< ~linger: ... this much later [s of wall time], >= 0
  double feedback_rate = 10.0;            ///< ~feedback_rate: of ~align [1/s of wall time], 0.01 to 1000
  bool publish_clock = false;             ///< ~publish_clock: simulated time is ROS time
  std::string tf_prefix;                  ///< ~tf_prefix: "left" makes left/slot, left/part ...
  std::array<double, 3> slot_position{};  ///< ~slot_position: of the slot in the world [m]
  std::vector<std::string> wait_for_subscribers;  ///< ~wait_for_subscribers: topics, as in "state result"
};

/// Topics under the node's name that ~wait_for_subscribers may name.
const std::vector<std::string>& topic_names();

/// All that read_node_parameters() reads.
const std::vector<std::string>& parameter_names();

/// Throws ParameterError with every fault.
NodeParameters read_node_parameters(const ros::NodeHandle& private_handle, const Scene& scene);

/// The time scale of a node that is not told one.
double usual_time_scale(const Scene& scene);

/// Time between two samples, dimensionless: ~sample_interval, or what ~time_scale and ~publish_rate make of it at the
/// start, or for ~time_scale 0 a twentieth of the shortest excitation period. It stays the same when the time scale
/// changes later: then the rate of the messages changes.
double sample_interval(const NodeParameters& parameters, const Scene& scene);

}  // namespace vibratory_alignment
