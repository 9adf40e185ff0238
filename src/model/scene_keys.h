// The key paths that a scene can have, as docs/scene.md lists them.
#pragma once

#include <string>
#include <vector>

namespace vibratory_alignment {

/// Key paths of all keys and sections of scenes, dimensionless or SI; without positions in a list of excitations.
const std::vector<std::string>& scene_keys();

}  // namespace vibratory_alignment
