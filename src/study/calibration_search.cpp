#include "study/calibration_search.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <numeric>
#include <utility>

namespace vibratory_alignment {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr nlopt::algorithm kRandomSearch = nlopt::GN_CRS2_LM, kSimplex = nlopt::LN_SBPLX,
                           kQuadraticModel = nlopt::LN_BOBYQA;

/// First step of the simplex search, as a share of the ranges.
constexpr double kSimplexStep = 0.1;

/// How much more than the best set of a simplex search another may fall short before it is given up: far more than a
/// simplex of kSimplexStep spans.
constexpr double kSimplexRoom = 2.0;

/// First step of the quadratic model, as a share of the ranges: it has room for its points to both sides of the start.
constexpr double kMostInitialStep = 0.5;

/// The sets that a random search keeps, for each value that it searches for. CRS2 asks for one more than the values at
/// least; NLopt's own ten times as many would take all of a round to fill.
constexpr std::size_t kKeptPerValue = 3;

/// Seeds of the stages of a search are this much apart from those of the next.
constexpr unsigned long kStagesPerSearch = 1000;

/// The least shortfalls of a stage, as many as its population.
class Population {
 public:
  explicit Population(std::size_t size) : size_(size) {}
  void add(double shortfall) {
    least_.insert(shortfall);
    if (least_.size() > size_) least_.erase(std::prev(least_.end()));
  }
  /// CRS2 keeps the best sets so far, as many as its population; one that is worse changes nothing.
  double worst() const { return least_.size() < size_ ? kInfinity : *least_.rbegin(); }

 private:
  std::size_t size_;
  std::multiset<double> least_;
};

std::vector<double> at(const std::vector<std::size_t>& places, const std::vector<double>& all) {
  std::vector<double> some;
  for (const std::size_t place : places) some.push_back(all[place]);
  return some;
}

}  // namespace

CalibrationRun::CalibrationRun(const Calibration& calibration, std::size_t reading, std::size_t seed,
                               const FactSuite& suite, CalibrationTally& tally)
    : calibration_(calibration),
      reading_(calibration.readings[reading]),
      suite_(suite),
      tally_(tally),
      reading_number_(reading),
      seed_(seed) {
  for (std::size_t i = 0; i < reading_.start.size(); ++i)
    best_.shares.push_back(calibration.parameters[i].share_of(reading_.start[i]));
}

CalibratedSet CalibrationRun::best() const {
  CalibratedSet set;
  set.reading = reading_number_;
  set.seed = seed_;
  set.rounds = rounds_;
  set.values = values_of(best_.shares);
  set.shortfall = best_.shortfall;
  return set;
}

void CalibrationRun::search_all_ranges() {
  const CalibrationSearch& search = calibration_.search;
  begin(search.thinning);
  seed();
  improve(best_, shortfall_->all(), {kRandomSearch, 1.0, search.population, search.global_evaluations});
}

void CalibrationRun::search_around(const CalibrationRound& round) {
  ++rounds_;
  begin(round.thinning);
  for (const CalibrationGroup& group : shortfall_->groups()) {
    seed();
    if (is_shared(group) && round.adaptation)
      search_adapting(group, round);
    else
      improve(best_, group,
              {kRandomSearch, round.reach, 1 + kKeptPerValue * group.parameters.size(),
               is_shared(group) ? round.shared_evaluations : round.own_evaluations});
  }
}

void CalibrationRun::search_nearby() {
  seed();
  improve(best_, shortfall_->all(), {kSimplex, kSimplexStep, 0, calibration_.search.local_evaluations});
}

/// Judges the best set so far on the studies as they are thinned out from now on.
void CalibrationRun::begin(const Thinning& thinning) {
  shortfall_ = std::make_unique<ShortfallOfSets>(calibration_, reading_, suite_, thinning);
  best_.parts.assign(shortfall_->parts().size(), std::nullopt);
  best_.shortfall = kInfinity;
  look_at(best_, {{}, shortfall_->all().parts}, {}, kInfinity);
}

/// Each stage has random numbers of its own.
void CalibrationRun::seed() {
  const std::size_t search = reading_number_ * calibration_.search.searches + seed_;  // from 1 on
  nlopt::srand(search * kStagesPerSearch + ++stages_);                                // of this thread
}

/// Looks for the least shortfall near the set with only the values of the group changed, until all facts of the group
/// are met. The set becomes the best that is found.
void CalibrationRun::improve(JudgedSet& set, const CalibrationGroup& group, const Stage& stage) {
  const double others = set.shortfall_without(group);
  minimize(
      stage, at(group.parameters, set.shares), [&] { return set.shortfall <= others; },
      [&](const std::vector<double>& point, double most) {
        return look_at(set, group, point, stage.method == kSimplex ? set.shortfall + kSimplexRoom : most);
      });
}

/// Looks for values of all studies that are better once the values of each group of studies are adapted to them. A
/// candidate costs as much as many sets, so that they are chosen by a model of what was found.
void CalibrationRun::search_adapting(const CalibrationGroup& shared, const CalibrationRound& round) {
  // first the facts without values of their own, then the groups of those that have some, cheap ones first
  CalibrationGroup rest{{}, shortfall_->all().parts};
  std::vector<CalibrationGroup> groups;
  for (CalibrationGroup& group : shortfall_->groups()) {
    if (is_shared(group)) continue;
    for (const std::size_t part : group.parts)
      rest.parts.erase(std::remove(rest.parts.begin(), rest.parts.end(), part), rest.parts.end());
    groups.push_back(std::move(group));
  }
  const auto trials = [&](const CalibrationGroup& group) {
    return std::accumulate(group.parts.begin(), group.parts.end(), std::size_t{0},
                           [&](std::size_t sum, std::size_t part) { return sum + shortfall_->parts()[part].trials; });
  };
  std::stable_sort(groups.begin(), groups.end(),
                   [&](const CalibrationGroup& a, const CalibrationGroup& b) { return trials(a) < trials(b); });
  if (!rest.parts.empty()) groups.insert(groups.begin(), std::move(rest));

  minimize(
      {kQuadraticModel, round.reach, 0, round.shared_evaluations}, at(shared.parameters, best_.shares),
      [&] { return best_.shortfall <= 0.0; },
      [&](const std::vector<double>& point, double) {
        return look_at_adapted(shared, point, groups, *round.adaptation);
      });
}

/// The least shortfall that is found with these values of all studies and those of each group adapted to them; becomes
/// the best set if it is better. Given up when it cannot be, or when it falls short of the best set by more than the
/// room, on the groups so far; then the others are taken to be as in the best set.
double CalibrationRun::look_at_adapted(const CalibrationGroup& shared, const std::vector<double>& point,
                                       const std::vector<CalibrationGroup>& groups,
                                       const CalibrationAdaptation& adaptation) {
  JudgedSet candidate;
  candidate.shares = best_.shares;
  for (std::size_t k = 0; k < point.size(); ++k) candidate.shares[shared.parameters[k]] = point[k];
  candidate.parts.resize(best_.parts.size());
  double rest = best_.shortfall;  // of the best set, by the groups to come
  for (const CalibrationGroup& group : groups) {
    rest -= best_.shortfall - best_.shortfall_without(group);
    candidate.shortfall = kInfinity;  // with this group, of which nothing is known
    if (group.parameters.empty())
      look_at(candidate, group, {}, kInfinity);
    else
      improve(candidate, group,
              {kRandomSearch, adaptation.reach, 1 + kKeptPerValue * group.parameters.size(), adaptation.evaluations});
    const double as_good_as_best = best_.shortfall - rest;
    if (candidate.shortfall >= best_.shortfall || candidate.shortfall > as_good_as_best + adaptation.room)
      return candidate.shortfall + rest;
  }
  best_ = candidate;
  return candidate.shortfall;
}

/// Looks for the least of an objective, within the reach of `start`.
void CalibrationRun::minimize(const Stage& stage, const std::vector<double>& start,
                              const std::function<bool()>& nothing_to_gain, const Objective& objective) {
  if (stage.evaluations == 0 || start.empty() || nothing_to_gain()) return;
  const bool random = stage.method == kRandomSearch;
  std::vector<double> low, high;
  for (const double share : start) {
    low.push_back(random ? std::max(0.0, share - stage.reach) : 0.0);
    high.push_back(random ? std::min(1.0, share + stage.reach) : 1.0);
  }
  nlopt::opt optimizer(stage.method, static_cast<unsigned>(start.size()));
  if (random)
    optimizer.set_population(static_cast<unsigned>(stage.population));
  else
    optimizer.set_initial_step(std::min(stage.reach, kMostInitialStep));
  optimizer.set_lower_bounds(low);
  optimizer.set_upper_bounds(high);
  optimizer.set_maxeval(static_cast<int>(stage.evaluations));

  Population kept(stage.population);
  std::size_t looked_at = 0;
  std::exception_ptr failure;  // NLopt does not hand on what it does not know
  using Function = std::function<double(const std::vector<double>&)>;
  const Function function = [&](const std::vector<double>& point) {
    // NLopt itself may look at a few more
    if (!tally_.go_on() || looked_at == stage.evaluations || nothing_to_gain()) throw nlopt::forced_stop();
    ++looked_at;
    try {
      const double value = objective(point, random ? kept.worst() : kInfinity);
      kept.add(value);
      return value;
    } catch (...) {
      failure = std::current_exception();
      throw nlopt::forced_stop();
    }
  };
  optimizer.set_min_objective([](const std::vector<double>& point, std::vector<double>&,
                                 void* data) { return (*static_cast<const Function*>(data))(point); },
                              const_cast<Function*>(&function));
  std::vector<double> point = start;
  double least = 0.0;
  try {
    optimizer.optimize(point, least);
  } catch (const nlopt::roundoff_limited&) {
    // as near as it gets
  } catch (const nlopt::forced_stop&) {
    if (failure) std::rethrow_exception(failure);
    if (tally_.ended()) throw;
  }
}

/// The shortfall of the set with the group's values replaced. The set becomes that if it is better.
double CalibrationRun::look_at(JudgedSet& set, const CalibrationGroup& group, const std::vector<double>& point,
                               double most) {
  JudgedSet changed = set;
  for (std::size_t k = 0; k < point.size(); ++k) changed.shares[group.parameters[k]] = point[k];
  const double others = set.shortfall_without(group);
  const CalibrationAnswer answer = ask(values_of(changed.shares), group, most - others);
  changed.shortfall = others + answer.shortfall();
  if (answer.parts.size() < group.parts.size()) return changed.shortfall;

  for (std::size_t k = 0; k < group.parts.size(); ++k) changed.parts[group.parts[k]] = answer.parts[k];
  if (std::all_of(changed.parts.begin(), changed.parts.end(), [](const auto& part) { return part.has_value(); }))
    tally_.count_whole(changed.shortfall,
                       std::accumulate(changed.parts.begin(), changed.parts.end(), std::size_t{0},
                                       [](std::size_t sum, const auto& part) { return sum + part->met; }));
  if (changed.shortfall < set.shortfall) set = changed;
  return changed.shortfall;
}

/// By the facts that the group has nothing to do with.
double CalibrationRun::JudgedSet::shortfall_without(const CalibrationGroup& group) const {
  double sum = 0.0;
  for (std::size_t part = 0; part < parts.size(); ++part)
    if (parts[part] && !std::binary_search(group.parts.begin(), group.parts.end(), part)) sum += parts[part]->shortfall;
  return sum;
}

bool CalibrationRun::is_shared(const CalibrationGroup& group) const {
  return group.parts.size() == shortfall_->parts().size();
}

std::vector<double> CalibrationRun::values_of(const std::vector<double>& shares) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < shares.size(); ++i) values.push_back(calibration_.parameters[i].value_at(shares[i]));
  return values;
}

CalibrationAnswer CalibrationRun::ask(const std::vector<double>& values, const CalibrationGroup& group, double most) {
  const CalibrationPlace place{reading_number_, seed_, number_++};
  std::optional<CalibrationAnswer> answer = tally_.known(place, values);
  if (!answer) {
    answer = (*shortfall_)(values, group, most, [&] { return tally_.go_on(); });
    tally_.keep(place, values, *answer);
  }
  tally_.count(*answer);
  return *answer;
}

}  // namespace vibratory_alignment
