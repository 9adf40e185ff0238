#include "study/trial_table.h"

#include <string>

#include "study/design.h"

namespace vibratory_alignment {
namespace {

/// A quantity of a trial, and of each spot of it.
struct TrialColumn {
  const char* name;
  double (*value)(const TrialRow& row);
};
struct SpotColumn {
  const char* name;
  double (*value)(const TrialRow& row, std::size_t spot);
};

double flag(bool holds) { return holds ? 1.0 : 0.0; }

constexpr TrialColumn kTrialColumns[] = {
    {"refused", [](const TrialRow& r) { return flag(r.refused); }},
    {"failed", [](const TrialRow& r) { return flag(r.outcome == Outcome::failed); }},
    {"stalled", [](const TrialRow& r) { return flag(r.outcome == Outcome::stalled); }},
    {"aligned", [](const TrialRow& r) { return flag(r.duration == r.duration); }},
    {"impact", [](const TrialRow& r) { return flag(r.mode == Mode::impact); }},
    {"nonimpact", [](const TrialRow& r) { return flag(r.mode == Mode::nonimpact); }},
    {"mixed", [](const TrialRow& r) { return flag(r.mode == Mode::mixed); }},
    {"duration", [](const TrialRow& r) { return r.duration; }},
    {"end_time", [](const TrialRow& r) { return r.end_time; }},
    {"nonimpact_time", [](const TrialRow& r) { return r.nonimpact_time; }},
    {"x", [](const TrialRow& r) { return r.end.x; }},
    {"y", [](const TrialRow& r) { return r.end.y; }},
    {"phi", [](const TrialRow& r) { return r.end.phi; }},
    {"vx", [](const TrialRow& r) { return r.end.vx; }},
    {"vy", [](const TrialRow& r) { return r.end.vy; }},
    {"omega", [](const TrialRow& r) { return r.end.omega; }},
};

constexpr SpotColumn kSpotColumns[] = {
    {"impacts", [](const TrialRow& r, std::size_t s) { return static_cast<double>(r.impacts[s]); }},
    {"first_impact", [](const TrialRow& r, std::size_t s) { return r.first_impact[s]; }},
    {"last_impact", [](const TrialRow& r, std::size_t s) { return r.last_impact[s]; }},
    {"peak_force", [](const TrialRow& r, std::size_t s) { return r.peak_force[s]; }},
    {"normal_impulse", [](const TrialRow& r, std::size_t s) { return r.normal_impulse[s]; }},
    {"friction_impulse", [](const TrialRow& r, std::size_t s) { return r.friction_impulse[s]; }},
    {"impulse_x", [](const TrialRow& r, std::size_t s) { return r.impulse_x[s]; }},
    {"impulse_y", [](const TrialRow& r, std::size_t s) { return r.impulse_y[s]; }},
    {"contact_time", [](const TrialRow& r, std::size_t s) { return r.contact_time[s]; }},
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
  for (const TrialColumn& column : kTrialColumns) table_.names.emplace_back(column.name);
  for (const SpotColumn& column : kSpotColumns)
    for (int spot = 0; spot < kSpotCount; ++spot)
      table_.names.push_back(std::string(column.name) + "_" + to_string(static_cast<Spot>(spot)));
  table_.columns.resize(table_.names.size());
}

void TrialTable::add(const TrialRow& row) {
  std::vector<double> values = trial_values(study_, row.index);
  for (const TrialColumn& column : kTrialColumns) values.push_back(column.value(row));
  for (const SpotColumn& column : kSpotColumns)
    for (std::size_t spot = 0; spot < kSpotCount; ++spot) values.push_back(column.value(row, spot));
  for (std::size_t i = 0; i < values.size(); ++i) table_.columns[i].push_back(values[i]);
}

}  // namespace vibratory_alignment
