// How fast simulated time really advances: what is reported of each period.
#pragma once

#include <chrono>

namespace vibratory_alignment {

/// What happened since the report before. Wall times [s].
struct PaceReport {
  double running = 0.0;    ///< wall time during which the trial ran
  double simulated = 0.0;  ///< simulated time in it [s]
  long samples = 0;        ///< published in it
  double dropped = 0.0;    ///< wall time that the trial lags behind for good, because the pace began anew

  /// Simulated per wall time while it ran; 0 if it did not.
  double real_time_factor() const { return running > 0.0 ? simulated / running : 0.0; }
  double rate() const { return running > 0.0 ? static_cast<double>(samples) / running : 0.0; }
};

class PaceMeter {
 public:
  using Clock = std::chrono::steady_clock;

  /// The trial runs or does not, from `now` on; the same again changes nothing.
  void set_running(bool running, Clock::time_point now);

  /// A sample was published, `simulated` [s] after the one before.
  void add_sample(double simulated);

  /// The pace began anew, `lag` [s] of wall time late.
  void add_dropped(double lag) { report_.dropped += lag; }

  /// Ends the period.
  PaceReport take(Clock::time_point now);

 private:
  PaceReport report_;
  bool running_ = false;
  Clock::time_point since_{};
};

}  // namespace vibratory_alignment
