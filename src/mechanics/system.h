// The mechanical system of a scene: its numbers as the solvers use them, with the gripper's anchor and the start
// resolved (MODEL.md "Free motion", "Contact", "Settled readings"). Dimensionless.
#pragma once

#include "mechanics/state.h"
#include "model/scene.h"

namespace vibratory_alignment {

/// inertia q'' + damping q' + stiffness (q - anchor) = force; a locked axis has inverse_inertia 0.
struct Axis {
  bool moves = false;
  double inertia = 1.0, inverse_inertia = 0.0;
  double stiffness = 0.0, damping = 0.0, anchor = 0.0;
};

struct System {
  double half_width = 0.0;       ///< a
  double base_distance = 0.0;    ///< b
  double slot_half_width = 0.0;  ///< l
  Axis x, y, phi;
  double weight = 0.0;  ///< w

  ContactFeatures contacts;
  bool has_floor = false;
  double floor_depth = 0.0;
  double stiffness_x = 0.0, stiffness_y = 0.0;  ///< C2, C1
  double damping_x = 0.0, damping_y = 0.0;      ///< H2, H1
  bool isotropic = true;                        ///< C1 = C2 and H1 = H2
  bool recovery = false;

  double friction = 0.0;        ///< f, 0: no friction
  double regularization = 0.0;  ///< eps, 0: set-valued friction
  /// |V|/eps beyond which tanh counts as 1 and the regularised law as sliding friction: to the last digit, or to what a
  /// solver's tolerance asks for.
  double tanh_saturation = 19.1;

  double aligned_depth = 0.0;
  bool has_inserted_depth = false;
  double inserted_depth = 0.0;

  State start;
};

/// True with the tanh law of friction.
inline bool has_layer(const System& system) { return system.friction > 0.0 && system.regularization > 0.0; }

/// Resolves a scene. Throws SceneError (of the scene's source, else its name) when pressing_force is given but nothing
/// can be touched from above (no y_touch), or when a start asked for as equilibrium does not exist.
System make_system(const Scene& scene);

}  // namespace vibratory_alignment
