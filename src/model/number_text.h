// Numbers as text for files that programs read.
#pragma once

#include <string>

namespace vibratory_alignment {

/// The fewest digits, 15 to 17, that read back as the same double.
std::string number_text(double value);

/// To so many significant digits, 1 to 17, as its text has them: 0.15, and not 0.15000000000000002.
double rounded(double value, int digits);

}  // namespace vibratory_alignment
