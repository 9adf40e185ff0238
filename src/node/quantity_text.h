// Quantities in words for people.
#pragma once

#include <string>

namespace vibratory_alignment {

/// "12.3 mm", "4.56 us"; "12.3" without SI units. The u is no mu, for rviz leaves out a text that is not all ASCII.
std::string quantity_text(double value, const char* unit, bool has_unit);

}  // namespace vibratory_alignment
