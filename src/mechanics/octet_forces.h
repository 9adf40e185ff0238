// The equations of motion at eight states at once (mechanics/forces.h): what the stages of an implicit step ask for.
#pragma once

#include "mechanics/forces.h"
#include "mechanics/octet.h"

namespace vibratory_alignment {

struct StateOctet {
  Octet x, y, phi, vx, vy, omega;

  State operator[](std::size_t i) const { return {x[i], y[i], phi[i], vx[i], vy[i], omega[i]}; }
};

struct LoadOctet {
  Octet x, y, phi;
};

/// As ContactForce, of one contact.
struct ContactForceOctet {
  Octet depth, normal_force, tangential_force, friction_ratio, slip_velocity;
};

/// As Forces.
struct ForcesOctet {
  Octet ax, ay, alpha;
  int count = 0;
  std::array<Site, kSiteCount> site{};
  std::array<ContactForceOctet, kSiteCount> contact;  ///< of the loaded sites, in their order

  Forces operator[](std::size_t i) const;
};

/// Normal forces of the loaded contacts, in their order.
using NormalForcesOctet = std::array<Octet, kSiteCount>;

/// Forces of the excitations at these times.
[[gnu::noinline]] void evaluate_drives(const DriveForm* forms, const Direction* directions, int count,
                                       const Octet& times, LoadOctet& load);

/// What evaluate_forces() gives for each state, but with the accelerations, and T of what sticks, that other normal
/// forces than those of the states would cause, with the friction that goes with them. N and T of what slides are told
/// as those of the states. False where what sticks had to be held state by state, which takes ten times as long.
[[gnu::noinline]] bool evaluate_forces_under(const NormalForcesOctet& acting, const System& system,
                                             const StateOctet& states, const LoadOctet& drive,
                                             const ContactStates& contacts, ForcesOctet& forces);

}  // namespace vibratory_alignment
