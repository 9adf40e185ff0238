// A line on the terminal that shows how far a run is.
#pragma once

#include <chrono>

namespace vibratory_alignment {

/// Shown on stdout once the run has taken a second, ten times a second, and erased when it goes out of scope.
class ProgressBar {
 public:
  /// `end`: the time at which the run ends at the latest, in the unit of update(). `shown`: false keeps it silent.
  ProgressBar(double end, bool shown);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// The run has come to `time`. Cheap enough to be called at every step.
  void update(double time);

 private:
  using Clock = std::chrono::steady_clock;

  void draw(double time, Clock::time_point now);

  double end_;
  bool shown_;
  bool drawn_ = false;
  Clock::time_point begin_, next_;
};

/// True when stdout is a terminal that can redraw a line.
bool stdout_is_terminal();

}  // namespace vibratory_alignment
