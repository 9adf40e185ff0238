#include "study/calibration_file.h"

#include <filesystem>

#include "model/scene_error.h"
#include "model/tree_reader.h"
#include "model/yaml_file.h"
#include "study/study.h"

namespace vibratory_alignment {
namespace {

bool has_in_range(const CalibrationParameter& parameter, double value) {
  return value >= parameter.from && value <= parameter.to;
}

CalibrationParameter read_parameter(TreeReader reader, const std::string& name) {
  CalibrationParameter parameter;
  parameter.name = name;
  parameter.logarithmic = reader.choice("spacing", spacing_words).value_or(0) == 1;
  const NumberRule& rule = parameter.logarithmic ? positive_number : any_number;
  parameter.from = reader.required_number("from", rule);
  parameter.to = reader.required_number("to", rule);
  if (!(parameter.from < parameter.to)) reader.fault("to", "must be above `from`");
  parameter.start = reader.required_number("start", rule);
  if (reader.has("start") && !has_in_range(parameter, parameter.start))
    reader.fault("start", "must be from `from` to `to`");
  reader.refuse_unknown_keys();
  return parameter;
}

/// The first set of a reading: what it does not name starts as it does for all.
std::vector<double> read_start(TreeReader reader, const std::vector<CalibrationParameter>& parameters) {
  std::vector<double> start;
  for (const CalibrationParameter& parameter : parameters) {
    start.push_back(reader.number(parameter.name, any_number).value_or(parameter.start));
    if (reader.has(parameter.name) && !has_in_range(parameter, start.back()))
      reader.fault(parameter.name, "must be from `from` to `to`");
  }
  reader.refuse_unknown_keys();
  return start;
}

/// Study (or "all") -> key path -> formula.
CalibrationSettings read_settings(TreeReader reader, const std::vector<std::string>& studies) {
  CalibrationSettings settings;
  for (const std::string& study : studies) {
    TreeReader keys = reader.section(study);
    for (const std::string& key : keys.keys()) {
      const bool taken_out = keys.value(key)->IsNull();
      settings[study].emplace_back(key, taken_out ? "" : keys.text(key).value_or(""));
    }
  }
  reader.refuse_unknown_keys();
  return settings;
}

std::size_t read_count(TreeReader& reader, const char* key) {
  return static_cast<std::size_t>(reader.required_number(key, positive_whole_number));
}

Thinning read_thinning(TreeReader reader) {
  Thinning thinning;
  thinning.samples = read_count(reader, "samples");
  thinning.grid = read_count(reader, "grid");
  reader.refuse_unknown_keys();
  return thinning;
}

CalibrationAdaptation read_adaptation(TreeReader reader) {
  CalibrationAdaptation adaptation;
  adaptation.reach = reader.required_number("reach", positive_number);
  adaptation.evaluations = read_count(reader, "evaluations");
  adaptation.room = reader.required_number("room", not_negative_number);
  reader.refuse_unknown_keys();
  return adaptation;
}

CalibrationRound read_round(TreeReader reader) {
  CalibrationRound round;
  round.searches = read_count(reader, "searches");
  round.reach = reader.required_number("reach", positive_number);
  round.shared_evaluations = read_count(reader, "shared_evaluations");
  if (reader.has("adapt")) round.adaptation = read_adaptation(reader.section("adapt"));
  round.own_evaluations = read_count(reader, "own_evaluations");
  round.thinning = read_thinning(reader.section("thinning"));
  reader.refuse_unknown_keys();
  return round;
}

CalibrationSearch read_search(TreeReader reader, std::size_t parameters) {
  CalibrationSearch search;
  search.searches = read_count(reader, "searches");
  search.population = read_count(reader, "population");
  if (search.population <= parameters)
    reader.fault("population", "must be more than the parameters, " + std::to_string(parameters));
  search.global_evaluations = read_count(reader, "global_evaluations");
  search.thinning = read_thinning(reader.section("thinning"));
  for (const TreeReader& round : reader.sections("rounds")) search.rounds.push_back(read_round(round));
  search.local_evaluations = read_count(reader, "local_evaluations");
  search.finalists = read_count(reader, "finalists");
  search.leave_out = reader.texts("leave_out");
  reader.refuse_unknown_keys();
  return search;
}

}  // namespace

Calibration load_calibration(const std::string& path) {
  TreeReader::Faults faults;
  const YAML::Node tree = read_yaml_file(path);
  TreeReader root(tree, "", faults);
  Calibration calibration;
  calibration.source = path;
  calibration.text = YAML::Dump(tree);
  if (!root.has("facts")) root.fault("facts", "must be the name of a facts file, from the folder of this file");
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  calibration.facts_file = (folder / root.text("facts").value_or("")).lexically_normal().string();

  TreeReader parameters = root.section("parameters");
  for (const std::string& name : parameters.keys())
    calibration.parameters.push_back(read_parameter(parameters.section(name), name));
  if (calibration.parameters.empty()) root.fault("parameters", "must name at least one parameter");

  TreeReader settings = root.section("settings");
  calibration.settings = read_settings(settings, settings.keys());
  for (TreeReader& reading : root.sections("readings")) {
    CalibrationReading read;
    read.name = reading.line("name").value_or("as printed");
    if (reading.has("settings")) {
      TreeReader own = reading.section("settings");
      read.settings = read_settings(own, own.keys());
    }
    read.start = read_start(reading.section("start"), calibration.parameters);
    reading.refuse_unknown_keys();
    calibration.readings.push_back(std::move(read));
  }
  calibration.search = read_search(root.section("search"), calibration.parameters.size());
  root.refuse_unknown_keys();
  if (!faults.empty()) throw SceneError(path, faults);
  return calibration;
}

}  // namespace vibratory_alignment
