#include "study/shortfall_of_sets.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "study/design.h"

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

}  // namespace

ShortfallOfSets::ShortfallOfSets(const Calibration& calibration, const CalibrationReading& reading,
                                 const FactSuite& suite)
    : calibration_(calibration), reading_(reading) {
  std::map<std::set<std::string>, FactSuite> parts;
  const std::vector<std::string>& leave_out = calibration.search.leave_out;
  for (const Fact& fact : suite.book.facts) {
    if (std::find(leave_out.begin(), leave_out.end(), fact.id) != leave_out.end()) continue;
    FactSuite& part = parts[studies_of(fact)];
    part.book.source = suite.book.source;
    part.book.facts.push_back(fact);
  }
  for (auto& [names, part] : parts) {
    for (const std::string& name : names) part.studies[name] = suite.studies.at(name);
    parts_.push_back(std::move(part));
  }
  std::stable_sort(parts_.begin(), parts_.end(), [&](const FactSuite& a, const FactSuite& b) {
    return trials_of(a, calibration.search.thinning) < trials_of(b, calibration.search.thinning);
  });
}

ShortfallOfSets::Answer ShortfallOfSets::operator()(const std::vector<double>& values, double most,
                                                    const std::function<bool()>& go_on) const {
  FactRunOptions options;
  options.settings = settings_of(calibration_, reading_, values);
  options.thinning = calibration_.search.thinning;
  options.go_on = go_on;
  Answer answer;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    for (const FactResult& result : evaluate_facts(parts_[i], options)) {
      answer.shortfall += result.shortfall;
      answer.met += result.met ? 1 : 0;
    }
    answer.trials += trials_of(parts_[i], options.thinning);
    answer.whole = i + 1 == parts_.size();
    if (answer.shortfall > most) break;
  }
  return answer;
}

}  // namespace vibratory_alignment
