// A trial as the text of a scene file: what is made of it is the same trial, bit for bit.
#pragma once

#include <string>

#include "changes.h"
#include "model/scene.h"

namespace vibratory_alignment::hunt {

/// YAML of a dimensionless scene. Excitations that are none stand as one of amplitude zero, which a scene file must
/// have.
std::string scene_text(const Scene& scene);

/// The same, and under the key `changes` a list of these, if there are any. Only the hunt knows this key.
std::string trial_text(const Trial& trial);

/// A scene file, with changes or without. Throws SceneError as load_scene_file() does, and for faults of the changes.
Trial load_trial_file(const std::string& path);

}  // namespace vibratory_alignment::hunt
