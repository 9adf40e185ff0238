// A line on the terminal that shows how far a hunt is: rate, failures, time left.
#pragma once

#include <chrono>

namespace vibratory_alignment::hunt {

/// Redrawn on stderr if that is a terminal; silent otherwise.
class ProgressLine {
 public:
  explicit ProgressLine(long count);
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(long done, long failed);
  /// Makes room for other text.
  void clear();
  double seconds() const;

 private:
  using Clock = std::chrono::steady_clock;

  long count_;
  bool shown_;
  bool drawn_ = false;
  Clock::time_point begin_;
};

}  // namespace vibratory_alignment::hunt
