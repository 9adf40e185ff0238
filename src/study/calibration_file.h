// Reads a calibration file (docs/studies.md "Calibration").
#pragma once

#include <string>

#include "study/calibration.h"

namespace vibratory_alignment {

/// Throws SceneError with every fault at once: file, key path, value, what is allowed.
Calibration load_calibration(const std::string& path);

}  // namespace vibratory_alignment
