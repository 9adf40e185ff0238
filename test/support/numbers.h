// Numbers that many tests need.
#pragma once

#include <limits>

namespace vibratory_alignment::test {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kEps = std::numeric_limits<double>::epsilon();

}  // namespace vibratory_alignment::test
