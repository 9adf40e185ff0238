// The numbers of a trial's row under the names that they have in files and formulas.
#pragma once

#include <string>
#include <vector>

#include "study/trial_row.h"

namespace vibratory_alignment {

/// duration, end_time, nonimpact_time, x ... omega; then for every spot a1, a2, b1, b2 impacts, first_impact,
/// last_impact, peak_force, normal_impulse, friction_impulse, impulse_x, impulse_y, contact_time, as impacts_a1 ...
const std::vector<std::string>& row_number_names();

/// They, in the same order and the row's units. Not a number where the row has none.
std::vector<double> row_numbers(const TrialRow& row);

}  // namespace vibratory_alignment
