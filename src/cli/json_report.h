// The result of a trial for programs: one JSON object.
#pragma once

#include <string>

#include "model/scene.h"
#include "trial/outcome.h"

namespace vibratory_alignment {

/// The keys of docs/command_line.md, in the scene's own units; doubles with as many digits as give back the same value.
/// `cpu_seconds` is the only value that differs between two runs of the same scene.
std::string json_report(const TrialResult& result, const Scene& scene);

}  // namespace vibratory_alignment
