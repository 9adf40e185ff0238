// Set-valued friction of a few contacts at once: T_i with |T_i| <= f N_i for given N_i, so that at the end of a step
// V_i = 0, or T_i = -f N_i while V_i > 0, or T_i = f N_i while V_i < 0.
//
// V_i = v_i + sum_j G_ij T_j with G symmetric, positive semidefinite: these are the conditions of a least value of
// 1/2 T.G T + v.T in a box. V is unique; where contacts hold the same motion T is not, and they share alike.
#pragma once

#include "mechanics/mobility.h"

namespace vibratory_alignment {

struct BoxFriction {
  int count = 0;
  Mobility::Matrix mobility{};   ///< G
  Mobility::Vector slip_free{};  ///< v, V without friction
  Mobility::Vector limit{};      ///< f N
  double typical = 0.0;          ///< a G_ii beside which rounding is small
};

/// T of all contacts.
Mobility::Vector solve_box_friction(const BoxFriction& problem);

}  // namespace vibratory_alignment
