// Reads a scene from YAML, checks it whole and scales it to dimensionless numbers.
// The only way into a Scene from outside: the command line hands over a file, the node the parameter server's tree.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "model/scene.h"
#include "model/scene_error.h"

namespace vibratory_alignment {

/// Checks the tree against the schema, docs/scene.md, and scales it.
/// `source` names the file (or parameter namespace) in messages and, without its folder and ending, a scene that has no
/// name. `settings`: what apply_setting() has put into the tree; faults there name them. Throws SceneError with every
/// fault at once.
Scene load_scene(const YAML::Node& tree, const std::string& source, const std::vector<std::string>& settings = {});

/// read_yaml_file + settings + load_scene.
Scene load_scene_file(const std::string& path, const std::vector<std::string>& settings = {});

}  // namespace vibratory_alignment
