#include "mechanics/forces.h"

#include <cmath>

#include "mechanics/holding_forces.h"
#include "mechanics/tilt.h"

namespace vibratory_alignment {

void evaluate_forces(const System& system, const State& state, const Load3& drive, const ContactStates& contacts,
                     Forces& forces) {
  double fx = drive.x - system.x.damping * state.vx - system.x.stiffness * (state.x - system.x.anchor);
  double fy = drive.y - system.y.damping * state.vy - system.y.stiffness * (state.y - system.y.anchor) - system.weight;
  double moment = drive.phi - system.phi.damping * state.omega - system.phi.stiffness * (state.phi - system.phi.anchor);
  const auto [c, s] = tilt_of(state.phi);
  std::array<ContactKinematics, kSiteCount> kinematics;
  std::array<int, kSiteCount> sticking{};
  int sticking_count = 0;
  forces.count = 0;
  for (std::size_t i = 0; i < kSiteCount; ++i) {
    const ContactState& contact = contacts[i];
    if (contact.phase != Phase::loaded) continue;
    const auto index = static_cast<std::size_t>(forces.count);
    const ContactKinematics& k = kinematics[index] = contact_kinematics(
        system, state, static_cast<Site>(i), contact.face, site_point(system, state, static_cast<Site>(i), c, s), c, s);
    ContactForce& force = forces.contact[index];
    force.site = static_cast<Site>(i);
    force.depth = k.depth;
    force.slip_velocity = k.slip_velocity;
    force.normal_force =
        stiffness_of(system, contact.face, c, s) * k.depth + damping_of(system, contact.face, c, s) * k.depth_rate;
    switch (contact.slip) {
      case Slip::plus: force.tangential_force = -system.friction * force.normal_force; break;
      case Slip::minus: force.tangential_force = system.friction * force.normal_force; break;
      case Slip::regularized:
        force.tangential_force =
            -system.friction * force.normal_force * std::tanh(k.slip_velocity / system.regularization);
        break;
      case Slip::stick:
        force.tangential_force = 0.0;
        sticking[static_cast<std::size_t>(sticking_count++)] = forces.count;
        break;
      case Slip::none: force.tangential_force = 0.0; break;
    }
    const Vec2 total{force.normal_force * k.normal.x + force.tangential_force * k.tangent.x,
                     force.normal_force * k.normal.y + force.tangential_force * k.tangent.y};
    fx += total.x;
    fy += total.y;
    moment += cross(k.lever, total);
    ++forces.count;
  }
  forces.ax = system.x.inverse_inertia * fx;
  forces.ay = system.y.inverse_inertia * fy;
  forces.alpha = system.phi.inverse_inertia * moment;
  if (sticking_count == 0) return;

  // T of what sticks takes out V'
  HoldingForces::Rows rows{};
  HoldingForces::Vector slip_rates{};
  for (int m = 0; m < sticking_count; ++m) {
    const ContactKinematics& k = kinematics[static_cast<std::size_t>(sticking[m])];
    rows[m] = {k.tangent.x, k.tangent.y, cross(k.lever, k.tangent)};
    slip_rates[m] = k.slip_rate;
  }
  HoldingForces holding;
  holding.set(system, rows, sticking_count);
  const HoldingForces::Answer held = holding.hold_motion({{}, forces.ax, forces.ay, forces.alpha}, slip_rates);
  for (int m = 0; m < sticking_count; ++m)
    forces.contact[static_cast<std::size_t>(sticking[m])].tangential_force = held.force[m];
  forces.ax = held.x;
  forces.ay = held.y;
  forces.alpha = held.phi;
}

}  // namespace vibratory_alignment
