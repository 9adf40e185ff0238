#include "trial/contact_impulse.h"

#include <cmath>

#include "mechanics/contact_frame.h"
#include "solver/layer_crossing.h"

namespace vibratory_alignment {
namespace {

/// Products that differ by less are the same but for rounding.
constexpr double kSame = 1e-15;

/// a + i b times c + i d.
Pair product(const Pair& a, const Pair& b) { return Pair{a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]}; }

/// Integral of force times e1 = (cos phi, sin phi).
Pair turned_integral(const Series& force, const Segment& segment, double from, double to) {
  const int order = segment.order;
  PairSeries e1;
  for (int k = 0; k <= order; ++k) e1[k] = Pair{segment.cos_phi[k], segment.sin_phi[k]};
  Pair at_from{}, at_to{};
  for (int k = order; k >= 0; --k) {
    const Pair term = kInverse[static_cast<std::size_t>(k + 1)] * product_term(e1, force, k);
    at_from = at_from * from + term;
    at_to = at_to * to + term;
  }
  return at_to * to - at_from * from;
}

/// True for sliding friction: T is a multiple of N throughout.
bool is_proportional(const ContactSeries& contact, int order) {
  const Series& n = contact.normal_force;
  const Series& t = contact.tangential_force;
  for (int k = 1; k <= order; ++k)
    if (!(std::abs(t[k] * n[0] - n[k] * t[0]) <= kSame * std::abs(n[k] * t[0]))) return false;
  return n[0] > 0.0;
}

/// Of a crossing of the tanh layer, by its quadrature.
ContactImpulse crossing_impulse(const System& system, const Segment& segment, Face face, double from, double to) {
  const LayerCrossing& crossing = *segment.layer_crossing;
  const auto [count, time, weight] = crossing.quadrature(from, to);
  ContactImpulse impulse;
  for (std::size_t i = 0; i < count; ++i) {
    const ContactValues contact = crossing.contact_at(time[i]);
    const double normal = weight[i] * contact.normal_force, friction = weight[i] * contact.tangential_force;
    const ContactKinematics k = contact_kinematics(system, crossing.at(time[i]), segment.loaded[0].site, face);
    impulse.normal += normal;
    impulse.friction += friction;
    impulse.x += normal * k.normal.x + friction * k.tangent.x;
    impulse.y += normal * k.normal.y + friction * k.tangent.y;
  }
  return impulse;
}

}  // namespace

ContactImpulse& ContactImpulse::operator+=(const ContactImpulse& other) {
  normal += other.normal;
  friction += other.friction;
  x += other.x;
  y += other.y;
  return *this;
}

ContactImpulse contact_impulse(const System& system, const Segment& segment, int i, double from, double to) {
  const ContactSeries& contact = segment.loaded[static_cast<std::size_t>(i)];
  const Face face = segment.contacts[static_cast<std::size_t>(contact.site)].face;
  if (segment.layer_crossing != nullptr) return crossing_impulse(system, segment, face, from, to);
  ContactImpulse impulse;
  impulse.normal = integral(contact.normal_force, segment.order, from, to);
  impulse.friction = integral(contact.tangential_force, segment.order, from, to);
  // along the frame's first axis, which turns with the part or is that of the world
  Pair normal{impulse.normal, 0.0}, friction{impulse.friction, 0.0};
  if (is_part_face(face)) {
    normal = turned_integral(contact.normal_force, segment, from, to);
    friction = is_proportional(contact, segment.order) ? contact.tangential_force[0] / contact.normal_force[0] * normal
                                                       : turned_integral(contact.tangential_force, segment, from, to);
  }
  const ContactFrame frame = contact_frame(system, face);
  const Pair world = product(Pair{frame.n1, frame.n2}, normal) + product(Pair{frame.t1(), frame.t2()}, friction);
  impulse.x = world[0];
  impulse.y = world[1];
  return impulse;
}

}  // namespace vibratory_alignment
