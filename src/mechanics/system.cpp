#include "mechanics/system.h"

#include <cmath>
#include <string>

#include "mechanics/statics.h"
#include "model/scaling.h"
#include "model/scene.h"
#include "model/scene_error.h"

namespace vibratory_alignment {
namespace {

Axis make_axis(const GripperAxis& gripper, double anchor) {
  Axis axis;
  axis.moves = gripper.moves;
  axis.inertia = gripper.inertia;
  axis.inverse_inertia = gripper.moves ? 1.0 / gripper.inertia : 0.0;
  axis.stiffness = gripper.stiffness;
  axis.damping = gripper.damping;
  axis.anchor = anchor;
  return axis;
}

/// "x = 0.001 m, phi = 0.02 rad", in the scene's own units.
std::string place_text(const Scene& scene, const State& place, bool with_phi) {
  std::string text = "x = " + own_unit_text(scene, Quantity::length, place.x);
  if (with_phi) text += ", phi = " + own_unit_text(scene, Quantity::angle, place.phi);
  return scene.units == Units::si ? text : text + " (dimensionless)";
}

[[noreturn]] void refuse(const Scene& scene, const std::string& fault) {
  throw SceneError(scene.source.empty() ? scene.name : scene.source, {fault});
}

}  // namespace

System make_system(const Scene& scene) {
  System system;
  system.half_width = scene.part.half_width;
  system.base_distance = scene.part.base_distance;
  system.slot_half_width = scene.slot_half_width();
  system.x = make_axis(scene.gripper.x, scene.gripper.anchor_x);
  system.y = make_axis(scene.gripper.y, 0.0);
  system.phi = make_axis(scene.gripper.phi, scene.gripper.anchor_phi);
  system.weight = scene.weight;
  system.contacts = scene.contacts;
  system.has_floor = scene.contacts.walls && scene.slot.depth.has_value();
  system.floor_depth = scene.slot.depth.value_or(0.0);
  system.stiffness_x = scene.base.stiffness_x;
  system.stiffness_y = scene.base.stiffness_y;
  system.damping_x = scene.base.damping_x;
  system.damping_y = scene.base.damping_y;
  system.isotropic = system.stiffness_x == system.stiffness_y && system.damping_x == system.damping_y;
  system.recovery = scene.base.recovery;
  if (scene.friction) {
    system.friction = scene.friction->coefficient;
    system.regularization = scene.friction->regularization.value_or(0.0);
  }
  system.aligned_depth = scene.trial.aligned_depth;
  system.has_inserted_depth = scene.trial.inserted_depth.has_value();
  system.inserted_depth = scene.trial.inserted_depth.value_or(0.0);

  // the start: a locked coordinate has no velocity
  State& start = system.start;
  start.x = scene.initial.x;
  start.y = scene.initial.y.value_or(0.0);
  start.phi = scene.initial.phi.value_or(0.0);
  start.vx = system.x.moves ? scene.initial.vx : 0.0;
  start.vy = scene.initial.vy;
  start.omega = system.phi.moves ? scene.initial.omega : 0.0;

  if (scene.gripper.anchor_y) system.y.anchor = *scene.gripper.anchor_y;
  const bool free_y = !scene.initial.y, free_phi = !scene.initial.phi && system.phi.moves;
  if (!find_equilibrium(system, scene.gripper.pressing_force, free_y, free_phi)) {
    const bool untouchable =
        scene.gripper.pressing_force && !touch_height(system, start.x, free_phi ? system.phi.anchor : start.phi);
    refuse(scene, "initial: " + place_text(scene, start, !free_phi) +
                      (untouchable
                           ? ": nothing can be touched from above here, so gripper.pressing_force has no meaning; give "
                             "gripper.anchor.y, or a start over the base"
                           : ": no static equilibrium on the base found; give initial.y and initial.phi"));
  }
  return system;
}

}  // namespace vibratory_alignment
