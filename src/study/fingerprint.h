// A short text that tells studies apart, so that results of one are not mixed with those of another.
#pragma once

#include <string>

#include "study/study.h"

namespace vibratory_alignment {

/// The same for studies whose trials all have the same values in the same order; of everything that a trial depends on
/// (the scene with its settings, what is varied, the samples) and `version`, that of this package. Comments and the
/// names of files do not matter.
std::string fingerprint(const Study& study, const std::string& version);

/// The same for the same text.
std::string fingerprint(const std::string& text);

}  // namespace vibratory_alignment
