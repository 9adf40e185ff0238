// Where an axis has its marks.
#pragma once

#include <vector>

namespace vibratory_alignment {

/// Multiples of 1, 2 or 5 times a power of ten from `low` to `high`, with at most `count` >= 2
/// spaces between them; none for an empty range.
std::vector<double> ticks(double low, double high, int count);

}  // namespace vibratory_alignment
