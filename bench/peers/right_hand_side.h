// The problem that every peer integrates: a part in its gripper, the slot's edges a1 and a2 against its bottom and
// sides.
//
//      x'' + h_x x' + k_x (x - x_a)               = e_x(t)     + sum of (N n + T t)_x
//      y'' + h_y y' + (y - y_a)                   = e_y(t) - w + sum of (N n + T t)_y
//   mu phi'' + h_phi phi' + k_phi (phi - phi_a)   = e_phi(t)   + sum of r x (N n + T t)
//
//   part: centre C = (x, y), tilt phi counter-clockwise, half width a, bottom face at distance b
//         e1 = (cos phi, sin phi), e2 = (-sin phi, cos phi)
//   base: edges A1 = (l, 0), A2 = (-l, 0); an edge seen from the part: (u, w) = ((A - C).e1, (A - C).e2)
//   bottom face  d = w + b, n =  e2       right side  d = a - u, n = -e1       left side  d = a + u, n = e1
//   r = A - C, v_p = velocity of the part's material point at A, d' = -v_p.n, V = v_p.t, t = (n_y, -n_x)
//   N = k(n) d + h(n) d' while the base is loaded, k(n) = C1 n_y^2 + C2 n_x^2, h(n) alike;  T = -f N tanh(V / eps)
//
// A mode says on which face each edge is and whether it presses. Within a mode all of this is smooth: contact_mode.h
// has the events that end one. Dimensionless: mass 1, axial stiffness 1.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace vibratory_alignment::peers {

using State = std::array<double, 6>;  // x, y, phi, x', y', phi'

enum Axis { axis_x, axis_y, axis_phi };

// A force on `axis` (a moment for axis_phi): amplitude sin(frequency t + phase).
struct Excitation {
  Axis axis = axis_y;
  double amplitude = 0.0, frequency = 0.0, phase = 0.0;
};

struct Parameters {
  double a = 0.0, b = 0.0, l = 0.0;  // half width and height of the part's centre, half width of the slot
  double mu = 0.0;                   // inertia
  double k_x = 0.0, k_phi = 0.0;
  double h_x = 0.0, h_y = 0.0, h_phi = 0.0;
  double x_a = 0.0, y_a = 0.0, phi_a = 0.0;  // where the gripper's springs are unstretched
  double weight = 0.0;
  double c1 = 0.0, c2 = 0.0, h1 = 0.0, h2 = 0.0;  // base: C1, H1 vertical, C2, H2 horizontal
  double f = 0.0, eps = 0.0;                      // friction; eps = 0 means dry, for the peers that know it
  std::array<Excitation, 3> excitations;
  int excitation_count = 0;
};

enum class Face { none, bottom, right, left };

struct EdgeMode {
  Face face = Face::none;
  bool loaded = false;  // N = k d + h d', else 0
};

using Mode = std::array<EdgeMode, 2>;  // a1, a2

struct Vec2 {
  double x, y;
};

// Cosine and sine of the tilt, shared by both edges.
struct Tilt {
  explicit Tilt(double phi) : cos(std::cos(phi)), sin(std::sin(phi)) {}
  double cos, sin;
};

// A - C for edge 0 (a1) or 1 (a2).
inline Vec2 lever(const Parameters& p, const double* s, int edge) { return {(edge == 0 ? p.l : -p.l) - s[0], -s[1]}; }

struct Contact {
  Vec2 normal, tangent, lever;
  double depth, push;         // push = k(n) d + h(n) d'
  double stiffness, damping;  // k(n), h(n)
  double slip_velocity;       // V
};

inline Contact contact_at(const Parameters& p, const double* s, const Tilt& tilt, int edge, Face face) {
  Contact c;
  c.lever = lever(p, s, edge);
  if (face == Face::bottom) {
    c.normal = {-tilt.sin, tilt.cos};
    c.depth = p.b;
  } else {
    const double side = face == Face::right ? -1.0 : 1.0;
    c.normal = {side * tilt.cos, side * tilt.sin};
    c.depth = p.a;
  }
  c.tangent = {c.normal.y, -c.normal.x};
  c.depth += c.lever.x * c.normal.x + c.lever.y * c.normal.y;
  const Vec2 velocity{s[3] - s[5] * c.lever.y, s[4] + s[5] * c.lever.x};
  const double nx2 = c.normal.x * c.normal.x, ny2 = c.normal.y * c.normal.y;
  c.stiffness = p.c1 * ny2 + p.c2 * nx2;
  c.damping = p.h1 * ny2 + p.h2 * nx2;
  c.push = c.stiffness * c.depth - c.damping * (velocity.x * c.normal.x + velocity.y * c.normal.y);
  c.slip_velocity = velocity.x * c.tangent.x + velocity.y * c.tangent.y;
  return c;
}

// Two forces and a moment about C.
struct Load {
  double x = 0.0, y = 0.0, moment = 0.0;
};

// What the base does to the part.
inline Load contact_load(const Parameters& p, const Mode& mode, const double* s) {
  Load load;
  if (!mode[0].loaded && !mode[1].loaded) return load;
  const Tilt tilt(s[2]);
  for (int edge = 0; edge < 2; ++edge) {
    const EdgeMode& m = mode[static_cast<std::size_t>(edge)];
    if (!m.loaded) continue;
    const Contact c = contact_at(p, s, tilt, edge, m.face);
    const double friction = p.f == 0.0 ? 0.0 : -p.f * c.push * std::tanh(c.slip_velocity / p.eps);
    const Vec2 force{c.push * c.normal.x + friction * c.tangent.x, c.push * c.normal.y + friction * c.tangent.y};
    load.x += force.x;
    load.y += force.y;
    load.moment += c.lever.x * force.y - c.lever.y * force.x;
  }
  return load;
}

inline void add_excitations(const Parameters& p, double t, Load& load) {
  for (int i = 0; i < p.excitation_count; ++i) {
    const Excitation& e = p.excitations[static_cast<std::size_t>(i)];
    const double value = e.amplitude * std::sin(e.frequency * t + e.phase);
    (e.axis == axis_x ? load.x : e.axis == axis_y ? load.y : load.moment) += value;
  }
}

inline void right_hand_side(const Parameters& p, const Mode& mode, double t, const double* s, double* rate) {
  Load load = contact_load(p, mode, s);
  add_excitations(p, t, load);
  rate[0] = s[3];
  rate[1] = s[4];
  rate[2] = s[5];
  rate[3] = load.x - p.h_x * s[3] - p.k_x * (s[0] - p.x_a);
  rate[4] = load.y - p.h_y * s[4] - (s[1] - p.y_a) - p.weight;
  rate[5] = (load.moment - p.h_phi * s[5] - p.k_phi * (s[2] - p.phi_a)) / p.mu;
}

}  // namespace vibratory_alignment::peers
