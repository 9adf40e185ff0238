// The schema of a study: which keys there are, what each may be, what holds between them.
#include "study/study_file.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "model/scene_error.h"
#include "model/setting.h"
#include "model/tree_reader.h"
#include "model/yaml_file.h"
#include "study/design.h"
#include "study/study_refusals.h"

namespace vibratory_alignment {
namespace {

// The words for an enumerator stand at its index.
const std::vector<std::string> method_words = {"sobol", "random"};
const std::vector<std::string> role_words = {"value", "offset"};

const NumberRule count_rule = {"a whole number from 2 to 1e9", 2.0, 1e9, true, true};
const NumberRule seed_rule = {"a whole number from 0 to 9007199254740992", 0.0, 9007199254740992.0, true, true};

/// The sequence of Sobol has 3667.
constexpr std::size_t kMostCoordinates = 1000;

void put_on_one_line(YAML::Node node) {
  if (!node.IsMap() && !node.IsSequence()) return;
  node.SetStyle(YAML::EmitterStyle::Flow);
  for (const auto& entry : node) put_on_one_line(node.IsMap() ? entry.second : YAML::Node(entry));
}

/// A value as YAML on one line; numbers as they stand in the file.
std::string text_of(const YAML::Node& value) {
  if (value.IsNull()) return "null";
  if (value.IsScalar() && parse_number(value.Scalar())) return value.Scalar();
  const YAML::Node copy = YAML::Clone(value);
  put_on_one_line(copy);
  YAML::Emitter emitter;
  emitter << copy;
  return emitter.c_str();
}

class StudyReader {
 public:
  StudyReader(const YAML::Node& tree, TreeReader::Faults& faults) : faults_(faults), root_(tree, "", faults) {}

  /// All but the scene. Means nothing if there are faults then.
  Study read();

  /// What `scene` says; empty if it is faulty.
  const std::string& scene() const { return scene_; }
  /// Entries of `set`, in the order of the file.
  const std::vector<std::pair<std::string, YAML::Node>>& settings() const { return settings_; }

 private:
  Dimension read_dimension(TreeReader& entry);
  std::size_t read_range(TreeReader range, VariedKey& key);
  void refuse_overlap(TreeReader& entry, const VariedKey& key);
  void read_samples();
  void refuse_too_many();

  TreeReader::Faults& faults_;
  TreeReader root_;
  std::string scene_;
  std::vector<std::pair<std::string, YAML::Node>> settings_;
  std::vector<VariedKey> varied_;
  Study study_;
};

Study StudyReader::read() {
  study_.name = root_.line("study").value_or("");
  scene_ = root_.line("scene").value_or("");
  if (!root_.has("scene")) root_.fault("scene", "must be the name of a scene, or its file");
  if (root_.has("set")) {
    TreeReader set = root_.section("set");
    for (const std::string& key : set.keys()) settings_.emplace_back(key, *set.value(key));
  }
  const YAML::Node* vary = root_.value("vary");
  if (vary != nullptr && vary->IsMap() && vary->size() > 1) {
    root_.fault("vary",
                "must be a list: `- KEY: ...` for each key that changes by itself, `- {KEY: ..., KEY: ...}` for "
                "keys that change together");
  } else if (vary != nullptr) {
    for (TreeReader& entry : root_.sections("vary")) study_.dimensions.push_back(read_dimension(entry));
    for (const Dimension& dimension : study_.dimensions)
      if (dimension.keys.empty() && faults_.empty()) root_.fault("vary", "every entry must name a key");
  }
  read_samples();
  root_.refuse_unknown_keys();
  if (faults_.empty()) refuse_too_many();
  return study_;
}

Dimension StudyReader::read_dimension(TreeReader& entry) {
  Dimension dimension;
  for (const std::string& path : entry.keys()) {
    VariedKey key;
    key.key_path = path;
    const YAML::Node& node = *entry.value(path);
    std::size_t count = 1;
    const std::size_t faults_before = faults_.size();
    if (node.IsSequence() && node.size() > 0) {
      for (const auto& value : node) key.values.push_back(text_of(value));
      count = key.values.size();
    } else if (node.IsMap()) {
      count = read_range(entry.section(path), key);
    } else {
      entry.fault(path, "must be a list of at least one value, or a range {from: ..., to: ..., count: ...}");
    }
    refuse_overlap(entry, key);
    if (dimension.keys.empty())
      dimension.count = count;
    else if (count != dimension.count && faults_.size() == faults_before)
      entry.fault(
          path,
          "keys of one entry change together: they must have equally many values, or all be sampled (no `count`)");
    dimension.keys.push_back(key);
    varied_.push_back(key);
  }
  return dimension;
}

/// Returns the count, 0 for a range that is sampled; something if it is faulty.
std::size_t StudyReader::read_range(TreeReader range, VariedKey& key) {
  key.logarithmic = range.choice("spacing", spacing_words) == std::size_t{1};
  key.offset = range.choice("as", role_words) == std::size_t{1};
  const NumberRule& rule = key.logarithmic ? positive_number : any_number;
  key.from = range.required_number("from", rule);
  key.to = range.required_number("to", rule);
  const std::optional<double> count = range.number("count", count_rule);
  const bool sampled = !range.has("count");
  range.refuse_unknown_keys();
  return sampled ? 0 : static_cast<std::size_t>(count.value_or(1.0));
}

/// A key has one value and one offset at most, and no other key leads through it.
void StudyReader::refuse_overlap(TreeReader& entry, const VariedKey& key) {
  const auto leads_through = [](const std::string& path, const std::string& above) {
    return path.compare(0, above.size() + 1, above + ".") == 0;
  };
  for (const VariedKey& other : varied_) {
    if (other.key_path == key.key_path && other.offset == key.offset)
      entry.fault(key.key_path, "is varied twice");
    else if (leads_through(key.key_path, other.key_path) || leads_through(other.key_path, key.key_path))
      entry.fault(key.key_path, "cannot be varied along with " + other.key_path + ": one is part of the other");
  }
}

void StudyReader::read_samples() {
  std::size_t coordinates = 0;
  for (const Dimension& dimension : study_.dimensions)
    if (!dimension.keys.empty() && dimension.sampled()) ++coordinates;
  if (coordinates == 0) {
    if (root_.has("samples") && faults_.empty())
      root_.fault("samples", "nothing is sampled: no range is given without `count`");
    return;
  }
  if (coordinates > kMostCoordinates)
    root_.fault("vary", "at most " + std::to_string(kMostCoordinates) + " ranges without `count` can be sampled");
  if (!root_.has("samples") && faults_.empty())
    root_.fault("samples", "must say how many, for the ranges without `count`: {count: ...}");
  TreeReader samples = root_.section("samples");
  study_.samples.emplace();
  const std::optional<std::size_t> method = samples.choice("method", method_words);
  if (method) study_.samples->method = static_cast<SampleMethod>(*method);
  if (root_.has("samples"))
    study_.samples->count = static_cast<std::size_t>(samples.required_number("count", positive_whole_number));
  study_.samples->seed = static_cast<std::uint64_t>(samples.number("seed", seed_rule).value_or(0.0));
  samples.refuse_unknown_keys();
}

void StudyReader::refuse_too_many() {
  std::size_t room = kMostTrials / (study_.samples ? study_.samples->count : 1);
  for (const Dimension& dimension : study_.dimensions)
    if (!dimension.sampled()) room /= dimension.count;
  if (room == 0) root_.fault("vary", "a study has at most 1e15 trials");
}

/// The scene's tree with what the study sets.
YAML::Node scene_tree(const std::string& file, const StudyReader& reader, const std::string& source) {
  YAML::Node tree = read_yaml_file(file);
  TreeReader::Faults faults;
  for (const auto& [key_path, value] : reader.settings()) {
    try {
      set_value(tree, key_path, value, source);
    } catch (const SceneError& error) {
      for (const std::string& fault : error.faults()) faults.push_back("set." + key_path + ": " + fault);
    }
  }
  if (!faults.empty()) throw SceneError(source, faults);
  return YAML::Clone(tree);
}

/// A file beside the study, or what `find_scene` finds.
std::string scene_file(const std::string& scene, const std::string& study, const FindScene& find_scene) {
  const std::filesystem::path beside = std::filesystem::path(study).parent_path() / scene;
  std::error_code error;
  if (std::filesystem::is_regular_file(beside, error)) return beside.string();
  try {
    return find_scene(scene);
  } catch (const std::runtime_error& refusal) {
    throw SceneError(study, {std::string("scene: ") + refusal.what()});
  }
}

}  // namespace

Study load_study(const std::string& path, const FindScene& find_scene) {
  TreeReader::Faults faults;
  StudyReader reader(read_yaml_file(path), faults);
  Study study = reader.read();
  if (!faults.empty()) throw SceneError(path, faults);
  study.source = path;
  if (study.name.empty()) study.name = std::filesystem::path(path).stem().string();
  study.scene_source = scene_file(reader.scene(), path, find_scene);
  study.scene = std::make_shared<const YAML::Node>(scene_tree(study.scene_source, reader, path));
  for (const auto& [key_path, value] : reader.settings()) study.origins.push_back({key_path, path + ": set"});
  refuse_without_scenes(study);
  return study;
}

Study with_settings(const Study& study, const std::vector<std::string>& settings) {
  Study changed = study;
  YAML::Node tree = YAML::Clone(*study.scene);
  for (const std::string& setting : settings) {
    apply_setting(tree, setting);
    changed.origins.push_back(origin_of_setting(setting));
  }
  changed.scene = std::make_shared<const YAML::Node>(tree);
  return changed;
}

}  // namespace vibratory_alignment
