// The mirror image of scenes, states and sites: left and right exchanged.
#pragma once

#include <vector>

#include "mechanics/contact.h"
#include "mechanics/state.h"
#include "model/scene.h"

namespace vibratory_alignment::test {

inline std::vector<Excitation> mirrored(std::vector<Excitation> excitations) {
  for (Excitation& e : excitations)
    if (e.direction != Direction::y) e.amplitude = -e.amplitude;
  return excitations;
}

inline Scene mirrored(Scene s) {
  s.initial.x = -s.initial.x;
  s.initial.vx = -s.initial.vx;
  s.initial.omega = -s.initial.omega;
  if (s.initial.phi) s.initial.phi = -*s.initial.phi;
  s.gripper.anchor_x = -s.gripper.anchor_x;
  s.gripper.anchor_phi = -s.gripper.anchor_phi;
  s.excitations = mirrored(s.excitations);
  return s;
}

inline State mirrored(const State& s) { return {-s.x, s.y, -s.phi, -s.vx, s.vy, -s.omega}; }

inline Site twin(Site site) {
  const int i = static_cast<int>(site);
  return static_cast<Site>(i % 2 == 0 ? i + 1 : i - 1);
}

}  // namespace vibratory_alignment::test
