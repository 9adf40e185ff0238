#include "study/calibration_search.h"

#include <algorithm>
#include <exception>
#include <functional>
#include <limits>
#include <nlopt.hpp>
#include <set>

namespace vibratory_alignment {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// First step of the simplex search, as a share of the ranges.
constexpr double kSimplexStep = 0.1;

/// How much more than the best set of a simplex search another may fall short before it is given up: far more than a
/// simplex of kSimplexStep spans.
constexpr double kSimplexRoom = 2.0;

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

}  // namespace

CalibrationRun::CalibrationRun(const Calibration& calibration, std::size_t reading, std::size_t seed,
                               const FactSuite& suite, CalibrationTally& tally)
    : calibration_(calibration), reading_(calibration.readings[reading]), suite_(suite), tally_(tally) {
  best_.reading = reading;
  best_.seed = seed;
  best_.values = reading_.start;
  for (std::size_t i = 0; i < best_.values.size(); ++i)
    best_shares_.push_back(calibration.parameters[i].share_of(best_.values[i]));
}

void CalibrationRun::search_all_ranges() {
  const CalibrationSearch& search = calibration_.search;
  begin(search.thinning);
  stage(Method::random_search, shortfall_->all(), 1.0, search.population, search.global_evaluations);
}

void CalibrationRun::search_around(const CalibrationRound& round) {
  ++best_.rounds;
  begin(round.thinning);
  for (const CalibrationGroup& group : shortfall_->groups()) {
    const bool shared = group.parts.size() == shortfall_->parts().size();
    stage(Method::random_search, group, round.reach, 1 + kKeptPerValue * group.parameters.size(),
          shared ? round.shared_evaluations : round.own_evaluations);
  }
}

void CalibrationRun::search_nearby() {
  stage(Method::simplex, shortfall_->all(), kSimplexStep, 0, calibration_.search.local_evaluations);
}

/// Judges the best set so far on the studies as they are thinned out from now on.
void CalibrationRun::begin(const Thinning& thinning) {
  shortfall_ = std::make_unique<ShortfallOfSets>(calibration_, reading_, suite_, thinning);
  best_parts_ = ask(best_.values, shortfall_->all(), kInfinity).parts;
  best_.shortfall = shortfall_without({});
}

/// Looks for the least shortfall at no more than `reach` from the best set, with only the values of the group changed,
/// until all facts of the group are met.
void CalibrationRun::stage(Method method, const CalibrationGroup& group, double reach, std::size_t population,
                           std::size_t evaluations) {
  ++stages_;
  const double others = shortfall_without(group);
  const auto nothing_to_gain = [&] { return best_.shortfall <= others; };
  if (evaluations == 0 || group.parameters.empty() || nothing_to_gain()) return;
  const auto dimension = static_cast<unsigned>(group.parameters.size());
  std::vector<double> shares, low, high;
  for (const std::size_t i : group.parameters) {
    shares.push_back(best_shares_[i]);
    low.push_back(method == Method::simplex ? 0.0 : std::max(0.0, best_shares_[i] - reach));
    high.push_back(method == Method::simplex ? 1.0 : std::min(1.0, best_shares_[i] + reach));
  }
  const std::size_t search = best_.reading * calibration_.search.searches + best_.seed;  // from 1 on
  nlopt::srand(search * kStagesPerSearch + stages_);                                     // of this thread
  nlopt::opt optimizer(method == Method::simplex ? nlopt::LN_SBPLX : nlopt::GN_CRS2_LM, dimension);
  if (method == Method::simplex)
    optimizer.set_initial_step(reach);
  else
    optimizer.set_population(static_cast<unsigned>(population));
  optimizer.set_lower_bounds(low);
  optimizer.set_upper_bounds(high);
  optimizer.set_maxeval(static_cast<int>(evaluations));

  Population kept(population);
  std::size_t looked_at = 0;
  std::exception_ptr failure;  // NLopt does not hand on what it does not know
  const std::function<double(const std::vector<double>&)> objective = [&](const std::vector<double>& point) {
    // NLopt itself may look at a few more
    if (!tally_.go_on() || looked_at == evaluations || nothing_to_gain()) throw nlopt::forced_stop();
    ++looked_at;
    const double most = method == Method::simplex ? best_.shortfall + kSimplexRoom : kept.worst();
    try {
      const double shortfall = look_at(group, point, most);
      kept.add(shortfall);
      return shortfall;
    } catch (...) {
      failure = std::current_exception();
      throw nlopt::forced_stop();
    }
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
    if (failure) std::rethrow_exception(failure);
    if (tally_.ended()) throw;
  }
}

/// The shortfall of the best set with the group's values replaced. It becomes the best set if it is better.
double CalibrationRun::look_at(const CalibrationGroup& group, const std::vector<double>& shares, double most) {
  std::vector<double> all_shares = best_shares_;
  for (std::size_t k = 0; k < shares.size(); ++k) all_shares[group.parameters[k]] = shares[k];
  std::vector<double> values;
  for (std::size_t i = 0; i < all_shares.size(); ++i)
    values.push_back(calibration_.parameters[i].value_at(all_shares[i]));
  const double others = shortfall_without(group);
  const CalibrationAnswer answer = ask(values, group, most - others);
  const double shortfall = others + answer.shortfall();
  if (answer.parts.size() < group.parts.size()) return shortfall;

  std::vector<CalibrationAnswer::Part> parts = best_parts_;
  for (std::size_t k = 0; k < group.parts.size(); ++k) parts[group.parts[k]] = answer.parts[k];
  std::size_t met = 0;
  for (const CalibrationAnswer::Part& part : parts) met += part.met;
  tally_.count_whole(shortfall, met);
  if (shortfall < best_.shortfall) {
    best_.shortfall = shortfall;
    best_.values = values;
    best_shares_ = all_shares;
    best_parts_ = parts;
  }
  return shortfall;
}

/// Of the best set, by the facts that the group has nothing to do with.
double CalibrationRun::shortfall_without(const CalibrationGroup& group) const {
  double shortfall = 0.0;
  for (std::size_t part = 0; part < best_parts_.size(); ++part)
    if (!std::binary_search(group.parts.begin(), group.parts.end(), part)) shortfall += best_parts_[part].shortfall;
  return shortfall;
}

CalibrationAnswer CalibrationRun::ask(const std::vector<double>& values, const CalibrationGroup& group, double most) {
  const CalibrationPlace place{best_.reading, best_.seed, number_++};
  std::optional<CalibrationAnswer> answer = tally_.known(place, values);
  if (!answer) {
    answer = (*shortfall_)(values, group, most, [&] { return tally_.go_on(); });
    tally_.keep(place, values, *answer);
  }
  tally_.count(*answer);
  return *answer;
}

}  // namespace vibratory_alignment
