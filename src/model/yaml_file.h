// YAML that anybody may have written, as a tree of a bounded size.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "model/scene_error.h"

namespace vibratory_alignment {

/// UTF-8 without control characters other than tabs and line ends.
bool is_text(const std::string& bytes);

/// The one document of a text. `source` is for messages. Throws SceneError when it is not text, too large, nested too
/// deeply, empty, not YAML, or more than one document.
YAML::Node parse_yaml(const std::string& text, const std::string& source);

/// Reads a YAML file into a tree. Throws SceneError when it is missing, unreadable, not a file, empty or not YAML.
YAML::Node read_yaml_file(const std::string& path);

}  // namespace vibratory_alignment
