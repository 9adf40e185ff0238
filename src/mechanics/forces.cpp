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
  // of what sticks: index, row of J, and V' that the velocities alone cause
  std::array<int, kSiteCount> sticking;
  HoldingForces::Rows rows;
  HoldingForces::Vector slip_rates;
  int sticking_count = 0;
  forces.count = 0;
  for (std::size_t i = 0; i < kSiteCount; ++i) {
    const ContactState& contact = contacts[i];
    if (contact.phase != Phase::loaded) continue;
    const auto index = static_cast<std::size_t>(forces.count);
    const ContactKinematics k = contact_kinematics(system, state, static_cast<Site>(i), contact.face,
                                                   site_point(system, state, static_cast<Site>(i), c, s), c, s);
    ContactForce& force = forces.contact[index];
    force.site = static_cast<Site>(i);
    force.depth = k.depth;
    force.slip_velocity = k.slip_velocity;
    force.normal_force =
        stiffness_of(system, contact.face, c, s) * k.depth + damping_of(system, contact.face, c, s) * k.depth_rate;
    double ratio = 0.0;
    switch (contact.slip) {
      case Slip::plus: ratio = -system.friction; break;
      case Slip::minus: ratio = system.friction; break;
      case Slip::regularized: ratio = -system.friction * std::tanh(k.slip_velocity / system.regularization); break;
      case Slip::stick: {
        const auto m = static_cast<std::size_t>(sticking_count++);
        sticking[m] = forces.count;
        rows[m] = {k.tangent.x, k.tangent.y, cross(k.lever, k.tangent)};
        slip_rates[m] = k.slip_rate;
        break;
      }
      case Slip::none: break;
    }
    force.friction_ratio = ratio;
    force.tangential_force = ratio * force.normal_force;
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
