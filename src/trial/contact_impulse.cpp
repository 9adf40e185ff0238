#include "trial/contact_impulse.h"

#include "mechanics/contact_frame.h"

namespace vibratory_alignment {
namespace {

/// World components of a contact's force as series.
void force_series(const ContactFrame& frame, bool turning, const ContactSeries& contact, const Segment& segment,
                  Series& fx, Series& fy) {
  for (int k = 0; k <= segment.order; ++k) {
    // components along the frame's own axes
    const double f1 = frame.n1 * contact.normal_force[k] + frame.t1() * contact.tangential_force[k];
    const double f2 = frame.n2 * contact.normal_force[k] + frame.t2() * contact.tangential_force[k];
    fx[k] = f1;
    fy[k] = f2;
  }
  if (!turning) return;
  const Series f1 = fx, f2 = fy;
  for (int k = 0; k <= segment.order; ++k) {
    fx[k] = product_term(f1, segment.cos_phi, k) - product_term(f2, segment.sin_phi, k);
    fy[k] = product_term(f1, segment.sin_phi, k) + product_term(f2, segment.cos_phi, k);
  }
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
  Series fx{}, fy{};
  force_series(contact_frame(system, face), is_part_face(face), contact, segment, fx, fy);
  const int order = segment.order;
  return {integral(contact.normal_force, order, from, to), integral(contact.tangential_force, order, from, to),
          integral(fx, order, from, to), integral(fy, order, from, to)};
}

}  // namespace vibratory_alignment
