// Directions and depths of a contact (MODEL.md "Contact").
//
// Edges a1, a2 touch faces of the part: their normal is fixed to the part and all is written in body axes e1, e2,
// from the edge's body coordinates (u, w) = ((A - C).e1, (A - C).e2). Corners touch faces of the base: world axes,
// from the corner's position B. With P for (u, w) or B and s = +1 for edges, -1 for corners
//     d = s n.P + offset,    V = -s (t.P)',    t = n turned by -90 degrees = (n_2, -n_1).
#pragma once

#include <cmath>

#include "mechanics/contact.h"
#include "mechanics/quad.h"
#include "mechanics/state.h"
#include "mechanics/system.h"

namespace vibratory_alignment {

struct Vec2 {
  double x = 0.0, y = 0.0;
};

/// a x b out of the plane; of a lever and a force: the moment, counter-clockwise.
inline double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

/// What a force of one along `direction`, a unit vector, adds to the acceleration along it of the point of the part at
/// which it acts. `lever`: its moment about the mass centre.
inline double mobility_along(const System& system, const Vec2& direction, double lever) {
  return direction.x * direction.x * system.x.inverse_inertia + direction.y * direction.y * system.y.inverse_inertia +
         lever * lever * system.phi.inverse_inertia;
}

inline bool is_edge(Site site) { return site == Site::a1 || site == Site::a2; }

/// +1 for the right one of a pair (a1, b1), -1 for the left one.
inline double side_of(Site site) { return site == Site::a1 || site == Site::b1 || site == Site::b1_floor ? 1.0 : -1.0; }

/// Index of the point within its pair: 0 right, 1 left.
inline int pair_index(Site site) { return side_of(site) > 0.0 ? 0 : 1; }

struct ContactFrame {
  double n1 = 0.0, n2 = 1.0;  ///< n in body axes (edges) or world axes (corners)
  double sign = 1.0;          ///< s
  double offset = 0.0;

  double t1() const { return n2; }
  double t2() const { return -n1; }
  double depth(double p1, double p2) const { return sign * (n1 * p1 + n2 * p2) + offset; }
};

/// Faces of the part, whose normal turns with it; the others are faces of the base.
inline bool is_part_face(Face face) {
  return face == Face::bottom || face == Face::right_side || face == Face::left_side;
}

/// Frame of a face of the part (for edges) or of the base (for corners).
ContactFrame contact_frame(const System& system, Face face);

/// Body coordinates (u, w) of an edge, or position B of a corner.
Vec2 site_point(const System& system, const State& state, Site site);

/// The same with cos and sin of the state's tilt known.
Vec2 site_point(const System& system, const State& state, Site site, double cos_phi, double sin_phi);

/// C1 n_y^2 + C2 n_x^2 and the like of a face, n in world axes: k(n) or h(n) from those across and along the slot.
template <typename Number>
VIBRATORY_ALIGNMENT_INLINE Number along_normal(Face face, const Number& cos_phi, const Number& sin_phi, double across,
                                               double along) {
  switch (face) {
    case Face::bottom: return along * cos_phi * cos_phi + across * sin_phi * sin_phi;
    case Face::right_side:
    case Face::left_side: return along * sin_phi * sin_phi + across * cos_phi * cos_phi;
    case Face::right_wall:
    case Face::left_wall: return across;
    default: return along;
  }
}

/// Base stiffness k(n) and damping h(n) seen by `face` at tilt phi.
double stiffness_of(const System& system, Face face, double cos_phi, double sin_phi);
double damping_of(const System& system, Face face, double cos_phi, double sin_phi);

/// Their derivatives by phi: 0 but for faces of the part.
double stiffness_slope_of(const System& system, Face face, double cos_phi, double sin_phi);
double damping_slope_of(const System& system, Face face, double cos_phi, double sin_phi);

/// A contact at one instant, in world axes.
struct ContactKinematics {
  Vec2 normal, tangent, lever;  ///< n, t, and r = contact point - C
  double depth = 0.0;           ///< d
  double depth_rate = 0.0;      ///< d' = -v_p.n
  double slip_velocity = 0.0;   ///< V = v_p.t
  double slip_rate = 0.0;       ///< V' that the velocities alone cause (accelerations zero)
};
ContactKinematics contact_kinematics(const System& system, const State& state, Site site, Face face);

/// The same with the site's point (site_point()) and cos and sin of the tilt known.
ContactKinematics contact_kinematics(const System& system, const State& state, Site site, Face face, const Vec2& point,
                                     double cos_phi, double sin_phi);

}  // namespace vibratory_alignment
