#include "mechanics/free_axes.h"

#include <algorithm>
#include <cmath>

namespace vibratory_alignment {
namespace {

/// Near critical damping, |a^2 - k/m| below the square of this part of a, the terms of the two modes nearly cancel.
constexpr double kApart = 0.8;

}  // namespace

FreeAxes::FreeAxes(const System& system) {
  if (system.x.moves) set(kX, system.x);
  if (system.y.moves) set(kY, system.y);
  if (system.phi.moves) set(kPhi, system.phi);
}

void FreeAxes::set(int i, const Axis& axis) {
  Constants& a = constants[i];
  a.decay = 0.5 * axis.damping / axis.inertia;
  a.pull = axis.stiffness / axis.inertia;
  a.frequency = std::sqrt(a.pull);
  // (a - w)(a + w) loses no digits near critical damping
  a.square = (a.decay - a.frequency) * (a.decay + a.frequency);
  a.root = std::sqrt(std::abs(a.square));
  a.apart = a.root > kApart * a.decay;
  a.fast = a.decay + a.root;
  // the slow rate without cancellation
  a.slow = a.square > 0.0 ? a.pull / a.fast : a.decay;
  a.own_rate = a.square > 0.0 ? a.fast : a.frequency;
  fastest = std::max(fastest, a.own_rate);

  pull[i] = a.pull;
  decay[i] = a.decay;
  fall[i] = a.slow;
  slope_rate[i] = a.square > 0.0 ? a.fast : a.decay;
  if (a.square < 0.0) {
    half_root[i] = 0.5 * a.root;
    inverse_root[i] = 1.0 / a.root;
    largest_half_root = std::max(largest_half_root, half_root[i]);
    any_underdamped = true;
  } else if (a.square > 0.0) {
    between[i] = 2.0 * a.root;
    inverse_between[i] = 0.5 / a.root;
    any_overdamped = true;
  } else {
    critical[i] = 1.0;
  }
  if (!a.apart) {
    near[i] = 1.0;
    near_most[i] = a.decay > 0.0 ? 0.5 / a.decay : 0.0;
    any_near = true;
  } else if (a.square < 0.0) {
    mode_rate[i] = a.frequency;
  } else {
    modes[i] = -1;
    mode_rate[i] = a.slow;
    fast_mode_rate[i] = a.fast;
  }
}

}  // namespace vibratory_alignment
