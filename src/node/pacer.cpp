#include "node/pacer.h"

#include <algorithm>

namespace vibratory_alignment {
namespace {

using Seconds = std::chrono::duration<double>;

/// Longer waits are cut to this, so that they fit the clock.
constexpr Seconds kLongestWait(1e8);

}  // namespace

void Pacer::start(double time_scale, Clock::time_point now, double simulated) {
  time_scale_ = time_scale;
  wall_start_ = now;
  simulated_start_ = simulated;
}

double Pacer::simulated(Clock::time_point now) const {
  return simulated_start_ + time_scale_ * Seconds(now - wall_start_).count();
}

Pacer::Clock::time_point Pacer::due(double simulated) const {
  if (time_scale_ == 0.0) return wall_start_;
  const Seconds wait((simulated - simulated_start_) / time_scale_);
  return wall_start_ + std::chrono::duration_cast<Clock::duration>(std::min(wait, kLongestWait));
}

}  // namespace vibratory_alignment
