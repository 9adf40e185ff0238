#include "study/trial_scenes.h"

#include <cmath>
#include <memory>
#include <optional>

#include "model/number_text.h"
#include "model/scene_loader.h"
#include "model/setting.h"
#include "model/tree_reader.h"

namespace vibratory_alignment {
namespace {

Study with_own_scene(Study study) {
  study.scene = std::make_shared<const YAML::Node>(YAML::Clone(*study.scene));
  return study;
}

}  // namespace

TrialScenes::TrialScenes(const Study& study) : study_(with_own_scene(study)) {
  for (const Dimension& dimension : study_.dimensions)
    keys_.insert(keys_.end(), dimension.keys.begin(), dimension.keys.end());
}

Scene TrialScenes::at(std::size_t index) {
  const std::vector<VariedValue> values = values_at(study_, index);
  if (!fits(values)) build(values);
  write(values);
  return load_scene(tree_, study_.scene_source);
}

/// Whether the tree differs from that of these values in numbers alone.
bool TrialScenes::fits(const std::vector<VariedValue>& values) const {
  if (!built_) return false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const VariedValue& built = (*built_)[i];
    const bool both_numbers = !std::isnan(values[i].number) && !std::isnan(built.number);
    if (!both_numbers && values[i].text != built.text) return false;
  }
  return true;
}

void TrialScenes::build(const std::vector<VariedValue>& values) {
  built_.reset();
  tree_.reset(YAML::Clone(*study_.scene));
  for (std::size_t i = 0; i < keys_.size(); ++i)
    if (!keys_[i].offset) set_value(tree_, keys_[i].key_path, YAML::Load(values[i].text), study_.source);
  leaves_.clear();
  bases_.clear();
  for (const VariedKey& key : keys_) {
    const std::optional<YAML::Node> found = find_value(tree_, key.key_path);
    const std::optional<double> number = found && found->IsScalar() ? parse_number(found->Scalar()) : std::nullopt;
    if (key.offset) {
      if (!number) throw SceneError(study_.source, {key.key_path + ": the trial has no number to add the offset to"});
      // a node of its own: an alias may share the one that is there
      set_value(tree_, key.key_path, YAML::Node(found->Scalar()), study_.source);
    }
    bases_.push_back(number.value_or(0.0));
  }
  for (const VariedKey& key : keys_) leaves_.push_back(find_value(tree_, key.key_path).value_or(YAML::Node()));
  built_ = values;
}

void TrialScenes::write(const std::vector<VariedValue>& values) {
  for (std::size_t i = 0; i < keys_.size(); ++i)
    if (!keys_[i].offset && !std::isnan(values[i].number)) leaves_[i] = values[i].text;
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    if (!keys_[i].offset) continue;
    double base = bases_[i];
    for (std::size_t j = 0; j < keys_.size(); ++j)
      if (!keys_[j].offset && keys_[j].key_path == keys_[i].key_path) base = values[j].number;
    leaves_[i] = number_text(base + values[i].number);
  }
}

}  // namespace vibratory_alignment
