#include "node/stamps.h"

namespace vibratory_alignment {

ros::Time Stamps::next(const ros::Time& now) {
  const bool back = set_back(now);
  if (back || now > highest_) highest_ = now;
  const ros::Time least = last_ + ros::Duration(0, 1);
  last_ = now < least && !back ? least : now;
  return last_;
}

ros::Time Stamps::one_more() {
  last_ += ros::Duration(0, 1);
  return last_;
}

}  // namespace vibratory_alignment
