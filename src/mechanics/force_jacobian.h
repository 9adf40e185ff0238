// Derivatives of the accelerations by the state, with the law that holds at each contact given: what Newton's method
// takes from the equations of motion (docs/implicit_steps.md).
#pragma once

#include <Eigen/Core>

#include "mechanics/forces.h"

namespace vibratory_alignment {

/// The normal force of one contact.
struct NormalJacobian {
  Eigen::Vector3d push;                         ///< accelerations that N = 1 causes, with the friction it allows
  Eigen::RowVector3d by_position, by_velocity;  ///< derivatives of N
};

/// What friction in the tanh layer is made of, T = -f N tanh(V/eps), at one contact.
struct LayerJacobian {
  int contact = 0;                                        ///< index in Forces::contact
  double by_slip = 0.0;                                   ///< derivative of T by V
  Eigen::Vector3d push;                                   ///< accelerations that T = 1 causes
  Eigen::RowVector3d slip_by_position, slip_by_velocity;  ///< derivatives of V
};

/// Rows: x'', y'', phi''. The columns of a locked axis are zero.
struct ForceJacobian {
  Eigen::Matrix3d by_position;                    ///< by x, y, phi
  Eigen::Matrix3d by_velocity;                    ///< by x', y', phi'
  int count = 0;                                  ///< of contacts
  std::array<NormalJacobian, kSiteCount> normal;  ///< of those of Forces::contact, part of the above
  int layer_count = 0;
  std::array<LayerJacobian, kSiteCount> layer;  ///< of the contacts in the tanh layer, which are part of the above
};

/// `forces`: what evaluate_forces() gives for this state and these contacts.
ForceJacobian force_jacobian(const System& system, const State& state, const ContactStates& contacts,
                             const Forces& forces);

}  // namespace vibratory_alignment
