#include "model/solver_choice.h"

#include <algorithm>
#include <cmath>

namespace vibratory_alignment {

double contact_rate_ratio(const Scene& scene) {
  double mobility = 1.0 / scene.gripper.y.inertia;
  if (scene.gripper.phi.moves) {
    const double a = scene.part.half_width, b = scene.part.base_distance;
    mobility += (a * a + b * b) / scene.gripper.phi.inertia;
  }
  const double stiffness = std::max(scene.base.stiffness_x, scene.base.stiffness_y);
  const double damping = std::max(scene.base.damping_x, scene.base.damping_y);
  return std::max(std::sqrt(stiffness * mobility), damping * mobility) / scene.fastest_excitation();
}

const char* solver_for_accuracy(const Scene& scene) {
  return contact_rate_ratio(scene) > kStiffRatio ? "auto" : "event";
}

double default_step(const Scene& scene) {
  double rate = scene.fastest_excitation() * std::max(1.0, contact_rate_ratio(scene));
  for (const GripperAxis* axis : {&scene.gripper.x, &scene.gripper.y, &scene.gripper.phi})
    if (axis->moves) rate = std::max({rate, std::sqrt(axis->stiffness / axis->inertia), axis->damping / axis->inertia});
  return kDefaultStep / rate;
}

double tolerance_for_accuracy(double accuracy) { return kToleranceShare * accuracy; }

}  // namespace vibratory_alignment
