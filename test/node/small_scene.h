// The scenes in test/node/scenes, for the tests of the node.
#pragma once

#include <string>
#include <vector>

#include "model/scene_loader.h"

namespace vibratory_alignment::small_scene {

inline const std::string path = TEST_SCENES "/small.yaml";
inline const std::string si_path = TEST_SCENES "/small_si.yaml";

/// The scene of the file with settings as in `align trial --set`.
inline Scene load(const std::string& file = path, const std::vector<std::string>& settings = {}) {
  return load_scene_file(file, settings);
}

}  // namespace vibratory_alignment::small_scene
