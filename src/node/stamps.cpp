#include "node/stamps.h"

namespace vibratory_alignment {

ros::Time Stamps::next(const ros::Time& now) {
  const bool set_back = !now.isZero() && now + tolerance_ < highest_;
  if (set_back || now > highest_) highest_ = now;
  const ros::Time least = last_ + ros::Duration(0, 1);
  last_ = now < least && !set_back ? least : now;
  return last_;
}

}  // namespace vibratory_alignment
