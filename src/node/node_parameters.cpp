#include "node/node_parameters.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "model/number_text.h"
#include "model/scaling.h"
#include "model/tree_reader.h"
#include "node/frames.h"
#include "node/messages.h"
#include "trial/sampler.h"

namespace vibratory_alignment {
namespace {

constexpr double kSlowMotion = 0.002;  ///< a trial of some ten milliseconds is watched for some ten seconds

/// Reads parameters and collects what is wrong with them. What is absent or wrong keeps its default.
class Reader {
 public:
  explicit Reader(const ros::NodeHandle& handle) : handle_(handle) {}

  /// A finite number for which `allowed` holds; numbers that arrive as text ("1e-2") are fine.
  template <class Rule>
  std::optional<double> number(const std::string& name, const char* rule_text, const Rule& allowed) {
    XmlRpc::XmlRpcValue value;
    if (!handle_.getParam(name, value)) return std::nullopt;
    const std::optional<double> number = to_number(value);
    if (number && std::isfinite(*number) && allowed(*number)) return number;
    fault(name, value, rule_text);
    return std::nullopt;
  }

  bool flag(const std::string& name, bool otherwise) {
    XmlRpc::XmlRpcValue value;
    if (!handle_.getParam(name, value)) return otherwise;
    if (value.getType() == XmlRpc::XmlRpcValue::TypeBoolean) return static_cast<bool>(value);
    fault(name, value, "must be true or false");
    return otherwise;
  }

  std::string text(const std::string& name) {
    XmlRpc::XmlRpcValue value;
    if (!handle_.getParam(name, value)) return "";
    if (value.getType() == XmlRpc::XmlRpcValue::TypeString) return static_cast<std::string>(value);
    fault(name, value, "must be text");
    return "";
  }

  std::array<double, 3> position(const std::string& name) {
    std::array<double, 3> position{};
    XmlRpc::XmlRpcValue value;
    if (!handle_.getParam(name, value)) return position;
    bool usable = value.getType() == XmlRpc::XmlRpcValue::TypeArray && value.size() == 3;
    for (int i = 0; usable && i < 3; ++i) {
      const std::optional<double> number = to_number(value[i]);
      usable = number && std::isfinite(*number);
      if (usable) position[static_cast<std::size_t>(i)] = *number;
    }
    if (!usable) fault(name, value, "must be a list of three finite numbers [m]");
    return position;
  }

  void fault(const std::string& name, const XmlRpc::XmlRpcValue& value, const std::string& allowed) {
    std::ostringstream line;
    line << handle_.resolveName(name) << ": ";
    value.write(line) << ": " << allowed;
    faults_ += (faults_.empty() ? "" : "\n") + line.str();
  }

  void throw_faults() const {
    if (!faults_.empty()) throw ParameterError(faults_);
  }

 private:
  static std::optional<double> to_number(XmlRpc::XmlRpcValue& value) {
    switch (value.getType()) {
      case XmlRpc::XmlRpcValue::TypeInt: return static_cast<int>(value);
      case XmlRpc::XmlRpcValue::TypeDouble: return static_cast<double>(value);
      case XmlRpc::XmlRpcValue::TypeString: return parse_number(static_cast<std::string>(value));
      default: return std::nullopt;
    }
  }

  const ros::NodeHandle& handle_;
  std::string faults_;
};

bool positive(double value) { return value > 0.0; }

/// As fast as possible at most kMostSamples until the scene's time limit; beside a clock a trial may go on for ever.
std::optional<double> read_sample_interval(Reader& reader, const Scene& scene, double time_scale) {
  if (time_scale > 0.0)
    return reader.number("sample_interval", "must be a number > 0, in the scene's unit of time", positive);
  const double least = scene.trial.time_limit * output_units(scene).time / kMostSamples;
  const std::string rule = "must be a number of at least " + number_text(least) +
                           ", in the scene's unit of time: with time_scale 0 a trial has at most 1e9 samples";
  return reader.number("sample_interval", rule.c_str(), [&](double value) { return value >= least; });
}

}  // namespace

const std::vector<std::string>& topic_names() {
  static const std::vector<std::string> names = {"state",    "reaction/a1", "reaction/a2",
                                                 "contacts", "markers",     "result"};
  return names;
}

const std::vector<std::string>& parameter_names() {
  static const std::vector<std::string> names = {
      "time_scale",    "publish_rate",  "sample_interval", "autostart",     "exit_when_done",      "linger",
      "feedback_rate", "publish_clock", "tf_prefix",       "slot_position", "wait_for_subscribers"};
  return names;
}

NodeParameters read_node_parameters(const ros::NodeHandle& private_handle, const Scene& scene) {
  Reader reader(private_handle);
  NodeParameters parameters;
  parameters.time_scale = reader
                              .number("time_scale", "must be a number from 0 to 1000",
                                      [](double value) { return value >= 0.0 && value <= 1000.0; })
                              .value_or(usual_time_scale(scene));
  parameters.publish_rate =
      reader.number("publish_rate", "must be a number > 0 [1/s]", positive).value_or(parameters.publish_rate);
  parameters.sample_interval = read_sample_interval(reader, scene, parameters.time_scale);
  parameters.autostart = reader.flag("autostart", parameters.autostart);
  parameters.exit_when_done = reader.flag("exit_when_done", parameters.exit_when_done);
  parameters.linger = reader.number("linger", "must be a number >= 0 [s]", [](double value) { return value >= 0.0; })
                          .value_or(parameters.linger);
  parameters.feedback_rate = reader
                                 .number("feedback_rate", "must be a number from 0.01 to 1000 [1/s]",
                                         [](double value) { return value >= 0.01 && value <= 1000.0; })
                                 .value_or(parameters.feedback_rate);
  parameters.publish_clock = reader.flag("publish_clock", parameters.publish_clock);
  parameters.tf_prefix = reader.text("tf_prefix");
  if (!is_frame_prefix(parameters.tf_prefix)) {
    reader.fault("tf_prefix", parameters.tf_prefix,
                 "must be letters, digits, _, - and ., with single / only between them");
  }
  parameters.slot_position = reader.position("slot_position");
  std::istringstream topics(reader.text("wait_for_subscribers"));
  for (std::string topic; topics >> topic;) {
    if (std::find(topic_names().begin(), topic_names().end(), topic) == topic_names().end()) {
      reader.fault("wait_for_subscribers", topic, "must be some of " + alternatives(topic_names()));
    }
    parameters.wait_for_subscribers.push_back(topic);
  }
  const double interval = sample_interval(parameters, scene);
  if (!has_sane_size(interval)) {
    const char* name = parameters.sample_interval ? "sample_interval" : "publish_rate";
    reader.fault(name, number_text(parameters.sample_interval.value_or(parameters.publish_rate)),
                 "the time between two samples is too long or too short, by a factor of 1e100");
  }
  reader.throw_faults();
  return parameters;
}

double usual_time_scale(const Scene& scene) { return scene.scales ? kSlowMotion : 1.0; }

double sample_interval(const NodeParameters& parameters, const Scene& scene) {
  if (parameters.sample_interval) return *parameters.sample_interval / output_units(scene).time;
  if (parameters.time_scale > 0.0) return parameters.time_scale / parameters.publish_rate / ros_units(scene).time;
  return scene.shortest_period() / kUsualSamplesPerPeriod;
}

}  // namespace vibratory_alignment
