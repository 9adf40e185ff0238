// Numbers as text for files that programs read.
#pragma once

#include <string>

namespace vibratory_alignment {

/// The fewest digits, 15 to 17, that read back as the same double.
std::string number_text(double value);

}  // namespace vibratory_alignment
