// Runs the trials of a study, several at a time.
#pragma once

#include <cstddef>
#include <functional>

#include "study/study.h"
#include "study/trial_row.h"

namespace vibratory_alignment {

struct SweepOptions {
  int threads = 1;
  std::size_t first = 0, stride = 1;  ///< the trials first, first + stride, ... of the study
  /// Asked some twenty times a second, in the calling thread; false ends the sweep, trials under way included.
  std::function<bool()> go_on;
};

/// Hands the row of every trial to `sink`, in the calling thread and in the order of their indices, whatever the
/// threads. A trial whose scene is refused and one that fails are rows as well. Memory does not grow with the study.
/// Returns false when `go_on` ended it. Rethrows what a trial (out of memory) or `sink` throws.
bool run_sweep(const Study& study, const SweepOptions& options, const std::function<void(const TrialRow&)>& sink);

}  // namespace vibratory_alignment
