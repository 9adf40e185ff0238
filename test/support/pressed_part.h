// A part in lasting contact, on a base that tests vary.
#pragma once

#include <cmath>

#include "scenes.h"

namespace vibratory_alignment::test {

/// Pressed so hard that it never leaves the base, shaken across and along: sticks and slips twenty times.
inline Scene pressed(double stiffness, double damping_ratio) {
  Scene scene = scene_of(plain, {"gripper.pressing_force=3", "friction.coefficient=0.2", "trial.time_limit=5"});
  scene.initial.y.reset();
  scene.initial.phi.reset();
  scene.base.stiffness_x = scene.base.stiffness_y = stiffness;
  scene.base.damping_x = scene.base.damping_y = 2.0 * damping_ratio * std::sqrt(stiffness);
  return scene;
}

}  // namespace vibratory_alignment::test
