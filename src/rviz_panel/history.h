// The run of a trial as the plot shows it: misalignment and reactions over time, in as many points as a screen can
// show.
#pragma once

#include <cstddef>
#include <vector>

namespace vibratory_alignment {

struct HistoryPoint {
  double time = 0.0, misalignment = 0.0;
  double force_a1 = 0.0, force_a2 = 0.0;  ///< the largest since the point before
};

/// When there are too many points, each two neighbours become one with the larger forces: no peak is lost.
class History {
 public:
  /// `capacity` >= 2, even.
  explicit History(std::size_t capacity = 2000) : capacity_(capacity) {}

  /// A time that is not after that of the last point begins a new run.
  void add(const HistoryPoint& point);

  void clear();

  const std::vector<HistoryPoint>& points() const { return points_; }

 private:
  std::size_t capacity_, stride_ = 1, in_last_ = 1;  ///< how many added points a point is made of; so far, the last
  std::vector<HistoryPoint> points_;
};

}  // namespace vibratory_alignment
