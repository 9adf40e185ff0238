#include "cli/sweep_summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "study/metrics.h"

namespace vibratory_alignment {
namespace {

constexpr std::size_t kMostDurations = 100'000;
constexpr double kClass = 1e-4;

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

}  // namespace

void SweepSummary::add(std::size_t trial, const std::string& outcome, double duration, const std::string& reason) {
  ++trials_;
  Outcomes& outcomes = outcomes_[outcome];
  if (outcomes.count++ == 0) {
    outcomes.first_trial = trial;
    outcomes.first_reason = reason;
  }
  if (std::isnan(duration)) return;
  ++aligned_;
  least_ = std::min(least_, duration);
  greatest_ = std::max(greatest_, duration);
  if (classes_.empty() && durations_.size() < kMostDurations) {
    durations_.push_back(duration);
    return;
  }
  for (const double earlier : durations_) count(earlier);
  durations_.clear();
  count(duration);
}

void SweepSummary::count(double duration) {
  ++classes_[std::lround(std::floor(std::log(std::max(duration, 1e-300)) / kClass))];
}

std::string SweepSummary::share_of_all(std::size_t count, const char* pattern) const {
  return format(pattern, 100.0 * static_cast<double>(count) / static_cast<double>(trials_));
}

std::string SweepSummary::short_text() const {
  std::vector<std::pair<std::size_t, std::string>> sorted;
  for (const auto& [outcome, outcomes] : outcomes_) sorted.emplace_back(outcomes.count, outcome);
  std::sort(sorted.rbegin(), sorted.rend());
  std::string text;
  for (const auto& [count, outcome] : sorted)
    text += (text.empty() ? "" : ", ") + outcome + share_of_all(count, " %.3g %%");
  return text;
}

std::string SweepSummary::text() const {
  std::string text;
  for (const auto& [outcome, outcomes] : outcomes_) {
    text += format("%-12s %12zu", outcome.c_str(), outcomes.count) + share_of_all(outcomes.count, " %7.2f %%\n");
    if (!outcomes.first_reason.empty())
      text += format("%-12s first: trial %zu: ", "", outcomes.first_trial) + outcomes.first_reason + "\n";
  }
  if (aligned_ > 0) {
    text += format("duration     least %.4g, quartiles ", least_) + quartile(0.25) + ", " + quartile(0.5) + ", " +
            quartile(0.75) + format(", greatest %.4g\n", greatest_);
  }
  return text;
}

std::string SweepSummary::quartile(double share) const {
  // a class is too wide for a fourth digit
  return classes_.empty() ? format("%.4g", quantile(durations_, share)) : format("%.3g", quantile_of_classes(share));
}

/// The middle of the class that the duration lies in below which there is this share of all.
double SweepSummary::quantile_of_classes(double share) const {
  const double wanted = share * static_cast<double>(aligned_);
  double passed = 0.0;
  for (const auto& [number, size] : classes_) {
    passed += static_cast<double>(size);
    if (passed >= wanted) return std::clamp(std::exp((static_cast<double>(number) + 0.5) * kClass), least_, greatest_);
  }
  return greatest_;
}

}  // namespace vibratory_alignment
