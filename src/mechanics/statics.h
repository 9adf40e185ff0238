// Statics of the part on the base: the height at which it touches and the equilibrium it rests in
// (MODEL.md "Free motion", "Settled readings").
#pragma once

#include <optional>

#include "mechanics/system.h"

namespace vibratory_alignment {

/// y_touch: the largest y at which one of the contacts that the scene calls for touches from above, at the given x and
/// phi; empty when nothing can be touched.
std::optional<double> touch_height(const System& system, double x, double phi);

/// Net force and moment on the part at rest: gripper, weight and contact forces, without excitation.
struct StaticLoad {
  double force_y = 0.0, moment = 0.0;
  double lift = 0.0;  ///< of force_y, what the base pushes up with
};

/// Load at rest in (x, y, phi). Friction holds the horizontal force as far as it can: set-valued friction, all loaded
/// contacts by the same share of f N, those with a steep tangent by less; none when the law is regularised, which gives
/// no force at rest.
StaticLoad static_load(const System& system, double x, double y, double phi);

/// y and phi of the static equilibrium at system.start.x; what is given stays, a y that is sought is on the base. With
/// `pressing_force`, y_a follows phi as y_touch - pressing_force and is set in `system`. False when there is none.
bool find_equilibrium(System& system, std::optional<double> pressing_force, bool free_y, bool free_phi);

}  // namespace vibratory_alignment
