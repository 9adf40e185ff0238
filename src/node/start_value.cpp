#include "node/start_value.h"

#include <utility>

namespace vibratory_alignment {

StartValue::StartValue(const ros::NodeHandle& private_handle, std::string name)
    : handle_(private_handle), name_(std::move(name)) {
  handle_.getParam(name_, value_);
}

void StartValue::restore() {
  if (!std::exchange(overwritten_, false)) return;
  if (value_.valid()) {
    handle_.setParam(name_, value_);
  } else {
    handle_.deleteParam(name_);
  }
}

}  // namespace vibratory_alignment
