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

/// Periods of the first excitation that may make up a common period of several.
constexpr int kMostMultiples = 64;

double final_frequency(const Excitation& e) { return e.waveform == Waveform::chirp ? e.end_frequency : e.frequency; }

}  // namespace

double common_period(const std::vector<Excitation>& excitations) {
  double first = 0.0;
  for (const Excitation& e : excitations)
    if (e.amplitude != 0.0 && first == 0.0) first = final_frequency(e);
  if (first == 0.0) return kTwoPi / 16.0;
  for (int multiple = 1; multiple <= kMostMultiples; ++multiple) {
    const bool fits = std::all_of(excitations.begin(), excitations.end(), [&](const Excitation& e) {
      if (e.amplitude == 0.0) return true;
      const double turns = multiple * final_frequency(e) / first;
      return std::abs(turns - std::nearbyint(turns)) <= 1e-12 * turns && turns > 0.5;
    });
    if (fits) return multiple * kTwoPi / first;
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
  next_ = 0;
  settled_ = false;
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

void SettlingWatch::book(const Segment& segment) {
  if (period_ == 0.0 || settled_) return;
  for (;;) {
    const double local = (begin_ + static_cast<double>(next_) * period_) - segment.start;
    if (local > segment.duration) return;
    if (local >= 0.0) {
      history_[static_cast<std::size_t>(next_ % kHistory)] = state_at(segment, local);
      ++next_;
      compare();
      if (settled_) return;
    } else {
      ++next_;
    }
  }
}

double SettlingWatch::difference(const State& a, const State& b) const {
  const double position = std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.phi - b.phi)});
  const double velocity = std::max({std::abs(a.vx - b.vx), std::abs(a.vy - b.vy), std::abs(a.omega - b.omega)});
  return std::max(position, velocity / rate_);
}

void SettlingWatch::compare() {
  if (next_ < kHistory) return;
  const auto at = [this](long index) -> const State& { return history_[static_cast<std::size_t>(index % kHistory)]; };
  const double periods_left = std::max(1.0, (time_limit_ - begin_) / period_ - static_cast<double>(next_));
  const double allowed = std::max(std::min(kLargestDifference, kDriftShare / (periods_left * periods_left)), kRoundoff);
  for (int subharmonic = 1; subharmonic <= kSubharmonics && !settled_; ++subharmonic) {
    // most motions differ at the first instant
    double older = 0.0, newer = 0.0;
    for (int i = 0; i < kInstants && std::max(older, newer) <= allowed; ++i) {
      const long index = next_ - 1 - i;
      double& half = i < kInstants / 2 ? newer : older;
      half = std::max(half, difference(at(index), at(index - subharmonic)));
    }
    const bool shrinks = newer <= older || newer <= kRoundoff;
    settled_ = std::max(older, newer) <= allowed && shrinks;
  }
}

}  // namespace vibratory_alignment
