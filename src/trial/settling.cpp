#include "trial/settling.h"

#include <algorithm>
#include <cmath>

#include "mechanics/drive.h"

namespace vibratory_alignment {
namespace {

constexpr double kTwoPi = 6.283185307179586477;
constexpr double kLargestDifference = 1e-9;
constexpr double kDriftShare = 0.01;

/// Differences this small are the last digits of the states.
constexpr double kRoundoff = 1e-13;

/// Periods of the slowest excitation that may make up a common period of several.
constexpr int kMostMultiples = 1000;

/// Instants that are looked at in one segment. Without excitation one may last until the time limit.
constexpr int kMostInstants = 1024;

/// Beyond so many periods a double does not tell instants apart.
constexpr double kMostPeriods = 1e15;

double final_frequency(const Excitation& e) { return e.waveform == Waveform::chirp ? e.end_frequency : e.frequency; }

}  // namespace

double common_period(const std::vector<Excitation>& excitations) {
  double slowest = 0.0;
  for (const Excitation& e : excitations)
    if (e.amplitude != 0.0 && (slowest == 0.0 || final_frequency(e) < slowest)) slowest = final_frequency(e);
  if (slowest == 0.0) return kTwoPi / 16.0;
  for (int multiple = 1; multiple <= kMostMultiples; ++multiple) {
    const bool fits = std::all_of(excitations.begin(), excitations.end(), [&](const Excitation& e) {
      if (e.amplitude == 0.0) return true;
      const double turns = multiple * final_frequency(e) / slowest;
      return std::abs(turns - std::nearbyint(turns)) <= 1e-12 * turns;
    });
    if (fits) return multiple * kTwoPi / slowest;
  }
  return 0.0;
}

double slowest_period(const std::vector<Excitation>& excitations) {
  double slowest = 0.0;
  for (const Excitation& e : excitations) {
    if (e.amplitude == 0.0) continue;
    const double frequency = e.waveform == Waveform::chirp ? std::min(e.frequency, e.end_frequency) : e.frequency;
    slowest = std::max(slowest, kTwoPi / frequency);
  }
  return slowest > 0.0 ? slowest : kTwoPi;
}

SettlingWatch::SettlingWatch(const std::vector<Excitation>& excitations, double time_limit) : time_limit_(time_limit) {
  restart(excitations, 0.0);
}

void SettlingWatch::restart(const std::vector<Excitation>& excitations, double now) {
  period_ = common_period(excitations);
  begin_ = now;
  seen_ = seen_before_ = {};
  replaced_count_ = 0;
  rate_ = 1.0;
  sweep_ends_.resize(excitations.size());
  for (std::size_t i = 0; i < excitations.size(); ++i) {
    const Excitation& e = excitations[i];
    const bool goes_on = i < excitations_.size() && same_sweep(e, excitations_[i]);
    if (!goes_on) sweep_ends_[i] = e.waveform == Waveform::chirp ? now + e.sweep_time : 0.0;
    if (e.amplitude == 0.0) continue;
    rate_ = std::max(rate_, final_frequency(e));
    begin_ = std::max(begin_, sweep_ends_[i]);
  }
  excitations_ = excitations;
}

std::optional<double> SettlingWatch::book(const Segment& segment) {
  seen_before_ = seen_;
  replaced_count_ = 0;
  if (period_ == 0.0 || seen_.settled) return {};
  const auto local = [&] { return (begin_ + static_cast<double>(seen_.next) * period_) - segment.start; };
  for (int i = 0; i < kMostInstants; ++i, ++seen_.next) {
    // rounding may put one just before the segment that is not in that before either
    const double t = std::max(local(), 0.0);
    if (t > segment.duration) return {};
    see(state_at(segment, t));
    if (seen_.settled) return t;
  }
  // the others of a very long one are left out
  const double passed = (segment.end_time() - begin_) / period_;
  if (passed < kMostPeriods)
    seen_.from = seen_.next = std::max(seen_.next, static_cast<long>(passed) + 1);
  else
    period_ = 0.0;
  return {};
}

void SettlingWatch::take_back() {
  for (long i = 0; i < replaced_count_; ++i) state_of(seen_before_.next + i) = replaced_[static_cast<std::size_t>(i)];
  replaced_count_ = 0;
  seen_ = seen_before_;
}

/// Keeps the state at the next instant and compares it with those before.
void SettlingWatch::see(const State& state) {
  State& kept = state_of(seen_.next);
  if (replaced_count_ < kHistory) replaced_[static_cast<std::size_t>(replaced_count_++)] = kept;
  kept = state;
  compare();
}

std::array<double, 3> SettlingWatch::differences(const State& a, const State& b) const {
  return {std::max(std::abs(a.x - b.x), std::abs(a.vx - b.vx) / rate_),
          std::max(std::abs(a.y - b.y), std::abs(a.vy - b.vy) / rate_),
          std::max(std::abs(a.phi - b.phi), std::abs(a.omega - b.omega) / rate_)};
}

void SettlingWatch::compare() {
  const long last = seen_.next;
  if (last - seen_.from + 1 < kHistory) return;
  const double periods_left = std::max(1.0, (time_limit_ - begin_) / period_ - static_cast<double>(last + 1));
  const double allowed = std::max(std::min(kLargestDifference, kDriftShare / (periods_left * periods_left)), kRoundoff);
  for (int subharmonic = 1; subharmonic <= kSubharmonics && !seen_.settled; ++subharmonic) {
    std::array<double, 3> older{}, newer{};
    bool is_small = true;
    // most motions differ at the first instant
    for (int i = 0; i < kInstants && is_small; ++i) {
      const std::array<double, 3> d = differences(state_of(last - i), state_of(last - i - subharmonic));
      std::array<double, 3>& half = i < kInstants / 2 ? newer : older;
      for (std::size_t axis = 0; axis < d.size(); ++axis) {
        half[axis] = std::max(half[axis], d[axis]);
        is_small = is_small && d[axis] <= allowed;
      }
    }
    bool grows = false;
    for (std::size_t axis = 0; axis < newer.size(); ++axis)
      grows = grows || newer[axis] > std::max(older[axis], kRoundoff);
    seen_.settled = is_small && !grows;
  }
}

}  // namespace vibratory_alignment
