#include "mechanics/contact_frame.h"

#include "mechanics/tilt.h"

namespace vibratory_alignment {
namespace {

/// Derivative of along_normal() by phi.
double slope_along_normal(Face face, double cos_phi, double sin_phi, double across, double along) {
  if (face == Face::bottom) return 2.0 * cos_phi * sin_phi * (across - along);
  return is_part_face(face) ? 2.0 * cos_phi * sin_phi * (along - across) : 0.0;
}

}  // namespace

ContactFrame contact_frame(const System& system, Face face) {
  switch (face) {
    case Face::bottom: return {0.0, 1.0, 1.0, system.base_distance};
    case Face::right_side: return {-1.0, 0.0, 1.0, system.half_width};
    case Face::left_side: return {1.0, 0.0, 1.0, system.half_width};
    case Face::right_wall: return {-1.0, 0.0, -1.0, -system.slot_half_width};
    case Face::left_wall: return {1.0, 0.0, -1.0, -system.slot_half_width};
    case Face::floor: return {0.0, 1.0, -1.0, -system.floor_depth};
    default: return {0.0, 1.0, -1.0, 0.0};
  }
}

Vec2 site_point(const System& system, const State& state, Site site) {
  const auto [c, s] = tilt_of(state.phi);
  return site_point(system, state, site, c, s);
}

Vec2 site_point(const System& system, const State& state, Site site, double c, double s) {
  if (is_edge(site)) {
    const double rx = side_of(site) * system.slot_half_width - state.x, ry = -state.y;
    return {rx * c + ry * s, ry * c - rx * s};
  }
  const double beta = side_of(site) * system.half_width;
  return {state.x + beta * c + system.base_distance * s, state.y + beta * s - system.base_distance * c};
}

double stiffness_of(const System& system, Face face, double cos_phi, double sin_phi) {
  return along_normal(face, cos_phi, sin_phi, system.stiffness_x, system.stiffness_y);
}

double damping_of(const System& system, Face face, double cos_phi, double sin_phi) {
  return along_normal(face, cos_phi, sin_phi, system.damping_x, system.damping_y);
}

double stiffness_slope_of(const System& system, Face face, double cos_phi, double sin_phi) {
  return slope_along_normal(face, cos_phi, sin_phi, system.stiffness_x, system.stiffness_y);
}

double damping_slope_of(const System& system, Face face, double cos_phi, double sin_phi) {
  return slope_along_normal(face, cos_phi, sin_phi, system.damping_x, system.damping_y);
}

ContactKinematics contact_kinematics(const System& system, const State& state, Site site, Face face) {
  const auto [c, s] = tilt_of(state.phi);
  return contact_kinematics(system, state, site, face, site_point(system, state, site, c, s), c, s);
}

ContactKinematics contact_kinematics(const System& system, const State& state, Site site, Face face, const Vec2& p,
                                     double c, double s) {
  const ContactFrame frame = contact_frame(system, face);
  ContactKinematics k;
  k.depth = frame.depth(p.x, p.y);
  if (is_part_face(face)) {
    k.normal = {frame.n1 * c - frame.n2 * s, frame.n1 * s + frame.n2 * c};
    k.lever = {side_of(site) * system.slot_half_width - state.x, -state.y};
  } else {
    k.normal = {frame.n1, frame.n2};
    k.lever = {p.x - state.x, p.y - state.y};
  }
  k.tangent = {k.normal.y, -k.normal.x};
  // velocity of the part's material point at the contact
  const Vec2 v{state.vx - state.omega * k.lever.y, state.vy + state.omega * k.lever.x};
  k.depth_rate = -(v.x * k.normal.x + v.y * k.normal.y);
  k.slip_velocity = v.x * k.tangent.x + v.y * k.tangent.y;
  // V = v.t + omega (r x t): the part's directions turn with omega, an edge's lever changes with -v, a corner's turns
  const double omega = state.omega;
  const Vec2& t = k.tangent;
  const Vec2& r = k.lever;
  if (is_part_face(face)) {
    const Vec2 t_rate{-omega * t.y, omega * t.x};
    k.slip_rate = state.vx * t_rate.x + state.vy * t_rate.y +
                  omega * (-state.vx * t.y + state.vy * t.x + r.x * t_rate.y - r.y * t_rate.x);
  } else {
    k.slip_rate = omega * (-omega * r.y * t.y - omega * r.x * t.x);
  }
  return k;
}

}  // namespace vibratory_alignment
