// A scene's tree: read from a file, changed by settings. What it means is up to load_scene (scene_loader.cpp).
// A study's file (study/study_file.h) is read in the same way.
#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include "model/nearest_word.h"
#include "model/scene_keys.h"
#include "model/scene_loader.h"
#include "model/tree_reader.h"

namespace vibratory_alignment {
namespace {

// A scene is some 50 lines and 4 levels deep; these bounds keep hostile files from exhausting stack and time.
constexpr std::size_t most_bytes = 64 * 1024;
constexpr std::size_t most_marks = 4000;
constexpr int most_levels = 20;
constexpr int most_nodes = 20'000;

/// UTF-8 without control characters other than tabs and line ends.
bool is_text(const std::string& bytes) {
  std::size_t continuation_bytes = 0;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (continuation_bytes > 0) {
      if ((byte & 0xc0) != 0x80) return false;
      --continuation_bytes;
    } else if (byte < 0x20 || byte == 0x7f) {
      if (c != '\t' && c != '\n' && c != '\r') return false;
    } else if (byte >= 0x80) {
      if (byte < 0xc2 || byte > 0xf4) return false;
      continuation_bytes = byte < 0xe0 ? 1 : byte < 0xf0 ? 2 : 3;
    }
  }
  return continuation_bytes == 0;
}

/// Upper bound of the depth to which yaml-cpp recurses: the marks that can open a level. (Its own guard is as late as
/// 0.7.)
std::size_t count_marks(const std::string& text) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool before_blank = i + 1 == text.size() || std::isspace(static_cast<unsigned char>(text[i + 1])) != 0;
    if (c == '[' || c == '{' || (before_blank && (c == '-' || c == '?' || c == ':'))) ++count;
  }
  return count;
}

/// False if the tree contains itself, or grows huge, by way of aliases.
bool has_sane_extent(const YAML::Node& node, int levels_left, int& nodes_left) {
  if (levels_left == 0 || --nodes_left < 0) return false;
  for (const auto& entry : node) {
    if (node.IsSequence()) {
      if (!has_sane_extent(entry, levels_left - 1, nodes_left)) return false;
    } else if (!has_sane_extent(entry.first, levels_left - 1, nodes_left) ||
               !has_sane_extent(entry.second, levels_left - 1, nodes_left)) {
      return false;
    }
  }
  return true;
}

/// Counts documents up to 2, and nothing else. YAML::LoadAll cannot be asked: stray text makes it fill the memory.
class DocumentCounter : public YAML::EventHandler {
 public:
  explicit DocumentCounter(const std::string& text) {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (count_ < 2 && parser.HandleNextDocument(*this)) ++count_;
  }
  int count() const { return count_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

 private:
  int count_ = 0;
};

/// The one document of the text. `source` is for messages.
YAML::Node parse(const std::string& text, const std::string& source) {
  if (text.size() > most_bytes) throw SceneError(source, {"is too large: at most 64 KiB are read"});
  if (!is_text(text)) throw SceneError(source, {"is not text (UTF-8)"});
  if (count_marks(text) > most_marks)
    throw SceneError(
        source, {"is too large: at most " + std::to_string(most_marks) + " keys, list entries and brackets are read"});
  YAML::Node tree;
  int documents = 0;
  try {
    // yaml-cpp 0.6.2 hangs on a colon at the very end.
    documents = DocumentCounter(text + "\n").count();
    if (documents == 1) tree.reset(YAML::Load(text + "\n"));
  } catch (const YAML::Exception& error) {
    const std::string place = error.mark.is_null() ? ""
                                                   : "line " + std::to_string(error.mark.line + 1) + ", column " +
                                                         std::to_string(error.mark.column + 1) + ": ";
    throw SceneError(source, {place + "is not YAML: " + error.msg});
  }
  if (documents == 0) throw SceneError(source, {"is empty"});
  if (documents > 1) throw SceneError(source, {"must be one YAML document, with nothing before or after it"});
  int nodes_left = most_nodes;
  if (!has_sane_extent(tree, most_levels, nodes_left))
    throw SceneError(source, {"is nested too deeply or too large (an alias inside what it stands for?)"});
  return tree;
}

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

}  // namespace

YAML::Node read_yaml_file(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) throw SceneError(path, {"there is no such file"});
  if (std::filesystem::is_directory(status)) throw SceneError(path, {"is a directory: name a file in it"});
  if (!std::filesystem::is_regular_file(status)) throw SceneError(path, {"cannot be read: is not a regular file"});
  std::ifstream file(path, std::ios::binary);
  if (!file) throw SceneError(path, {"cannot be read"});
  std::string text(most_bytes + 1, '\0');
  file.read(&text[0], static_cast<std::streamsize>(text.size()));
  if (file.bad()) throw SceneError(path, {"cannot be read"});
  text.resize(static_cast<std::size_t>(file.gcount()));
  const YAML::Node tree = parse(text, path);
  if (tree.IsNull()) throw SceneError(path, {"is empty"});
  return tree;
}

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
  set_value(tree, key_path, parse(assignment.substr(equals + 1), source), source);
}

Scene load_scene_file(const std::string& path, const std::vector<std::string>& settings) {
  YAML::Node tree = read_yaml_file(path);
  for (const std::string& setting : settings) apply_setting(tree, setting);
  return load_scene(tree, path, settings);
}

}  // namespace vibratory_alignment
