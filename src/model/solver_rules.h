// What a scene accepts as the numbers of its solver, and the options of `align trial` with it.
#pragma once

#include "model/solver_choice.h"
#include "model/tree_reader.h"

namespace vibratory_alignment {

inline const NumberRule tolerance_rule = {"a number > 0 and <= 0.1", 0.0, 0.1, false, false};
inline const NumberRule accuracy_rule = {"a number from 1e-9 to 0.1", kFinestAccuracy, kCoarsestAccuracy, true, false};

}  // namespace vibratory_alignment
