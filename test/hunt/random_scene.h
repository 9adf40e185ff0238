// A random scene for every seed: all effects, in all combinations.
#pragma once

#include <cstdint>

#include "model/scene.h"

namespace vibratory_alignment::hunt {

/// ordinary: what a gripper and a hole could be. wild: far beyond, the most extreme numbers that the loader accepts
/// and that mean something (stiffness to 1e12, inertia from 1e-8, clearance from 1e-9, frequency to 1e4, any tilt).
/// round: the numbers that people write (round_scene.h).
enum class Range { ordinary, wild, round };

const char* to_string(Range range);

/// The scene of that seed, dimensionless; not every one has a start (make_system() refuses those that have none).
Scene random_scene(std::uint64_t seed, Range range);

}  // namespace vibratory_alignment::hunt
