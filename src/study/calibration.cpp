#include "study/calibration.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <stdexcept>
#include <tuple>

#include "model/number_text.h"
#include "model/scene_error.h"
#include "model/setting.h"
#include "model/yaml_file.h"
#include "study/calibration_search.h"
#include "study/fingerprint.h"
#include "study/formula.h"
#include "study/study_refusals.h"
#include "study/thread_group.h"

namespace vibratory_alignment {
namespace {

/// Of what is found: nothing else is what somebody would write down.
constexpr int kDigits = 4;

void append(const CalibrationSettings& settings, const Table& parameters, FactSettings& all) {
  for (const auto& [study, assignments] : settings)
    for (const auto& [key, formula] : assignments) {
      const std::string value = formula.empty() ? "null" : number_text(evaluate_formula(formula, parameters).front());
      const std::string assignment = key + "=" + value;
      (study == "all" ? all.all : all.of_study[study]).push_back(assignment);
    }
}

/// What is wrong with one value that a set would put into scenes of these studies; empty if nothing is.
std::string fault_of_setting(const std::string& key, const std::string& formula, const Table& parameters,
                             const std::vector<const Study*>& studies) {
  try {
    YAML::Node value;
    if (!formula.empty()) value = number_text(evaluate_formula(formula, parameters).front());
    for (const Study* study : studies) {
      YAML::Node tree = YAML::Clone(*study->scene);
      set_value(tree, key, value, "");
    }
  } catch (const FormulaError& error) {
    return error.what();
  } catch (const SceneError& refusal) {
    return refusal.faults().front();
  }
  return "";
}

/// Adds what is wrong with the settings of a section, the values being those of the start.
void check_settings(const std::string& section, const CalibrationSettings& settings, const Table& parameters,
                    const Calibration& calibration, const FactSuite& suite, std::vector<std::string>& faults) {
  for (const auto& [name, own] : settings) {
    const std::string path = section + "." + name;
    std::vector<const Study*> studies;
    for (const auto& [study, content] : suite.studies)
      if (name == "all" || name == study) studies.push_back(&content);
    if (name != "all" && studies.empty())
      faults.push_back(path + ": must be `all` or a study of " + calibration.facts_file);
    for (const auto& [key, formula] : own) {
      const std::string fault = fault_of_setting(key, formula, parameters, studies);
      if (!fault.empty()) faults.push_back(path + "." + key + ": " + fault);
    }
  }
}

Table table_of(const Calibration& calibration, const std::vector<double>& values) {
  Table parameters;
  for (std::size_t i = 0; i < values.size(); ++i) {
    parameters.names.push_back(calibration.parameters[i].name);
    parameters.columns.push_back({values[i]});
  }
  return parameters;
}

/// Throws SceneError for a study all of whose trials are refused with the values that the reading starts with.
void refuse_without_scenes(const Calibration& calibration, const CalibrationReading& reading, const FactSuite& suite) {
  FactRunOptions options;
  options.settings = settings_of(calibration, reading, reading.start);
  for (const auto& [name, study] : studies_to_run(suite, options)) {
    try {
      refuse_without_scenes(study);
    } catch (const SceneError& refusal) {
      std::vector<std::string> faults;
      for (const std::string& fault : refusal.faults())
        faults.push_back("reading " + reading.name + ", at its start: study " + name + ": " + fault);
      throw SceneError(calibration.source, faults);
    }
  }
}

/// Calls work(0) ... work(count - 1), of which so many at a time. Throws what one of them has thrown, the first by
/// number, and std::runtime_error when the search was interrupted.
void in_threads(int threads, std::size_t count, CalibrationTally& tally, const std::function<void(std::size_t)>& work) {
  std::vector<std::exception_ptr> failures(count);
  std::atomic<std::size_t> next{0};
  const auto take_work = [&] {
    for (std::size_t job = next++; job < count && !tally.ended(); job = next++) {
      try {
        work(job);
      } catch (...) {
        if (tally.ended()) continue;  // it was told to stop
        failures[job] = std::current_exception();
        tally.end();
      }
    }
  };
  ThreadGroup pool;
  try {
    for (int i = 0; i < threads; ++i) pool.start(take_work);
  } catch (...) {
    tally.end();
    throw;
  }
  pool.join();
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
  if (tally.ended()) throw std::runtime_error("interrupted");
}

}  // namespace

double CalibrationAnswer::shortfall() const {
  double sum = 0.0;
  for (const Part& part : parts) sum += part.shortfall;
  return sum;
}

bool CalibrationPlace::operator<(const CalibrationPlace& other) const {
  return std::tie(reading, seed, number) < std::tie(other.reading, other.seed, other.number);
}

double CalibrationParameter::value_at(double share) const {
  const double value = logarithmic ? from * std::pow(to / from, share) : from + (to - from) * share;
  return std::min(to, std::max(from, rounded(value, kDigits)));
}

double CalibrationParameter::share_of(double value) const {
  const double share = logarithmic ? std::log(value / from) / std::log(to / from) : (value - from) / (to - from);
  return std::min(1.0, std::max(0.0, share));
}

FactSettings settings_of(const Calibration& calibration, const CalibrationReading& reading,
                         const std::vector<double>& values) {
  const Table parameters = table_of(calibration, values);
  FactSettings settings;
  append(calibration.settings, parameters, settings);
  append(reading.settings, parameters, settings);
  return settings;
}

std::size_t CalibratedSet::met() const {
  return static_cast<std::size_t>(
      std::count_if(results.begin(), results.end(), [](const FactResult& fact) { return fact.met; }));
}

std::string fingerprint(const Calibration& calibration, const FindScene& find_scene, const std::string& version) {
  const FactSuite suite = load_fact_suite(calibration.facts_file, find_scene);
  std::string text = version + "\n" + calibration.text + "\n" + YAML::Dump(read_yaml_file(calibration.facts_file));
  for (const auto& [name, study] : suite.studies) text += "\n" + name + " " + fingerprint(study, version);
  return fingerprint(text);
}

void check_calibration(const Calibration& calibration, const FactSuite& suite) {
  std::vector<std::string> faults;
  for (const std::string& id : calibration.search.leave_out) {
    const auto& facts = suite.book.facts;
    if (std::none_of(facts.begin(), facts.end(), [&](const Fact& fact) { return fact.id == id; }))
      faults.push_back("search.leave_out: " + id + ": must be the id of a fact in " + calibration.facts_file);
  }
  const auto check = [&](const std::string& section, const CalibrationSettings& settings, const Table& parameters) {
    check_settings(section, settings, parameters, calibration, suite, faults);
  };
  check("settings", calibration.settings, table_of(calibration, calibration.readings.front().start));
  for (std::size_t i = 0; i < calibration.readings.size(); ++i) {
    const CalibrationReading& reading = calibration.readings[i];
    check("readings." + std::to_string(i) + ".settings", reading.settings, table_of(calibration, reading.start));
  }
  if (!faults.empty()) throw SceneError(calibration.source, faults);
  for (const CalibrationReading& reading : calibration.readings) refuse_without_scenes(calibration, reading, suite);
}

CalibrationResult run_calibration(const Calibration& calibration, const CalibrationOptions& options) {
  const CalibrationSearch& search = calibration.search;
  const std::size_t jobs = calibration.readings.size() * search.searches;
  // one suite for each search: two threads must not read the same tree
  std::vector<FactSuite> suites;
  for (std::size_t i = 0; i < jobs; ++i) suites.push_back(load_fact_suite(calibration.facts_file, options.find_scene));
  CalibrationTally tally(options, suites.front().book.facts.size());
  std::vector<CalibrationRun> runs;
  for (std::size_t job = 0; job < jobs; ++job)
    runs.emplace_back(calibration, job / search.searches, 1 + job % search.searches, suites[job], tally);

  using Runs = std::vector<CalibrationRun*>;
  const auto all_of = [&](const Runs& some, const auto& work) {
    in_threads(options.threads, some.size(), tally, [&](std::size_t i) { work(*some[i]); });
  };
  Runs order;
  for (CalibrationRun& run : runs) order.push_back(&run);
  all_of(order, [](CalibrationRun& run) { run.search_all_ranges(); });
  // the searches that go on come first
  std::size_t going_on = jobs;
  const auto sort = [&](std::size_t count) {
    std::stable_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count),
                     [](const auto* a, const auto* b) { return a->best().shortfall < b->best().shortfall; });
  };
  const auto first = [&](std::size_t count) {
    return Runs(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count));
  };
  sort(going_on);
  for (const CalibrationRound& round : search.rounds) {
    going_on = std::min(going_on, round.searches);
    all_of(first(going_on), [&](CalibrationRun& run) { run.search_around(round); });
    sort(going_on);
  }
  all_of(first(going_on), [](CalibrationRun& run) { run.search_nearby(); });
  sort(going_on);

  CalibrationResult result;
  for (const CalibrationRun* run : order) result.best.push_back(run->best());
  FactRunOptions whole;
  whole.threads = options.threads;
  whole.go_on = options.go_on;
  const std::size_t finalists = std::min(search.finalists, jobs);
  for (std::size_t i = 0; i < finalists; ++i) {
    CalibratedSet& set = result.best[i];
    whole.settings = settings_of(calibration, calibration.readings[set.reading], set.values);
    set.results = evaluate_facts(suites.front(), whole);
  }
  std::stable_sort(result.best.begin(), result.best.begin() + static_cast<std::ptrdiff_t>(finalists),
                   [](const CalibratedSet& a, const CalibratedSet& b) { return a.met() > b.met(); });
  tally.fill(result);
  result.book = suites.front().book;
  return result;
}

}  // namespace vibratory_alignment
