// Reads a study from YAML (docs/studies.md).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/study.h"

namespace vibratory_alignment {

/// The file of the scene that comes with the package under this name. Throws std::runtime_error when there is none.
using FindScene = std::function<std::string(const std::string& name)>;

/// Reads the study and its scene. `find_scene` is asked for a scene that is no file beside the study.
/// Throws SceneError with every fault at once, "source: key.path: value: what is allowed"; also as
/// refuse_without_scenes.
Study load_study(const std::string& path, const FindScene& find_scene);

/// The study with further settings for every trial, "key.path=value" as apply_setting() takes them. Throws SceneError.
Study with_settings(const Study& study, const std::vector<std::string>& settings);

}  // namespace vibratory_alignment
