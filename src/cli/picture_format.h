// The formats of pictures that `align` draws, by the ending of the file's name.
#pragma once

#include <string>

namespace vibratory_alignment {

/// "png", "svg" or "pdf". Throws UsageError that names `option` and the path for any other ending.
std::string picture_format(const std::string& option, const std::string& path);

}  // namespace vibratory_alignment
