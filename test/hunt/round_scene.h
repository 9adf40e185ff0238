// A scene of round numbers for every seed, as people write them: level, centred, isotropic, without dampers. What never
// happens at once in other random scenes does so here, exactly.
#pragma once

#include <cstdint>

#include "model/scene.h"

namespace vibratory_alignment::hunt {

/// The scene of that seed, dimensionless; not every one has a start.
Scene round_scene(std::uint64_t seed);

}  // namespace vibratory_alignment::hunt
