// When simulated instants are due on the wall clock: simulated time advances at time_scale x wall time.
#pragma once

#include <chrono>

namespace vibratory_alignment {

class Pacer {
 public:
  using Clock = std::chrono::steady_clock;

  /// From `now` on, which is the simulated instant `simulated` [s], time advances by `time_scale` >= 0 [s/s];
  /// 0: as fast as possible.
  void start(double time_scale, Clock::time_point now, double simulated);

  double time_scale() const { return time_scale_; }

  /// Simulated instant that belongs to `now` [s]; stays at the start while the time scale is 0.
  double simulated(Clock::time_point now) const;

  /// When the simulated instant [s] is due; with the time scale 0: at the start.
  Clock::time_point due(double simulated) const;

 private:
  double time_scale_ = 1.0;
  Clock::time_point wall_start_{};
  double simulated_start_ = 0.0;
};

}  // namespace vibratory_alignment
