// Numbers of things in messages.
#pragma once

#include <cstddef>
#include <string>

namespace vibratory_alignment {

/// "1 trial", "3 trials".
inline std::string counted(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

}  // namespace vibratory_alignment
