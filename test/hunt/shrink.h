// Makes a trial that shows a fault as simple as it can be while the fault is still there.
#pragma once

#include <functional>

#include "changes.h"

namespace vibratory_alignment::hunt {

/// Takes changes and effects out, shortens the trial and rounds numbers, one at a time, and keeps what `still_fails`
/// agrees to; asks it at most `trials` times.
Trial shrink(Trial trial, const std::function<bool(const Trial&)>& still_fails, int trials);

}  // namespace vibratory_alignment::hunt
