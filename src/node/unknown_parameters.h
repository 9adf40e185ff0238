// Parameters below the node's name that nothing reads: as a rule a name is misspelt.
#pragma once

#include <string>
#include <vector>

#include <ros/node_handle.h>

namespace vibratory_alignment {

/// The private names, without what is below them, that the node reads, and the libraries that it is made of:
/// dynamic_reconfigure (it stores the settings there), actionlib, diagnostic_updater. roscpp has none.
std::vector<std::string> known_parameters();

/// One line for each of the given names that is not among the known ones: "unknown parameter /aligner/publish_rat is
/// not read; did you mean publish_rate?". `node`: the node's name, with all its namespaces.
std::vector<std::string> unknown_parameters(const std::string& node, const std::vector<std::string>& given,
                                            const std::vector<std::string>& known);

/// Writes these lines of the parameters that there are now to the log, as warnings.
void warn_of_unknown_parameters(const ros::NodeHandle& private_handle);

}  // namespace vibratory_alignment
