#include "rviz_panel/history.h"

#include <algorithm>

namespace vibratory_alignment {
namespace {

HistoryPoint merged(const HistoryPoint& earlier, const HistoryPoint& later) {
  HistoryPoint point = later;
  point.force_a1 = std::max(earlier.force_a1, later.force_a1);
  point.force_a2 = std::max(earlier.force_a2, later.force_a2);
  return point;
}

}  // namespace

void History::clear() {
  points_.clear();
  stride_ = in_last_ = 1;
}

void History::add(const HistoryPoint& point) {
  if (!points_.empty() && point.time <= points_.back().time) clear();
  if (!points_.empty() && in_last_ < stride_) {
    points_.back() = merged(points_.back(), point);
    ++in_last_;
    return;
  }
  if (points_.size() == capacity_) {
    for (std::size_t i = 0; i < capacity_ / 2; ++i) points_[i] = merged(points_[2 * i], points_[2 * i + 1]);
    points_.resize(capacity_ / 2);
    stride_ *= 2;
  }
  points_.push_back(point);
  in_last_ = 1;
}

}  // namespace vibratory_alignment
