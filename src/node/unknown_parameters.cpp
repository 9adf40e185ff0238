#include "node/unknown_parameters.h"

#include <algorithm>

#include <ros/console.h>
#include <vibratory_alignment/AlignerConfig.h>

#include "model/nearest_word.h"
#include "node/node_parameters.h"

namespace vibratory_alignment {
namespace {

/// actionlib's are below ~align, but for the one that it also searches for further up.
constexpr const char* kOfLibraries[] = {"align", "actionlib_status_frequency", "diagnostic_period"};

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
    const std::optional<std::string> meant = nearest_word(name, known);
    lines.push_back("unknown parameter " + node + "/" + name + " is not read" +
                    (meant ? "; did you mean " + *meant + "?" : ""));
  }
  return lines;
}

void warn_of_unknown_parameters(const ros::NodeHandle& private_handle) {
  XmlRpc::XmlRpcValue tree;
  const std::string& node = private_handle.getNamespace();
  if (!private_handle.getParam(node, tree) || tree.getType() != XmlRpc::XmlRpcValue::TypeStruct) return;
  std::vector<std::string> given;
  for (const auto& [name, value] : tree) given.push_back(name);
  for (const std::string& line : unknown_parameters(node, given, known_parameters())) ROS_WARN("%s", line.c_str());
}

}  // namespace vibratory_alignment
