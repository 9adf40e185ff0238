// Scenes for the tests of mechanics, solver and trial: YAML text, and a base that tests vary.
#pragma once

#include <string>
#include <vector>

#include "mechanics/system.h"
#include "model/scene_loader.h"
#include "model/setting.h"

namespace vibratory_alignment::test {

/// The scene of the text, after settings as --set has them.
inline Scene scene_of(const std::string& text, const std::vector<std::string>& settings = {}) {
  YAML::Node tree = YAML::Load(text);
  for (const std::string& setting : settings) apply_setting(tree, setting);
  return load_scene(tree, "test.yaml");
}

/// A part over the edge A1, all three motions, every number different from every other.
inline const std::string plain = R"(
part: {half_width: 0.67, base_distance: 0.93, inertia: 0.17}
slot: {clearance: 0.083}
gripper:
  stiffness: {x: 0.071, phi: 11.0}
  damping: {x: 0.013, y: 0.029, phi: 0.31}
  anchor: {x: 0.23, phi: 0.007}
  pressing_force: 0.27
base: {stiffness: {x: 2900.0, y: 4100.0}, damping: {x: 11.0, y: 17.0}}
contacts: [edges]
friction: {coefficient: 0.24}
excitation: {amplitude: 1.0, frequency: 19.0}
initial: {x: 0.21, y: 0.95, phi: 0.02}
trial: {time_limit: 3.0}
)";

/// A part that only goes up and down, over the edge A1: a ball on a damped spring.
inline const std::string ball = R"(
part: {half_width: 0.7, base_distance: 0.9}
slot: {clearance: 0.09}
gripper: {anchor: {y: 0.6}}
base: {stiffness: {y: 1.0e4}, damping: {y: 20.0}}
contacts: [edges]
excitation: {amplitude: 0.0, frequency: 10.0}
initial: {x: 0.2, y: 1.0}
trial: {time_limit: 10.0}
)";

}  // namespace vibratory_alignment::test
