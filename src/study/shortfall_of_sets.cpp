#include "study/shortfall_of_sets.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "study/design.h"
#include "study/formula.h"

namespace vibratory_alignment {
namespace {

std::set<std::string> studies_of(const Fact& fact) {
  FactBook book;
  book.facts = {fact};
  std::set<std::string> names;
  for (const TableName& table : tables_of(book)) names.insert(table.study);
  return names;
}

std::size_t trials_of(const FactSuite& part, const Thinning& thinning) {
  std::size_t trials = 0;
  for (const auto& [name, study] : part.studies) trials += trial_count(thinned(study, thinning));
  return trials;
}

std::vector<std::size_t> first_numbers(std::size_t count) {
  std::vector<std::size_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  return numbers;
}

/// Names of the values that the settings of a study (or "all") are made of.
std::set<std::string> values_of(const CalibrationSettings& settings, const std::string& study) {
  std::set<std::string> names;
  const auto own = settings.find(study);
  if (own == settings.end()) return names;
  for (const auto& [key, formula] : own->second)
    if (!formula.empty())
      for (const std::string& name : names_in_formula(formula)) names.insert(name);
  return names;
}

/// A copy of `group` that has what `other` has as well.
CalibrationGroup joined(CalibrationGroup group, const CalibrationGroup& other) {
  std::vector<std::size_t> parameters, parts;
  std::set_union(group.parameters.begin(), group.parameters.end(), other.parameters.begin(), other.parameters.end(),
                 std::back_inserter(parameters));
  std::set_union(group.parts.begin(), group.parts.end(), other.parts.begin(), other.parts.end(),
                 std::back_inserter(parts));
  return {parameters, parts};
}

bool share_a_value(const CalibrationGroup& a, const CalibrationGroup& b) {
  return std::find_first_of(a.parameters.begin(), a.parameters.end(), b.parameters.begin(), b.parameters.end()) !=
         a.parameters.end();
}

}  // namespace

ShortfallOfSets::ShortfallOfSets(const Calibration& calibration, const CalibrationReading& reading,
                                 const FactSuite& suite, const Thinning& thinning)
    : calibration_(calibration), reading_(reading), thinning_(thinning) {
  std::map<std::set<std::string>, Part> parts;
  const std::vector<std::string>& leave_out = calibration.search.leave_out;
  for (const Fact& fact : suite.book.facts) {
    if (std::find(leave_out.begin(), leave_out.end(), fact.id) != leave_out.end()) continue;
    FactSuite& part = parts[studies_of(fact)].suite;
    part.book.source = suite.book.source;
    part.book.facts.push_back(fact);
  }
  for (auto& [names, part] : parts) {
    for (const std::string& name : names) part.suite.studies[name] = suite.studies.at(name);
    part.trials = trials_of(part.suite, thinning);
    parts_.push_back(std::move(part));
  }
  std::stable_sort(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) { return a.trials < b.trials; });
}

CalibrationAnswer ShortfallOfSets::operator()(const std::vector<double>& values, const CalibrationGroup& group,
                                              double most, const std::function<bool()>& go_on) const {
  FactRunOptions options;
  options.settings = settings_of(calibration_, reading_, values);
  options.thinning = thinning_;
  options.go_on = go_on;
  CalibrationAnswer answer;
  for (const std::size_t part : group.parts) {
    CalibrationAnswer::Part judged;
    for (const FactResult& result : evaluate_facts(parts_[part].suite, options)) {
      judged.shortfall += result.shortfall / (1.0 + result.shortfall);
      judged.met += result.met ? 1 : 0;
    }
    answer.parts.push_back(judged);
    answer.trials += parts_[part].trials;
    if (answer.shortfall() > most) break;
  }
  return answer;
}

CalibrationGroup ShortfallOfSets::all() const {
  return {first_numbers(calibration_.parameters.size()), first_numbers(parts_.size())};
}

std::vector<CalibrationGroup> ShortfallOfSets::groups() const {
  const std::vector<CalibrationParameter>& parameters = calibration_.parameters;
  std::set<std::string> common = values_of(calibration_.settings, "all");
  common.merge(values_of(reading_.settings, "all"));
  CalibrationGroup shared{{}, first_numbers(parts_.size())};
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (common.count(parameters[i].name) > 0) shared.parameters.push_back(i);

  std::vector<CalibrationGroup> own;
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    std::set<std::string> names;
    for (const auto& [study, rest] : parts_[p].suite.studies) {
      names.merge(values_of(calibration_.settings, study));
      names.merge(values_of(reading_.settings, study));
    }
    CalibrationGroup group{{}, {p}};
    for (std::size_t i = 0; i < parameters.size(); ++i)
      if (names.count(parameters[i].name) > 0 && common.count(parameters[i].name) == 0) group.parameters.push_back(i);
    if (group.parameters.empty()) continue;
    // takes in all groups that it has a value in common with
    const auto apart = std::stable_partition(
        own.begin(), own.end(), [&](const CalibrationGroup& other) { return !share_a_value(group, other); });
    for (auto other = apart; other != own.end(); ++other) group = joined(std::move(group), *other);
    own.erase(apart, own.end());
    own.push_back(std::move(group));
  }
  if (!shared.parameters.empty()) own.insert(own.begin(), std::move(shared));
  return own;
}

}  // namespace vibratory_alignment
