#include "study/study_refusals.h"

#include <algorithm>
#include <map>
#include <optional>

#include "model/scene_error.h"
#include "model/setting.h"
#include "study/design.h"
#include "study/scramble.h"
#include "study/trial_scenes.h"

namespace vibratory_alignment {
namespace {

/// Trials that are looked at when one after the other is refused.
constexpr std::size_t kMostLooks = 1000;

/// The first, the middle and the last one, and others in no order: in step with nothing that is varied.
std::vector<std::size_t> trials_to_look_at(std::size_t count) {
  std::vector<std::size_t> trials;
  for (std::size_t i = 0; i < std::min(count, kMostLooks); ++i)
    trials.push_back(count > kMostLooks ? static_cast<std::size_t>(scrambled(i + 1) % count) : i);
  if (count > kMostLooks) trials.insert(trials.begin(), {0, count / 2, count - 1});
  return trials;
}

std::map<std::string, std::string> values_by_key(const Study& study, std::size_t trial) {
  std::map<std::string, std::string> texts;
  const std::vector<std::string> names = varied_names(study);
  const std::vector<VariedValue> values = values_at(study, trial);
  for (std::size_t i = 0; i < names.size(); ++i) texts[names[i]] = values[i].text;
  return texts;
}

/// What is wrong with a trial, without the values that are its own, and the faults that say so.
using Reasons = std::map<std::string, std::string>;

Reasons reasons_of(const SceneError& refusal, const std::map<std::string, std::string>& values) {
  Reasons reasons;
  for (const std::string& fault : refusal.faults()) {
    const std::string place = fault.substr(0, fault.find(": "));
    const auto value = values.find(place);
    const std::string with_value = value == values.end() ? "" : place + ": " + value->second + ": ";
    const bool shows_value = !with_value.empty() && fault.compare(0, with_value.size(), with_value) == 0;
    reasons[shows_value ? place + ": " + fault.substr(with_value.size()) : fault] = fault;
  }
  return reasons;
}

Reasons in_both(const Reasons& a, const Reasons& b) {
  Reasons common;
  for (const auto& [reason, fault] : a)
    if (b.count(reason) > 0) common[reason] = fault;
  return common;
}

/// What is common to all trials, or else what is wrong with the first one; with what has set the values.
[[noreturn]] void refuse(const Study& study, const SceneError& first, const Reasons& common) {
  std::vector<std::string> faults = first.faults();
  const auto is_its_own = [&](const std::string& fault) {
    return std::none_of(common.begin(), common.end(), [&](const auto& reason) { return reason.second == fault; });
  };
  if (!common.empty()) faults.erase(std::remove_if(faults.begin(), faults.end(), is_its_own), faults.end());
  std::vector<ValueOrigin> origins = study.origins;
  for (const Dimension& dimension : study.dimensions)
    for (const VariedKey& key : dimension.keys) origins.push_back({key.key_path, study.source + ": vary"});
  if (first.source() != study.source) name_origins(origins, faults);
  throw SceneError(first.source(), faults);
}

bool is_at_or_below(const std::string& key_path, const std::string& above) {
  return (key_path + ".").compare(0, above.size() + 1, above + ".") == 0;
}

}  // namespace

void refuse_without_scenes(const Study& study) {
  TrialScenes scenes(study);
  const std::size_t count = trial_count(study);
  std::optional<SceneError> first;
  Reasons common;
  for (const std::size_t index : trials_to_look_at(count)) {
    try {
      scenes.at(index);
      return;
    } catch (const SceneError& refusal) {
      const Reasons reasons = reasons_of(refusal, values_by_key(study, index));
      common = first ? in_both(common, reasons) : reasons;
      if (!first) first = refusal;
    }
    // the trials that are not looked at may have scenes
    if (count > kMostLooks && common.empty()) return;
  }
  refuse(study, *first, common);
}

void refuse_settings_of_varied_keys(const Study& study, const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) {
    const std::string key_path = origin_of_setting(setting).key_path;
    for (const Dimension& dimension : study.dimensions)
      for (const VariedKey& key : dimension.keys)
        if (!key.offset && is_at_or_below(key_path, key.key_path))
          throw SceneError("--set " + setting, {study.source + " varies " + key.key_path + ": no trial would have it"});
  }
}

}  // namespace vibratory_alignment
