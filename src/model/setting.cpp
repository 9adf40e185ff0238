#include "model/setting.h"

#include <algorithm>
#include <sstream>

#include "model/nearest_word.h"
#include "model/scene_keys.h"
#include "model/tree_reader.h"
#include "model/yaml_file.h"

namespace vibratory_alignment {
namespace {

/// The parts between the dots; empty if one of them is.
std::vector<std::string> split_key_path(const std::string& path) {
  std::vector<std::string> keys;
  std::istringstream stream(path);
  for (std::string key; std::getline(stream, key, '.');) keys.push_back(key);
  const bool has_gap = std::any_of(keys.begin(), keys.end(), [](const std::string& key) { return key.empty(); });
  return has_gap || path.empty() || path.back() == '.' ? std::vector<std::string>() : keys;
}

bool is_key(const YAML::Node& node, const std::string& key) { return node.IsScalar() && node.Scalar() == key; }

/// Puts one value into a tree (a null: takes the key out). Works on copies of the maps and lists that it passes
/// through, so that what an alias shares with them keeps its value.
class Setting {
 public:
  Setting(const std::string& source, const std::vector<std::string>& keys, const YAML::Node& value)
      : source_(source), keys_(keys), value_(value) {}

  /// `above` leads to the node, as a key path without positions in lists.
  YAML::Node applied_to(const YAML::Node& node, std::size_t level = 0, const std::string& above = "") const {
    if (level == keys_.size()) return value_;
    if (!node.IsDefined() || node.IsNull()) {
      const YAML::Node changed = in_map(YAML::Node(YAML::NodeType::Map), level, above);
      return node.IsDefined() && value_.IsNull() ? node : changed;
    }
    if (node.IsMap()) return in_map(node, level, above);
    if (node.IsSequence()) return in_list(node, level, above);
    fail("what stands above " + keys_[level] + " is neither a map nor a list");
  }

 private:
  bool removes_at(std::size_t level) const { return level + 1 == keys_.size() && value_.IsNull(); }

  YAML::Node in_map(const YAML::Node& map, std::size_t level, const std::string& above) const {
    const std::string place = (above.empty() ? "" : above + ".") + keys_[level];
    YAML::Node copy(YAML::NodeType::Map);
    bool found = false;
    for (const auto& entry : map) {
      const bool here = is_key(entry.first, keys_[level]);
      found = found || here;
      if (!here)
        copy.force_insert(entry.first, entry.second);
      else if (!removes_at(level))
        copy.force_insert(entry.first, applied_to(entry.second, level + 1, place));
    }
    if (!found && value_.IsNull()) refuse_unknown(place, level);
    if (!found && !value_.IsNull()) copy.force_insert(keys_[level], applied_to(YAML::Node(), level + 1, place));
    return copy;
  }

  /// What is not there need not be taken out, but it must be something that a scene could have. `place` ends with the
  /// key of this level.
  void refuse_unknown(std::string place, std::size_t level) const {
    for (std::size_t below = level + 1; below < keys_.size(); ++below) place += "." + keys_[below];
    const std::vector<std::string>& known = scene_keys();
    if (std::find(known.begin(), known.end(), place) == known.end())
      fail("there is no such key to take out" + did_you_mean(place, known));
  }

  YAML::Node in_list(const YAML::Node& list, std::size_t level, const std::string& above) const {
    const std::optional<double> index = parse_number(keys_[level]);
    bool found = false;
    YAML::Node copy(YAML::NodeType::Sequence);
    for (std::size_t i = 0; i < list.size(); ++i) {
      const bool here = index && *index == static_cast<double>(i);
      found = found || here;
      if (!here)
        copy.push_back(list[i]);
      else if (!removes_at(level))
        copy.push_back(applied_to(list[i], level + 1, above));
    }
    if (!found) fail("the list has " + std::to_string(list.size()) + " entries, counted from 0: no " + keys_[level]);
    return copy;
  }

  [[noreturn]] void fail(const std::string& fault) const { throw SceneError(source_, {fault}); }

  const std::string& source_;
  const std::vector<std::string>& keys_;
  const YAML::Node& value_;
};

/// True when one of two key paths is the other or leads to it.
bool on_one_way(const std::string& a, const std::string& b) {
  const std::string &less = a.size() < b.size() ? a : b, &more = a.size() < b.size() ? b : a;
  return more.compare(0, less.size(), less) == 0 && (more.size() == less.size() || more[less.size()] == '.');
}

bool is_replaced(const std::vector<ValueOrigin>& origins, std::size_t i) {
  return std::any_of(origins.begin() + static_cast<std::ptrdiff_t>(i) + 1, origins.end(),
                     [&](const ValueOrigin& later) { return later.key_path == origins[i].key_path; });
}

}  // namespace

void set_value(YAML::Node& tree, const std::string& key_path, const YAML::Node& value, const std::string& source) {
  const std::vector<std::string> keys = split_key_path(key_path);
  if (keys.empty()) throw SceneError(source, {key_path + ": must read key.path"});
  tree.reset(Setting(source, keys, value).applied_to(tree));
}

std::optional<YAML::Node> find_value(const YAML::Node& tree, const std::string& key_path) {
  YAML::Node found = tree;
  for (const std::string& key : split_key_path(key_path)) {
    std::optional<YAML::Node> below;
    std::size_t position = 0;
    for (const auto& entry : found) {
      if (found.IsMap() && is_key(entry.first, key)) below.emplace(entry.second);
      if (found.IsSequence() && parse_number(key) == static_cast<double>(position++)) below.emplace(entry);
    }
    if (!below) return std::nullopt;
    found.reset(*below);
  }
  return found;
}

void apply_setting(YAML::Node& tree, const std::string& assignment) {
  const std::string source = "--set " + assignment;
  const std::size_t equals = assignment.find('=');
  const std::string key_path = assignment.substr(0, equals);
  if (equals == std::string::npos || equals + 1 == assignment.size() || split_key_path(key_path).empty())
    throw SceneError(source, {"must read key.path=value"});
  set_value(tree, key_path, parse_yaml(assignment.substr(equals + 1), source), source);
}

ValueOrigin origin_of_setting(const std::string& setting) { return {setting.substr(0, setting.find('=')), setting}; }

void name_origins(const std::vector<ValueOrigin>& origins, std::vector<std::string>& faults) {
  for (std::string& fault : faults) {
    const std::string place = fault.substr(0, fault.find(": "));
    for (std::size_t i = 0; i < origins.size(); ++i)
      if (on_one_way(place, origins[i].key_path) && !is_replaced(origins, i))
        fault += " (set by " + origins[i].place + ")";
  }
}

}  // namespace vibratory_alignment
