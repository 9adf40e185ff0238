#include "study/calibration.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <nlopt.hpp>
#include <set>
#include <stdexcept>
#include <thread>

#include "model/number_text.h"
#include "model/scene_loader.h"
#include "study/formula.h"
#include "study/shortfall_of_sets.h"

namespace vibratory_alignment {
namespace {

/// First step of the local search, as a share of the ranges.
constexpr double kLocalStep = 0.1;

/// How much more than the best set of a local search another may fall short before it is given up: far more than a
/// simplex of kLocalStep spans.
constexpr double kLocalRoom = 4.0;

void append(const CalibrationSettings& settings, const Table& parameters, FactSettings& all) {
  for (const auto& [study, assignments] : settings)
    for (const auto& [key, formula] : assignments) {
      const std::string assignment = key + "=" + number_text(evaluate_formula(formula, parameters).front());
      (study == "all" ? all.all : all.of_study[study]).push_back(assignment);
    }
}

/// What all searches count together.
class Tally {
 public:
  Tally(const CalibrationOptions& options, std::size_t facts, std::size_t all_evaluations)
      : options_(options), sets_that_meet_(facts + 1) {
    progress_.all_evaluations = all_evaluations;
    progress_.best_shortfall = std::numeric_limits<double>::infinity();
  }

  void count(const ShortfallOfSets::Answer& answer) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++progress_.evaluations;
    progress_.trials += answer.trials;
    if (answer.whole) {
      ++sets_that_meet_[answer.met];
      if (answer.shortfall < progress_.best_shortfall) {
        progress_.best_shortfall = answer.shortfall;
        progress_.best_met = answer.met;
      }
    }
    if (options_.progress) options_.progress(progress_);
  }

  /// Of the caller, asked by one thread at a time.
  bool go_on() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!ended_ && options_.go_on && !options_.go_on()) ended_ = true;
    return !ended_;
  }

  void end() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
  }

  bool ended() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return ended_;
  }

  void fill(CalibrationResult& result) const {
    result.evaluations = progress_.evaluations;
    result.trials = progress_.trials;
    result.sets_that_meet = sets_that_meet_;
  }

 private:
  const CalibrationOptions& options_;
  std::mutex mutex_;
  CalibrationProgress progress_;
  std::vector<std::size_t> sets_that_meet_;
  bool ended_ = false;
};

/// The search with one reading and one seed.
class Search {
 public:
  Search(const Calibration& calibration, std::size_t reading, std::size_t seed, const FactSuite& suite, Tally& tally)
      : calibration_(calibration), shortfall_(calibration, calibration.readings[reading], suite), tally_(tally) {
    best_.reading = reading;
    best_.seed = seed;
    best_.shortfall = std::numeric_limits<double>::infinity();
  }

  CalibratedSet run() {
    const CalibrationSearch& search = calibration_.search;
    const auto dimension = static_cast<unsigned>(calibration_.parameters.size());
    nlopt::srand(best_.seed);  // of this thread
    std::vector<double> shares;
    for (const CalibrationParameter& parameter : calibration_.parameters)
      shares.push_back(parameter.share_of(parameter.start));

    nlopt::opt global(nlopt::GN_CRS2_LM, dimension);
    global.set_population(static_cast<unsigned>(search.population));
    stage(global, search.global_evaluations, shares, [&] { return worst_of_population(); });

    nlopt::opt local(nlopt::LN_SBPLX, dimension);
    local.set_initial_step(kLocalStep);
    stage(local, search.local_evaluations, best_shares_, [&] { return best_.shortfall + kLocalRoom; });
    return best_;
  }

 private:
  /// Minimizes over the unit cube from `shares`; a set that falls short by more than `most()` is given up.
  void stage(nlopt::opt& optimizer, std::size_t evaluations, std::vector<double> shares,
             const std::function<double()>& most) {
    if (evaluations == 0) return;
    const std::size_t dimension = calibration_.parameters.size();
    optimizer.set_lower_bounds(std::vector<double>(dimension, 0.0));
    optimizer.set_upper_bounds(std::vector<double>(dimension, 1.0));
    optimizer.set_maxeval(static_cast<int>(evaluations));
    std::size_t looked_at = 0;
    const std::function<double(const std::vector<double>&)> objective = [&](const std::vector<double>& point) {
      // NLopt itself may look at a few more
      if (!tally_.go_on() || looked_at == evaluations) throw nlopt::forced_stop();
      ++looked_at;
      return look_at(point, most());
    };
    using Objective = std::function<double(const std::vector<double>&)>;
    optimizer.set_min_objective([](const std::vector<double>& point, std::vector<double>&,
                                   void* data) { return (*static_cast<const Objective*>(data))(point); },
                                const_cast<Objective*>(&objective));
    double least = 0.0;
    try {
      optimizer.optimize(shares, least);
    } catch (const nlopt::roundoff_limited&) {
      // as near as it gets
    } catch (const nlopt::forced_stop&) {
      if (tally_.ended()) throw;
    }
  }

  double look_at(const std::vector<double>& shares, double most) {
    std::vector<double> values;
    for (std::size_t i = 0; i < shares.size(); ++i) values.push_back(calibration_.parameters[i].value_at(shares[i]));
    const ShortfallOfSets::Answer answer = shortfall_(values, most, [&] { return tally_.go_on(); });
    tally_.count(answer);
    seen_.insert(answer.shortfall);
    if (seen_.size() > calibration_.search.population) seen_.erase(std::prev(seen_.end()));
    if (answer.whole && answer.shortfall < best_.shortfall) {
      best_.shortfall = answer.shortfall;
      best_.values = values;
      best_shares_ = shares;
    }
    return answer.shortfall;
  }

  /// CRS2 keeps the best sets so far, as many as its population; one that is worse changes nothing.
  double worst_of_population() const {
    return seen_.size() < calibration_.search.population ? std::numeric_limits<double>::infinity() : *seen_.rbegin();
  }

  const Calibration& calibration_;
  ShortfallOfSets shortfall_;
  Tally& tally_;
  CalibratedSet best_;
  std::vector<double> best_shares_;
  std::multiset<double> seen_;  ///< the least shortfalls, as many as the population
};

/// Throws SceneError for facts and studies that there are not.
void check_names(const Calibration& calibration, const FactSuite& suite) {
  std::vector<std::string> faults;
  for (const std::string& id : calibration.search.leave_out) {
    const auto& facts = suite.book.facts;
    if (std::none_of(facts.begin(), facts.end(), [&](const Fact& fact) { return fact.id == id; }))
      faults.push_back("search.leave_out: " + id + ": must be the id of a fact in " + calibration.facts_file);
  }
  const auto check = [&](const std::string& path, const CalibrationSettings& settings) {
    for (const auto& [study, own] : settings)
      if (study != "all" && suite.studies.count(study) == 0)
        faults.push_back(path + "." + study + ": must be `all` or a study of " + calibration.facts_file);
  };
  check("settings", calibration.settings);
  for (const CalibrationReading& reading : calibration.readings) check("readings.settings", reading.settings);
  if (!faults.empty()) throw SceneError(calibration.source, faults);
}

}  // namespace

double CalibrationParameter::value_at(double share) const {
  return logarithmic ? from * std::pow(to / from, share) : from + (to - from) * share;
}

double CalibrationParameter::share_of(double value) const {
  const double share = logarithmic ? std::log(value / from) / std::log(to / from) : (value - from) / (to - from);
  return std::min(1.0, std::max(0.0, share));
}

FactSettings settings_of(const Calibration& calibration, const CalibrationReading& reading,
                         const std::vector<double>& values) {
  Table parameters;
  for (std::size_t i = 0; i < values.size(); ++i) {
    parameters.names.push_back(calibration.parameters[i].name);
    parameters.columns.push_back({values[i]});
  }
  FactSettings settings;
  append(calibration.settings, parameters, settings);
  append(reading.settings, parameters, settings);
  return settings;
}

std::size_t CalibratedSet::met() const {
  return static_cast<std::size_t>(
      std::count_if(results.begin(), results.end(), [](const FactResult& fact) { return fact.met; }));
}

CalibrationResult run_calibration(const Calibration& calibration, const CalibrationOptions& options) {
  const CalibrationSearch& search = calibration.search;
  const std::size_t jobs = calibration.readings.size() * search.searches;
  // one suite for each search: two threads must not read the same tree
  std::vector<FactSuite> suites;
  for (std::size_t i = 0; i < jobs; ++i) suites.push_back(load_fact_suite(calibration.facts_file, options.find_scene));
  check_names(calibration, suites.front());
  Tally tally(options, suites.front().book.facts.size(), jobs * (search.global_evaluations + search.local_evaluations));

  CalibrationResult result;
  result.best.resize(jobs);
  std::vector<std::exception_ptr> failures(jobs);
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t job = next++; job < jobs && !tally.ended(); job = next++) {
      try {
        result.best[job] =
            Search(calibration, job / search.searches, 1 + job % search.searches, suites[job], tally).run();
      } catch (...) {
        failures[job] = std::current_exception();
        tally.end();
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < options.threads; ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  if (!tally.ended() || options.go_on == nullptr || options.go_on()) {
    for (const std::exception_ptr& failure : failures)
      if (failure) std::rethrow_exception(failure);
  }
  if (tally.ended()) throw std::runtime_error("interrupted");

  std::stable_sort(result.best.begin(), result.best.end(),
                   [](const CalibratedSet& a, const CalibratedSet& b) { return a.shortfall < b.shortfall; });
  FactRunOptions whole;
  whole.threads = options.threads;
  whole.go_on = options.go_on;
  for (std::size_t i = 0; i < std::min(search.finalists, jobs); ++i) {
    CalibratedSet& set = result.best[i];
    whole.settings = settings_of(calibration, calibration.readings[set.reading], set.values);
    set.results = evaluate_facts(suites.front(), whole);
  }
  std::stable_sort(result.best.begin(),
                   result.best.begin() + static_cast<std::ptrdiff_t>(std::min(search.finalists, jobs)),
                   [](const CalibratedSet& a, const CalibratedSet& b) { return a.met() > b.met(); });
  tally.fill(result);
  result.book = suites.front().book;
  return result;
}

}  // namespace vibratory_alignment
