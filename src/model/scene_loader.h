// Reads a scene from YAML, checks it whole and scales it to dimensionless numbers.
// The only way into a Scene from outside: the command line hands over a file, the node the parameter server's tree.
#pragma once

#include <yaml-cpp/yaml.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/scene.h"

namespace vibratory_alignment {

/// All faults of one scene; what() is the message for the user, one fault a line: "source: key.path: value: what is
/// allowed".
class SceneError : public std::runtime_error {
 public:
  SceneError(std::string source, std::vector<std::string> faults);
  /// The file, or what else is said in its place.
  const std::string& source() const { return source_; }
  const std::vector<std::string>& faults() const { return faults_; }

 private:
  std::string source_;
  std::vector<std::string> faults_;
};

/// What has put a value at a key path of a scene: a setting, or a place in another file.
struct ValueOrigin {
  std::string key_path, place;
};

/// That of "key.path=value", as apply_setting() takes it.
ValueOrigin origin_of_setting(const std::string& setting);

/// Tells in each fault "(set by PLACE)" if a value of these, above or below it, may be what is wrong. Of several at one
/// key path the last counts.
void name_origins(const std::vector<ValueOrigin>& origins, std::vector<std::string>& faults);

/// Reads a YAML file into a tree. Throws SceneError when it is missing, unreadable, not a file, empty or not YAML.
YAML::Node read_yaml_file(const std::string& path);

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

/// Checks the tree against the schema, docs/scene.md, and scales it.
/// `source` names the file (or parameter namespace) in messages and, without its folder and ending, a scene that has no
/// name. `settings`: what apply_setting() has put into the tree; faults there name them. Throws SceneError with every
/// fault at once.
Scene load_scene(const YAML::Node& tree, const std::string& source, const std::vector<std::string>& settings = {});

/// read_yaml_file + settings + load_scene.
Scene load_scene_file(const std::string& path, const std::vector<std::string>& settings = {});

}  // namespace vibratory_alignment
