// Stamps of messages: never 0 and never the same twice, whatever the clock does.
#pragma once

#include <ros/time.h>

namespace vibratory_alignment {

class Stamps {
 public:
  /// A clock that goes back by more than `tolerance` was set back, and is followed; by less, the stamps go on by
  /// nanoseconds until it has caught up. The wall clock is corrected now and then: 1 s. A simulated one never: 0.
  explicit Stamps(ros::Duration tolerance) : tolerance_(tolerance) {}

  /// A stamp for `now`, which may be 0 while there is no clock.
  ros::Time next(const ros::Time& now);

  /// 0 before the first.
  const ros::Time& last() const { return last_; }

 private:
  ros::Duration tolerance_;
  ros::Time last_;
  ros::Time highest_;  ///< reading of the clock since it was set back
};

}  // namespace vibratory_alignment
