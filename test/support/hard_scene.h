// The hard cases with known answers: scenes in config/scenes/hard, explained in docs/hard_cases.md.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "model/scene_loader.h"

namespace vibratory_alignment::test {

/// The scene config/scenes/hard/NAME.yaml, after settings as --set has them.
inline Scene hard_scene(const std::string& name, const std::vector<std::string>& settings = {}) {
  return load_scene_file(std::string(SCENE_DIR) + "/hard/" + name + ".yaml", settings);
}

/// Gives the base a stiffness C1 and the damper with which a mass of 1 on it has the damping ratio.
inline void set_base(Scene& scene, double stiffness, double damping_ratio) {
  const double damping = 2.0 * damping_ratio * std::sqrt(stiffness);
  scene.base = {stiffness, stiffness, damping, damping, false};
}

}  // namespace vibratory_alignment::test
