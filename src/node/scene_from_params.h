// The node's scene: from the parameter server's tree ~scene or the file ~scene_file.
#pragma once

#include <string>

#include <XmlRpcValue.h>
#include <ros/node_handle.h>
#include <yaml-cpp/yaml.h>

#include "model/scene.h"

namespace vibratory_alignment {

/// The same tree as YAML, numbers to the last bit. NaN and infinity become .nan and .inf, which no scene may hold.
YAML::Node to_yaml(XmlRpc::XmlRpcValue& value);

/// Reads and checks the scene. Throws SceneError: with every fault of the scene, or when there is neither parameter or
/// both.
Scene scene_from_params(const ros::NodeHandle& private_handle);

}  // namespace vibratory_alignment
