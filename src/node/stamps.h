// Stamps of messages: never 0 and never the same twice, whatever the clock does.
#pragma once

#include <ros/time.h>

namespace vibratory_alignment {

class Stamps {
 public:
  /// A clock that goes back by more than `tolerance` was set back, and is followed; by less, the stamps go on by
  /// nanoseconds until it has caught up. The wall clock is corrected now and then: 1 s. A simulated one never: 0.
  explicit Stamps(ros::Duration tolerance) : tolerance_(tolerance) {}

  /// True: the clock has been set back to `now` since the last stamp.
  bool set_back(const ros::Time& now) const { return !now.isZero() && now + tolerance_ < highest_; }

  /// A stamp for `now`, which may be 0 while there is no clock.
  ros::Time next(const ros::Time& now);

  /// A stamp for the same reading of the clock as the last one.
  ros::Time one_more();

  /// 0 before the first.
  const ros::Time& last() const { return last_; }

 private:
  ros::Duration tolerance_;
  ros::Time last_;
  ros::Time highest_;  ///< reading of the clock since it was set back
};

}  // namespace vibratory_alignment
