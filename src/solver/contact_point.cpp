#include "solver/contact_point.h"

namespace vibratory_alignment {

Vec2 site_point(const System& system, const PlacedState& placed, Site site) {
  const State& state = placed.state;
  const double c = placed.cos_phi, s = placed.sin_phi;
  if (is_edge(site)) {
    const double rx = side_of(site) * system.slot_half_width - state.x, ry = -state.y;
    return {rx * c + ry * s, ry * c - rx * s};
  }
  const double beta = side_of(site) * system.half_width;
  return {state.x + beta * c + system.base_distance * s, state.y + beta * s - system.base_distance * c};
}

ContactPoint contact_point(const System& system, const PlacedState& placed, Site site, Face face, const Vec2& point) {
  const State& state = placed.state;
  const double c = placed.cos_phi, s = placed.sin_phi;
  const ContactFrame frame = contact_frame(system, face);
  ContactPoint p;
  p.depth = frame.depth(point.x, point.y);
  if (is_part_face(face)) {
    p.normal = {frame.n1 * c - frame.n2 * s, frame.n1 * s + frame.n2 * c};
    p.lever = {side_of(site) * system.slot_half_width - state.x, -state.y};
  } else {
    p.normal = {frame.n1, frame.n2};
    p.lever = {point.x - state.x, point.y - state.y};
  }
  p.tangent = {p.normal.y, -p.normal.x};
  // velocity of the part's material point at the contact
  const Vec2 v{state.vx - state.omega * p.lever.y, state.vy + state.omega * p.lever.x};
  p.depth_rate = -(v.x * p.normal.x + v.y * p.normal.y);
  p.slip_velocity = v.x * p.tangent.x + v.y * p.tangent.y;
  p.stiffness = stiffness_of(system, face, c, s);
  p.damping = damping_of(system, face, c, s);
  return p;
}

}  // namespace vibratory_alignment
