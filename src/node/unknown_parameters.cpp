#include "node/unknown_parameters.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <sstream>

#include <ros/console.h>

#include "model/nearest_word.h"
#include "node/node_parameters.h"

namespace vibratory_alignment {
namespace {

/// actionlib's are below ~align, but for the one that it also searches for further up.
constexpr const char* kOfLibraries[] = {"align", "actionlib_status_frequency", "diagnostic_period"};

/// Digits that the text of a number on the parameter server may lose.
constexpr double kSameNumber = 1e-9;

/// All parameters below the node's name; nothing where there are none.
std::optional<XmlRpc::XmlRpcValue> parameters_of(const ros::NodeHandle& private_handle) {
  XmlRpc::XmlRpcValue tree;
  if (!private_handle.getParam(private_handle.getNamespace(), tree)) return std::nullopt;
  if (tree.getType() != XmlRpc::XmlRpcValue::TypeStruct) return std::nullopt;
  return tree;
}

/// Nothing for what is no number.
std::optional<double> number_of(XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean: return static_cast<bool>(value) ? 1.0 : 0.0;
    case XmlRpc::XmlRpcValue::TypeInt: return static_cast<int>(value);
    case XmlRpc::XmlRpcValue::TypeDouble: return static_cast<double>(value);
    default: return std::nullopt;
  }
}

double number_of(const boost::any& value) {
  if (const auto* flag = boost::any_cast<bool>(&value)) return *flag ? 1.0 : 0.0;
  if (const auto* count = boost::any_cast<int>(&value)) return *count;
  return boost::any_cast<double>(value);
}

}  // namespace

std::vector<std::string> known_parameters() {
  std::vector<std::string> known = parameter_names();
  known.insert(known.end(), {"scene", "scene_file"});
  for (const auto& setting : AlignerConfig::__getParamDescriptions__()) known.push_back(setting->name);
  known.insert(known.end(), std::begin(kOfLibraries), std::end(kOfLibraries));
  return known;
}

std::vector<std::string> unknown_parameters(const std::string& node, const std::vector<std::string>& given,
                                            const std::vector<std::string>& known) {
  std::vector<std::string> lines;
  for (const std::string& name : given) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    lines.push_back("unknown parameter " + node + "/" + name + " is not read" + did_you_mean(name, known));
  }
  return lines;
}

void warn_of_unknown_parameters(const ros::NodeHandle& private_handle) {
  const std::optional<XmlRpc::XmlRpcValue> tree = parameters_of(private_handle);
  if (!tree) return;
  std::vector<std::string> given;
  for (const auto& [name, value] : *tree) given.push_back(name);
  for (const std::string& line : unknown_parameters(private_handle.getNamespace(), given, known_parameters()))
    ROS_WARN("%s", line.c_str());
}

std::vector<std::string> unread_settings(const std::string& node, XmlRpc::XmlRpcValue given,
                                         const AlignerConfig& at_start) {
  std::vector<std::string> lines;
  for (const auto& setting : AlignerConfig::__getParamDescriptions__()) {
    if (setting->name == "time_scale" || !given.hasMember(setting->name)) continue;
    boost::any value;
    setting->getValue(at_start, value);
    const double start = number_of(value);
    const std::optional<double> number = number_of(given[setting->name]);
    if (number && std::abs(*number - start) <= kSameNumber * std::abs(start)) continue;
    std::ostringstream line;
    line << node << '/' << setting->name << " = ";
    given[setting->name].write(line);
    line << " is not read at the start, the scene gives " << start
         << "; change the scene, or the setting once the node runs";
    lines.push_back(line.str());
  }
  return lines;
}

void warn_of_unread_settings(const ros::NodeHandle& private_handle, const AlignerConfig& at_start) {
  const std::optional<XmlRpc::XmlRpcValue> tree = parameters_of(private_handle);
  if (!tree) return;
  for (const std::string& line : unread_settings(private_handle.getNamespace(), *tree, at_start))
    ROS_WARN("%s", line.c_str());
}

}  // namespace vibratory_alignment
