// Changes of the excitations that are asked for at a segment's end: kept until the motion goes on from there, as the
// segment may be cut before that, where they then enter instead.
#pragma once

#include <cstddef>
#include <vector>

#include "model/scene.h"

namespace vibratory_alignment {

class AskedChanges {
 public:
  /// Takes memory only where more are kept than ever before.
  void add(const std::vector<Excitation>& excitations) {
    if (count_ == changes_.size()) changes_.emplace_back();
    changes_[count_++] = excitations;
  }

  void clear() { count_ = 0; }

  /// Calls `change` with the excitations of each, in the order in which they were asked for.
  template <class Change>
  void for_each(const Change& change) const {
    for (std::size_t i = 0; i < count_; ++i) change(changes_[i]);
  }

 private:
  std::vector<std::vector<Excitation>> changes_;
  std::size_t count_ = 0;
};

}  // namespace vibratory_alignment
