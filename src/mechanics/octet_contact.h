// What the equations of motion are made of at eight states at once: the forces without contacts, and a contact's place
// (mechanics/contact_frame.h) with the sliding acceleration that velocities alone cause.
#pragma once

#include "mechanics/contact_frame.h"
#include "mechanics/octet_forces.h"
#include "mechanics/tilt.h"

namespace vibratory_alignment {

struct Vec2Octet {
  Octet x, y;
};

VIBRATORY_ALIGNMENT_INLINE Octet cross(const Vec2Octet& a, const Vec2Octet& b) { return a.x * b.y - a.y * b.x; }

/// tilt_of(): its series where all tilts are small.
VIBRATORY_ALIGNMENT_INLINE void tilts_of(const Octet& phi, Octet& cos, Octet& sin) {
  if (!(largest(abs(phi)) <= kSmallTilt)) {
    for (std::size_t i = 0; i < Octet::kSize; ++i) {
      const Tilt tilt = tilt_of(phi[i]);
      cos[i] = tilt.cos;
      sin[i] = tilt.sin;
    }
    return;
  }
  const Octet z = phi * phi;
  const auto [even, odd] = small_tilt_series(z);
  cos = 1.0 - (0.5 * z - even);
  sin = phi - phi * odd;
}

/// Forces and moment of excitations, gripper and weight.
VIBRATORY_ALIGNMENT_INLINE LoadOctet free_load(const System& system, const StateOctet& q, const LoadOctet& drive) {
  return {drive.x - system.x.damping * q.vx - system.x.stiffness * (q.x - system.x.anchor),
          drive.y - system.y.damping * q.vy - system.y.stiffness * (q.y - system.y.anchor) - system.weight,
          drive.phi - system.phi.damping * q.omega - system.phi.stiffness * (q.phi - system.phi.anchor)};
}

/// As ContactKinematics.
struct ContactOctet {
  Vec2Octet normal, tangent, lever;
  Octet depth, depth_rate, slip_velocity;
};

VIBRATORY_ALIGNMENT_INLINE ContactOctet contact_octet(const System& system, const StateOctet& q, Site site, Face face,
                                                      const Octet& c, const Octet& s) {
  const ContactFrame frame = contact_frame(system, face);
  Vec2Octet point, lever, n;
  if (is_part_face(face)) {
    lever = {side_of(site) * system.slot_half_width - q.x, -q.y};
    point = {lever.x * c + lever.y * s, lever.y * c - lever.x * s};
    n = {frame.n1 * c - frame.n2 * s, frame.n1 * s + frame.n2 * c};
  } else {
    const double beta = side_of(site) * system.half_width, b = system.base_distance;
    point = {q.x + beta * c + b * s, q.y + beta * s - b * c};
    lever = {point.x - q.x, point.y - q.y};
    n = {frame.n1, frame.n2};
  }
  const Vec2Octet t = {n.y, -n.x}, v = {q.vx - q.omega * lever.y, q.vy + q.omega * lever.x};
  return {n,
          t,
          lever,
          frame.sign * (frame.n1 * point.x + frame.n2 * point.y) + frame.offset,
          -(v.x * n.x + v.y * n.y),
          v.x * t.x + v.y * t.y};
}

/// N = k d + h d', not cut off at zero.
VIBRATORY_ALIGNMENT_INLINE Octet normal_force_of(const System& system, const ContactOctet& contact, Face face,
                                                 const Octet& c, const Octet& s) {
  return along_normal(face, c, s, system.stiffness_x, system.stiffness_y) * contact.depth +
         along_normal(face, c, s, system.damping_x, system.damping_y) * contact.depth_rate;
}

/// V' that the velocities alone cause.
VIBRATORY_ALIGNMENT_INLINE Octet slip_rate_of(const StateOctet& q, const ContactOctet& contact, Face face) {
  const Vec2Octet &t = contact.tangent, &lever = contact.lever;
  if (!is_part_face(face)) return q.omega * (-q.omega * lever.y * t.y - q.omega * lever.x * t.x);
  const Vec2Octet t_rate = {-q.omega * t.y, q.omega * t.x};
  return q.vx * t_rate.x + q.vy * t_rate.y +
         q.omega * (-q.vx * t.y + q.vy * t.x + lever.x * t_rate.y - lever.y * t_rate.x);
}

}  // namespace vibratory_alignment
