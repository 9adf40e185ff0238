// Random changes for every seed: of all kinds, at any instant, many of them at events and at starts of segments.
#pragma once

#include <cstdint>
#include <vector>

#include "changes.h"

namespace vibratory_alignment::hunt {

/// Those of that seed, drawn while the trial runs with them: they know where its events are. None where it has no
/// start.
std::vector<Change> random_changes(std::uint64_t seed, const Scene& scene);

}  // namespace vibratory_alignment::hunt
