// The result of a trial for people.
#pragma once

#include <string>

#include "model/scene.h"
#include "trial/outcome.h"

namespace vibratory_alignment {

/// Several lines, the outcome first. SI values in ms, mm, mm/s, N; a dimensionless scene with `scales` shows both.
std::string summary(const TrialResult& result, const Scene& scene);

}  // namespace vibratory_alignment
