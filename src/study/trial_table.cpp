#include "study/trial_table.h"

#include <string>

#include "study/design.h"
#include "study/row_numbers.h"

namespace vibratory_alignment {
namespace {

/// What is counted as 0 or 1.
struct FlagColumn {
  const char* name;
  bool (*holds)(const TrialRow& row);
};

constexpr FlagColumn kFlagColumns[] = {
    {"refused", [](const TrialRow& r) { return r.refused; }},
    {"failed", [](const TrialRow& r) { return r.outcome == Outcome::failed; }},
    {"stalled", [](const TrialRow& r) { return r.outcome == Outcome::stalled; }},
    {"aligned", [](const TrialRow& r) { return r.duration == r.duration; }},
    {"impact", [](const TrialRow& r) { return r.mode == Mode::impact; }},
    {"nonimpact", [](const TrialRow& r) { return r.mode == Mode::nonimpact; }},
    {"mixed", [](const TrialRow& r) { return r.mode == Mode::mixed; }},
};

}  // namespace

std::vector<std::string> trial_columns(const Study& study) {
  std::vector<std::string> names = {"index", "sample"};
  for (std::string name : varied_names(study)) {
    const std::size_t blank = name.find(' ');
    if (blank != std::string::npos) name[blank] = '_';
    names.push_back(name);
  }
  return names;
}

std::vector<double> trial_values(const Study& study, std::size_t index) {
  const std::size_t samples = study.samples ? study.samples->count : 1;
  std::vector<double> values = {static_cast<double>(index), static_cast<double>(index % samples)};
  for (const VariedValue& value : values_at(study, index)) values.push_back(value.number);
  return values;
}

TrialTable::TrialTable(const Study& study) : study_(study) {
  table_.names = trial_columns(study);
  for (const FlagColumn& column : kFlagColumns) table_.names.emplace_back(column.name);
  const std::vector<std::string>& numbers = row_number_names();
  table_.names.insert(table_.names.end(), numbers.begin(), numbers.end());
  table_.columns.resize(table_.names.size());
}

void TrialTable::add(const TrialRow& row) {
  std::vector<double> values = trial_values(study_, row.index);
  for (const FlagColumn& column : kFlagColumns) values.push_back(column.holds(row) ? 1.0 : 0.0);
  const std::vector<double> numbers = row_numbers(row);
  values.insert(values.end(), numbers.begin(), numbers.end());
  for (std::size_t i = 0; i < values.size(); ++i) table_.columns[i].push_back(values[i]);
}

}  // namespace vibratory_alignment
