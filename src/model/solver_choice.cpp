#include "model/solver_choice.h"

#include <algorithm>
#include <cmath>

namespace vibratory_alignment {
namespace {

/// G at the outline of the part, so far from its centre along the insertion.
double mobility_at(const Scene& scene, double height) {
  const double of_mass = 1.0 / scene.gripper.y.inertia;
  if (!scene.gripper.phi.moves) return of_mass;
  const double a = scene.part.half_width;
  return of_mass + (a * a + height * height) / scene.gripper.phi.inertia;
}

/// ... of the part's farthest point.
double most_mobility(const Scene& scene) { return mobility_at(scene, scene.part.base_distance); }

/// ... of that or of the place of its sides at which an edge of the slot is when the trial starts.
double most_mobility_at_start(const Scene& scene) {
  return mobility_at(scene, std::max(scene.part.base_distance, -scene.initial.y.value_or(0.0)));
}

double rate_on_base(const Scene& scene, double mobility) {
  const double stiffness = std::max(scene.base.stiffness_x, scene.base.stiffness_y);
  const double damping = std::max(scene.base.damping_x, scene.base.damping_y);
  return std::max(std::sqrt(stiffness * mobility), damping * mobility);
}

/// What may push the part onto the base while it stands there: press, weight and all excitations together.
double standing_force(const Scene& scene) {
  const Gripper& gripper = scene.gripper;
  const double level = gripper.y.stiffness * (scene.part.base_distance - gripper.anchor_y.value_or(0.0));
  double force = scene.weight + gripper.pressing_force.value_or(std::max(0.0, level));
  for (const Excitation& e : scene.excitations)
    if (e.direction == Direction::y) force += std::abs(e.amplitude);
  return force;
}

double gripper_rate(const Scene& scene) {
  double rate = 0.0;
  for (const GripperAxis* axis : {&scene.gripper.x, &scene.gripper.y, &scene.gripper.phi})
    if (axis->moves) rate = std::max({rate, std::sqrt(axis->stiffness / axis->inertia), axis->damping / axis->inertia});
  return rate;
}

}  // namespace

double contact_rate(const Scene& scene) { return rate_on_base(scene, most_mobility(scene)); }

double layer_rate(const Scene& scene) {
  if (!scene.friction || !scene.friction->regularization) return 0.0;
  return scene.friction->coefficient * standing_force(scene) * most_mobility(scene) / *scene.friction->regularization;
}

const char* solver_for_accuracy(const Scene& scene) {
  const double fastest = std::max({contact_rate(scene), layer_rate(scene), gripper_rate(scene)});
  return fastest > kStiffRatio * scene.fastest_excitation() ? "auto" : "event";
}

double default_step(const Scene& scene) {
  const double on_base = rate_on_base(scene, most_mobility_at_start(scene));
  return kDefaultStep / std::max({scene.fastest_excitation(), on_base, gripper_rate(scene)});
}

double tolerance_for_accuracy(double accuracy) { return kToleranceShare * accuracy; }

}  // namespace vibratory_alignment
