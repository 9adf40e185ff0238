// A line on the terminal that shows how far a run is.
#pragma once

#include <chrono>
#include <functional>
#include <string>

namespace vibratory_alignment {

/// Shown on stdout once the run has taken a second, ten times a second, and erased when it goes out of scope.
class ProgressBar {
 public:
  /// `shown`: false keeps it silent.
  explicit ProgressBar(bool shown);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// The run has come to `share` (0 to 1) of its way; `describe` is asked for the words behind the bar when it is
  /// drawn. Cheap enough to be called at every step.
  void update(double share, const std::function<std::string()>& describe);

  /// Since it was made.
  double seconds() const;

 private:
  using Clock = std::chrono::steady_clock;

  void draw(double share, const std::string& words);

  bool shown_;
  bool drawn_ = false;
  Clock::time_point begin_, next_;
};

/// True when stdout is a terminal that can redraw a line.
bool stdout_is_terminal();

}  // namespace vibratory_alignment
