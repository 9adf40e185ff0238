// Values at key paths of a tree: what --set and the variables of a study do to a scene, and who did it.
#pragma once

#include <yaml-cpp/yaml.h>

#include <optional>
#include <string>
#include <vector>

#include "model/scene_error.h"

namespace vibratory_alignment {

/// Does what --set does: puts the value, itself YAML, at a key path ("friction.coefficient=0.3",
/// "excitation.1.phase=0.5", "contacts=[edges, corners]"; list entries count from 0), making sections that are not
/// there yet. The value null takes the key out, if it is there: its effect is not simulated. `tree` is then a new tree
/// that shares the unchanged parts with the old one; other handles to the old one see no change (YAML::Clone it first
/// for use by another thread). Throws SceneError when `assignment` is not "key.path=value", leads through something
/// that is not a map or list, or takes out a key that no scene has.
void apply_setting(YAML::Node& tree, const std::string& assignment);

/// The same with key path and value apart. `source` names the place that asks for it in messages.
void set_value(YAML::Node& tree, const std::string& key_path, const YAML::Node& value, const std::string& source);

/// What stands at a key path, as a handle to the tree's own node; none where nothing does.
std::optional<YAML::Node> find_value(const YAML::Node& tree, const std::string& key_path);

/// What has put a value at a key path of a scene: a setting, or a place in another file.
struct ValueOrigin {
  std::string key_path, place;
};

/// That of "key.path=value", as apply_setting() takes it.
ValueOrigin origin_of_setting(const std::string& setting);

/// Tells in each fault "(set by PLACE)" if a value of these, above or below it, may be what is wrong. Of several at one
/// key path the last counts.
void name_origins(const std::vector<ValueOrigin>& origins, std::vector<std::string>& faults);

}  // namespace vibratory_alignment
