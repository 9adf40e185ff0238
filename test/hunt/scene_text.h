// A scene as the text of a scene file: what load_scene() makes of it is the same scene, bit for bit.
#pragma once

#include <string>

#include "model/scene.h"

namespace vibratory_alignment::hunt {

/// YAML of a dimensionless scene. Excitations that are none stand as one of amplitude zero, which a scene file must
/// have.
std::string scene_text(const Scene& scene);

}  // namespace vibratory_alignment::hunt
