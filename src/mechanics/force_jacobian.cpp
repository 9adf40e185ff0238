#include "mechanics/force_jacobian.h"

#include <cmath>

#include "mechanics/holding_forces.h"
#include "mechanics/tilt.h"

namespace vibratory_alignment {
namespace {

using Eigen::Matrix3d;
using Eigen::RowVector3d;
using Eigen::Vector3d;

double dot(const Vec2& a, const Vec2& b) { return a.x * b.x + a.y * b.y; }

/// The directions g = (e, r x e) in which N and T push on (x, y, phi), e = n or t: d' = -g_n.q', V = g_t.q', and
/// dd/dq = -g_n. With them their derivatives by the position, and those of the rates by the position.
struct Directions {
  Vector3d normal, tangent;      ///< g_n, g_t
  Matrix3d normal_by_position;   ///< dg_n/dq
  Matrix3d tangent_by_position;  ///< dg_t/dq
  RowVector3d depth_rate_by_position, slip_velocity_by_position;
};

/// A part's face turns with it, dn = -t dphi, dt = n dphi, about an edge at rest, dr = -(dx, dy). Of a face of the base
/// only the lever turns, dr = (-r_y, r_x) dphi.
Directions directions(const ContactKinematics& k, bool part_face, double omega) {
  Directions g;
  const Vec2 &n = k.normal, &t = k.tangent, &r = k.lever;
  g.normal << n.x, n.y, cross(r, n);
  g.tangent << t.x, t.y, cross(r, t);
  if (part_face) {
    g.normal_by_position << 0.0, 0.0, -t.x, 0.0, 0.0, -t.y, -n.y, n.x, -cross(r, t);
    g.tangent_by_position << 0.0, 0.0, n.x, 0.0, 0.0, n.y, -t.y, t.x, cross(r, n);
    g.depth_rate_by_position << omega * n.y, -omega * n.x, k.slip_velocity;
    g.slip_velocity_by_position << -omega * t.y, omega * t.x, -k.depth_rate;
  } else {
    g.normal_by_position << 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -dot(r, n);
    g.tangent_by_position << 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -dot(r, t);
    g.depth_rate_by_position << 0.0, 0.0, omega * dot(r, n);
    g.slip_velocity_by_position << 0.0, 0.0, -omega * dot(r, t);
  }
  return g;
}

/// A sticking contact: V' = g_t.q'' + s, s the slip rate that velocities alone cause.
struct Sticking {
  Vector3d tangent;
  Matrix3d tangent_by_position;
  RowVector3d rate_by_position, rate_by_velocity;  ///< derivatives of s
};

/// s = 2 omega v.n + omega^2 r x n at a face of the part, -omega^2 r.t at one of the base.
Sticking sticking(const ContactKinematics& k, const Directions& g, bool part_face, const State& state) {
  Sticking s{g.tangent, g.tangent_by_position, RowVector3d::Zero(), RowVector3d::Zero()};
  const Vec2 &n = k.normal, &t = k.tangent, &r = k.lever, v{state.vx, state.vy};
  const double w = state.omega;
  if (part_face) {
    s.rate_by_position << -w * w * n.y, w * w * n.x, -2.0 * w * dot(v, t) - w * w * cross(r, t);
    s.rate_by_velocity << 2.0 * w * n.x, 2.0 * w * n.y, 2.0 * (dot(v, n) + w * cross(r, n));
  } else {
    s.rate_by_position << 0.0, 0.0, -w * w * cross(r, t);
    s.rate_by_velocity << 0.0, 0.0, -2.0 * w * dot(r, t);
  }
  return s;
}

/// Changes of the accelerations, column by column, less what the T that keep V' = 0 take out of them. `rate`: what else
/// V' of every contact changes by.
void hold(const HoldingForces& holding, const std::array<RowVector3d, kSiteCount>& rate, int count, Matrix3d& matrix) {
  for (int column = 0; column < 3; ++column) {
    HoldingForces::Vector slip_rates{};
    for (int i = 0; i < count; ++i) slip_rates[i] = rate[i][column];
    const HoldingForces::Answer held =
        holding.hold_motion({{}, matrix(0, column), matrix(1, column), matrix(2, column)}, slip_rates);
    matrix.col(column) << held.x, held.y, held.phi;
  }
}

}  // namespace

ForceJacobian force_jacobian(const System& system, const State& state, const ContactStates& contacts,
                             const Forces& forces) {
  ForceJacobian result;
  Matrix3d &by_q = result.by_position, &by_v = result.by_velocity;
  by_q = -Vector3d(system.x.stiffness, system.y.stiffness, system.phi.stiffness).asDiagonal().toDenseMatrix();
  by_v = -Vector3d(system.x.damping, system.y.damping, system.phi.damping).asDiagonal().toDenseMatrix();
  const auto [c, s] = tilt_of(state.phi);
  const double f = system.friction;
  const Vector3d inverse(system.x.inverse_inertia, system.y.inverse_inertia, system.phi.inverse_inertia);
  std::array<Sticking, kSiteCount> stuck;
  int stuck_count = 0;
  result.count = forces.count;
  for (int i = 0; i < forces.count; ++i) {
    const ContactForce& force = forces.contact[static_cast<std::size_t>(i)];
    const ContactState& contact = contacts[static_cast<std::size_t>(force.site)];
    const bool part_face = is_part_face(contact.face);
    const ContactKinematics k =
        contact_kinematics(system, state, force.site, contact.face, site_point(system, state, force.site, c, s), c, s);
    const Directions g = directions(k, part_face, state.omega);

    const double stiffness = stiffness_of(system, contact.face, c, s), damping = damping_of(system, contact.face, c, s);
    RowVector3d n_by_q = -stiffness * g.normal.transpose() + damping * g.depth_rate_by_position;
    n_by_q[2] += stiffness_slope_of(system, contact.face, c, s) * k.depth +
                 damping_slope_of(system, contact.face, c, s) * k.depth_rate;
    const RowVector3d n_by_v = -damping * g.normal.transpose();

    // T = -f N share, by N and by V
    const double n = force.normal_force, t = force.tangential_force;
    double share = 0.0, share_by_v = 0.0;
    switch (contact.slip) {
      case Slip::plus: share = 1.0; break;
      case Slip::minus: share = -1.0; break;
      case Slip::regularized:
        share = std::tanh(k.slip_velocity / system.regularization);
        share_by_v = (1.0 - share) * (1.0 + share) / system.regularization;
        result.layer[static_cast<std::size_t>(result.layer_count++)] = {
            i, -f * n * share_by_v, inverse.cwiseProduct(g.tangent), g.slip_velocity_by_position,
            g.tangent.transpose()};
        break;
      case Slip::stick: stuck[static_cast<std::size_t>(stuck_count++)] = sticking(k, g, part_face, state); break;
      case Slip::none: break;
    }
    const Vector3d push = g.normal - f * share * g.tangent;
    result.normal[static_cast<std::size_t>(i)] = {inverse.cwiseProduct(push), n_by_q, n_by_v};
    by_q += push * n_by_q - f * n * share_by_v * g.tangent * g.slip_velocity_by_position + n * g.normal_by_position +
            t * g.tangent_by_position;
    by_v += push * n_by_v - f * n * share_by_v * g.tangent * g.tangent.transpose();
  }
  by_q = inverse.asDiagonal() * by_q;
  by_v = inverse.asDiagonal() * by_v;
  if (stuck_count > 0) {
    HoldingForces::Rows rows{};
    std::array<RowVector3d, kSiteCount> rate_by_q, rate_by_v;
    const RowVector3d acceleration(forces.ax, forces.ay, forces.alpha);
    for (int i = 0; i < stuck_count; ++i) {
      const Sticking& at = stuck[static_cast<std::size_t>(i)];
      rows[i] = {at.tangent[0], at.tangent[1], at.tangent[2]};
      rate_by_q[i] = acceleration * at.tangent_by_position + at.rate_by_position;
      rate_by_v[i] = at.rate_by_velocity;
    }
    HoldingForces holding;
    holding.set(system, rows, stuck_count);
    hold(holding, rate_by_q, stuck_count, by_q);
    hold(holding, rate_by_v, stuck_count, by_v);
    for (int i = 0; i < forces.count; ++i) {
      Vector3d& push = result.normal[static_cast<std::size_t>(i)].push;
      const HoldingForces::Answer held = holding.hold_motion({{}, push[0], push[1], push[2]}, {});
      push << held.x, held.y, held.phi;
    }
  }
  const auto lock = [&](const Axis& axis, int column) {
    if (axis.moves) return;
    by_q.col(column).setZero();
    by_v.col(column).setZero();
  };
  lock(system.x, 0);
  lock(system.y, 1);
  lock(system.phi, 2);
  return result;
}

}  // namespace vibratory_alignment
