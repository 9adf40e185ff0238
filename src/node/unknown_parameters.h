// Parameters below the node's name that nothing reads: a name is misspelt, or it is a setting, which the scene gives.
#pragma once

#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <vibratory_alignment/AlignerConfig.h>

namespace vibratory_alignment {

/// The private names, without what is below them, that the node reads, and the libraries that it is made of:
/// dynamic_reconfigure (it stores the settings there), actionlib, diagnostic_updater. roscpp has none.
std::vector<std::string> known_parameters();

/// One line for each of the given names that is not among the known ones: "unknown parameter /aligner/publish_rat is
/// not read, did you mean publish_rate?". `node`: the node's name, with all its namespaces.
std::vector<std::string> unknown_parameters(const std::string& node, const std::vector<std::string>& given,
                                            const std::vector<std::string>& known);

/// Writes these lines of the parameters that there are now to the log, as warnings.
void warn_of_unknown_parameters(const ros::NodeHandle& private_handle);

/// One line for each setting that is `given` as a parameter with another value than it starts with: "/aligner/amplitude
/// = 2 is not read at the start, the scene gives 1; ...". ~time_scale is read (node/node_parameters.h).
std::vector<std::string> unread_settings(const std::string& node, XmlRpc::XmlRpcValue given,
                                         const AlignerConfig& at_start);

/// Writes these lines to the log, as warnings. Before dynamic_reconfigure's server is made, which sets the parameters.
void warn_of_unread_settings(const ros::NodeHandle& private_handle, const AlignerConfig& at_start);

}  // namespace vibratory_alignment
