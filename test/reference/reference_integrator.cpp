// The reference integrator's method.
//
// A mode says for each contact candidate (edges A1, A2, corners B1, B2) on which face it is, whether the base is loaded
// (N > 0) and whether it slips forward, backward or sticks. Within a mode the right-hand side is smooth.
//   1. Gauss-Legendre collocation, 6 stages, order 12; stage equations solved by fixed-point iteration to roundoff.
//   2. Each mode has guards, functions of the state that are positive while the mode lasts. They are looked at in
//      the 6 stages and at the end of every step; the step is shortened until only its end lies behind an event.
//   3. The event is then located by bisection in the length of the step, each trial a whole step from the same start.
//   4. The transition is a pure function of the state at the event; integration restarts there.
// Contacts at V = 0 choose between stick and slip by trying every combination for consistency.
#include "reference_integrator.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace vibratory_alignment::reference {
namespace {

constexpr int stage_count = 6;
constexpr Real started_on_guard = 1.0e-16L;  // a guard this near zero at a mode's start belongs to the event just had
constexpr Real guard_noise = 1.0e-17L;       // and must then be this far below zero to be an event again
constexpr Real standstill = 1.0e-15L;        // |V| below this counts as V = 0 when a law begins

using Vec = std::array<Real, 6>;  // x, y, phi, x', y', phi'

struct Plane {
  Real x, y;
};
Real dot(Plane p, Plane q) { return p.x * q.x + p.y * q.y; }
Real cross(Plane p, Plane q) { return p.x * q.y - p.y * q.x; }
Plane turned(Plane p) { return {-p.y, p.x}; }  // by +90 degrees

bool isEdge(int candidate) { return candidate < candidate_b1; }
bool isContact(Face face) { return face != Face::none && face != Face::below; }

// ---------------------------------------------------------------------------------------------- mode

struct ContactMode {
  Face face = Face::none;
  bool loaded = false;
  int slip = 0;  // +1, -1: sign of V; 0: sticks (dry friction only)
};
using Mode = std::array<ContactMode, candidate_count>;

// ---------------------------------------------------------------------------------------------- contact geometry

// Where an edge lies seen from the part: along the bottom face, above it, and the depths below the three faces.
struct EdgePlace {
  Real along, depth_bottom, depth_right, depth_left;
  Real inside() const { return std::min(depth_bottom, std::min(depth_right, depth_left)); }
  Face nearestFace() const {
    if (depth_bottom <= depth_right && depth_bottom <= depth_left) return Face::bottom;
    return depth_right <= depth_left ? Face::right_side : Face::left_side;
  }
};

EdgePlace edgePlace(const ReferenceParameters& p, const Vec& s, int candidate) {
  const Plane e1{std::cos(s[2]), std::sin(s[2])}, e2 = turned(e1);
  const Plane r{(candidate == candidate_a1 ? p.l : -p.l) - s[0], -s[1]};
  const Real along = dot(r, e1);
  return {along, p.b + dot(r, e2), p.a - along, p.a + along};
}

Plane cornerPosition(const ReferenceParameters& p, const Vec& s, int candidate) {
  const Plane e1{std::cos(s[2]), std::sin(s[2])}, e2 = turned(e1);
  const Real side = candidate == candidate_b1 ? p.a : -p.a;
  return {s[0] + side * e1.x - p.b * e2.x, s[1] + side * e1.y - p.b * e2.y};
}

// Everything about one contact that follows from the state.
struct Contact {
  Real depth, end;        // depth; how far the foot is from the end of its face
  Real push;              // k(n) d + h(n) d', N is its positive part
  Plane n, t;             // normal and tangent
  Real lever_n, lever_t;  // r x n, r x t
  Real v;                 // V = v_p . t
  Real v_drift;           // V' = t . C'' + lever_t phi'' + v_drift
};

Contact contactAt(const ReferenceParameters& p, const Vec& s, int candidate, Face face) {
  const Plane e1{std::cos(s[2]), std::sin(s[2])}, e2 = turned(e1);
  const Plane velocity{s[3], s[4]};
  const Real omega = s[5];
  Contact c{};
  Plane r{};
  if (isEdge(candidate)) {
    // The contact point is the edge; the normal turns with the part.
    const EdgePlace place = edgePlace(p, s, candidate);
    r = {(candidate == candidate_a1 ? p.l : -p.l) - s[0], -s[1]};
    if (face == Face::bottom) {
      c.depth = place.depth_bottom;
      c.end = p.a - std::abs(place.along);
      c.n = e2;
    } else {
      const bool right = face == Face::right_side;
      c.depth = right ? place.depth_right : place.depth_left;
      c.end = place.depth_bottom;
      c.n = right ? Plane{-e1.x, -e1.y} : e1;
    }
  } else {
    // The contact point is the corner; the normal stands still.
    const Plane corner = cornerPosition(p, s, candidate);
    r = {corner.x - s[0], corner.y - s[1]};
    c.depth = -corner.y;
    c.end = std::abs(corner.x) - p.l;
    c.n = {0.0L, 1.0L};
  }
  c.t = {c.n.y, -c.n.x};
  c.lever_n = cross(r, c.n);
  c.lever_t = cross(r, c.t);
  const Real rate = -(dot(velocity, c.n) + omega * c.lever_n);
  c.v = dot(velocity, c.t) + omega * c.lever_t;
  // Edge: t' = phi' turned(t), r' = -C'. Corner: t' = 0, r' = phi' turned(r).
  c.v_drift = isEdge(candidate) ? 2.0L * omega * dot(velocity, turned(c.t)) + omega * omega * dot(r, c.t)
                                : -omega * omega * dot(r, c.t);
  const Real nx2 = c.n.x * c.n.x, ny2 = c.n.y * c.n.y;
  c.push = (p.c1 * ny2 + p.c2 * nx2) * c.depth + (p.h1 * ny2 + p.h2 * nx2) * rate;
  return c;
}

// ---------------------------------------------------------------------------------------------- right-hand side

struct Evaluation {
  Vec derivative{};
  std::array<Contact, candidate_count> contact{};
  std::array<Real, candidate_count> normal{}, tangential{}, v_rate{};  // N, T, V'
  bool unique = true;  // false: the forces of several sticking contacts are not determined
};

Real value(const Sine& e, Real t) {
  return e.amplitude == 0.0L ? 0.0L : e.amplitude * std::sin(e.frequency * t + e.phase);
}

// Solves m z = z for the first n rows by elimination with row exchange; false where m is singular.
bool solve(std::array<std::array<Real, candidate_count>, candidate_count> m, std::array<Real, candidate_count>& z,
           std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t pivot = i;
    for (std::size_t j = i + 1; j < n; ++j)
      if (std::abs(m[j][i]) > std::abs(m[pivot][i])) pivot = j;
    if (std::abs(m[pivot][i]) < 1.0e-14L) return false;
    std::swap(m[i], m[pivot]);
    std::swap(z[i], z[pivot]);
    for (std::size_t j = i + 1; j < n; ++j) {
      const Real q = m[j][i] / m[i][i];
      for (std::size_t k = i; k < n; ++k) m[j][k] -= q * m[i][k];
      z[j] -= q * z[i];
    }
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) z[i] -= m[i][k] * z[k];
    z[i] /= m[i][i];
  }
  return true;
}

Evaluation evaluate(const ReferenceParameters& p, const Mode& mode, Real t, const Vec& s) {
  Evaluation e;
  Real fx = value(p.excitation_x, t) - p.h_x * s[3] - p.k_x * (s[0] - p.x_a);
  Real fy = value(p.excitation_y, t) - p.h_y * s[4] - (s[1] - p.y_a) - p.weight;
  Real moment = value(p.excitation_phi, t) - p.h_phi * s[5] - p.k_phi * (s[2] - p.phi_a);

  // Normal forces, and friction where it is known: they follow from the state.
  std::array<int, candidate_count> sticking{};
  std::size_t sticking_count = 0;
  for (int i = 0; i < candidate_count; ++i) {
    const std::size_t u = static_cast<std::size_t>(i);
    if (!isContact(mode[u].face)) continue;
    const Contact c = e.contact[u] = contactAt(p, s, i, mode[u].face);
    if (!mode[u].loaded) continue;
    e.normal[u] = c.push;
    if (p.f > 0.0L && p.eps == 0.0L && mode[u].slip == 0) {
      sticking[sticking_count++] = i;
    } else if (p.f > 0.0L) {
      const Real sign = p.eps > 0.0L ? std::tanh(c.v / p.eps) : static_cast<Real>(mode[u].slip);
      e.tangential[u] = -p.f * c.push * sign;
    }
    fx += e.normal[u] * c.n.x + e.tangential[u] * c.t.x;
    fy += e.normal[u] * c.n.y + e.tangential[u] * c.t.y;
    moment += e.normal[u] * c.lever_n + e.tangential[u] * c.lever_t;
  }

  // Sticking contacts: the T that keep every V' = 0.
  if (sticking_count > 0) {
    std::array<std::array<Real, candidate_count>, candidate_count> m{};
    std::array<Real, candidate_count> z{};
    for (std::size_t i = 0; i < sticking_count; ++i) {
      const Contact& ci = e.contact[static_cast<std::size_t>(sticking[i])];
      z[i] = -(ci.t.x * fx + ci.t.y * fy + ci.lever_t * moment / p.mu + ci.v_drift);
      for (std::size_t j = 0; j < sticking_count; ++j) {
        const Contact& cj = e.contact[static_cast<std::size_t>(sticking[j])];
        m[i][j] = dot(ci.t, cj.t) + ci.lever_t * cj.lever_t / p.mu;
      }
    }
    e.unique = solve(m, z, sticking_count);
    for (std::size_t i = 0; e.unique && i < sticking_count; ++i) {
      const std::size_t u = static_cast<std::size_t>(sticking[i]);
      e.tangential[u] = z[i];
      fx += z[i] * e.contact[u].t.x;
      fy += z[i] * e.contact[u].t.y;
      moment += z[i] * e.contact[u].lever_t;
    }
  }

  e.derivative = {s[3], s[4], s[5], fx, fy, moment / p.mu};
  for (std::size_t u = 0; u < candidate_count; ++u)
    if (isContact(mode[u].face)) {
      const Contact& c = e.contact[u];
      e.v_rate[u] = c.t.x * fx + c.t.y * fy + c.lever_t * moment / p.mu + c.v_drift;
    }
  return e;
}

// ---------------------------------------------------------------------------------------------- collocation

// Gauss-Legendre nodes c, weights b and matrix a, computed rather than copied.
struct Gauss {
  std::array<Real, stage_count> c{}, b{};
  std::array<std::array<Real, stage_count>, stage_count> a{};

  Gauss() {
    constexpr std::size_t n = stage_count;
    const Real pi = std::acos(-1.0L);
    for (std::size_t i = 0; i < n; ++i) {
      // Newton on the Legendre polynomial, from the usual first guess.
      Real z = -std::cos(pi * (static_cast<Real>(i) + 0.75L) / (static_cast<Real>(n) + 0.5L)), slope = 1.0L;
      for (int iteration = 0; iteration < 20; ++iteration) {
        Real p0 = 1.0L, p1 = z;
        for (std::size_t k = 2; k <= n; ++k) {
          const Real q = static_cast<Real>(k), p2 = ((2.0L * q - 1.0L) * z * p1 - (q - 1.0L) * p0) / q;
          p0 = p1;
          p1 = p2;
        }
        slope = static_cast<Real>(n) * (z * p1 - p0) / (z * z - 1.0L);
        z -= p1 / slope;
      }
      c[i] = 0.5L * (1.0L + z);
      b[i] = 1.0L / ((1.0L - z * z) * slope * slope);
    }
    // a_ij = integral of the Lagrange polynomial L_j from 0 to c_i; the quadrature is exact for it.
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t k = 0; k < n; ++k) {
          Real lagrange = 1.0L;
          for (std::size_t m = 0; m < n; ++m)
            if (m != j) lagrange *= (c[i] * c[k] - c[m]) / (c[j] - c[m]);
          a[i][j] += c[i] * b[k] * lagrange;
        }
  }
};

struct Step {
  bool converged = false;
  Vec end{};
  std::array<Vec, stage_count> stage{};
};

// ---------------------------------------------------------------------------------------------- guards

struct Guard {
  EventKind kind;
  int candidate;
  Real value;  // positive while the mode lasts
};

// The guards of a mode always come in the same order.
std::vector<Guard> guardsOf(const ReferenceParameters& p, const Mode& mode, Real t, const Vec& s) {
  std::vector<Guard> guards;
  const Evaluation e = evaluate(p, mode, t, s);
  for (int i = 0; i < candidate_count; ++i) {
    const std::size_t u = static_cast<std::size_t>(i);
    const ContactMode& m = mode[u];
    if (isEdge(i) ? !p.edges : !p.corners) continue;
    if (m.face == Face::none) {
      guards.push_back({EventKind::touch, i, isEdge(i) ? -edgePlace(p, s, i).inside() : cornerPosition(p, s, i).y});
    } else if (m.face == Face::below) {
      guards.push_back({EventKind::leave_slot, i, -cornerPosition(p, s, i).y});
    } else {
      const Contact& c = e.contact[u];
      guards.push_back({EventKind::close, i, c.depth});
      guards.push_back({EventKind::run_off, i, c.end});
      guards.push_back({m.loaded ? EventKind::unload : EventKind::reload, i, m.loaded ? c.push : -c.push});
      if (!m.loaded || p.f == 0.0L || p.eps > 0.0L) continue;
      if (m.slip != 0) {
        guards.push_back({EventKind::stick, i, static_cast<Real>(m.slip) * c.v});
      } else {
        // T = +f N drives V below zero, T = -f N above.
        guards.push_back({EventKind::slip_minus, i, p.f * e.normal[u] - e.tangential[u]});
        guards.push_back({EventKind::slip_plus, i, p.f * e.normal[u] + e.tangential[u]});
      }
    }
  }
  return guards;
}

bool fired(const Guard& now, const Guard& at_start) {
  return at_start.value < started_on_guard ? now.value < -guard_noise : now.value <= 0.0L;
}

bool anyFired(const std::vector<Guard>& now, const std::vector<Guard>& at_start) {
  for (std::size_t i = 0; i < now.size(); ++i)
    if (fired(now[i], at_start[i])) return true;
  return false;
}

// ---------------------------------------------------------------------------------------------- the run

class Run {
 public:
  Run(const ReferenceParameters& parameters, const ReferenceState& start) : p_(parameters) {
    state_ = {start.x, start.y, start.phi, start.vx, start.vy, start.omega};
    startMode();
  }

  ReferenceResult go(Real t_end, Real max_step) {
    while (time_ < t_end) {
      // Equal steps to the end, so that no sliver is left over.
      const Real left = t_end - time_;
      advance(left / std::max(1.0L, std::ceil(left / max_step - 1.0e-9L)), t_end);
    }
    result_.time = time_;
    result_.state = {state_[0], state_[1], state_[2], state_[3], state_[4], state_[5]};
    return result_;
  }

 private:
  // One collocation step of length h; the stages are iterated until they stop changing.
  Step step(Real h) {
    static const Gauss gauss;
    Step result;
    std::array<Vec, stage_count> slope;
    slope.fill(derivative(time_, state_));
    Real previous = 1.0L;
    for (int iteration = 0; iteration < 200; ++iteration) {
      Real change = 0.0L;
      for (std::size_t i = 0; i < stage_count; ++i) {
        Vec next = state_;
        for (std::size_t q = 0; q < 6; ++q) {
          Real sum = 0.0L;
          for (std::size_t j = 0; j < stage_count; ++j) sum += gauss.a[i][j] * slope[j][q];
          next[q] += h * sum;
          change = std::max(change, std::abs(next[q] - result.stage[i][q]));
        }
        result.stage[i] = next;
      }
      for (std::size_t i = 0; i < stage_count; ++i) slope[i] = derivative(time_ + gauss.c[i] * h, result.stage[i]);
      if (!std::isfinite(change)) return result;
      // Roundoff reached: nothing changes, or the changes are tiny and no longer shrink.
      result.converged = change == 0.0L || (change < 1.0e-16L && iteration > 3 && change >= previous);
      if (result.converged) break;
      previous = change;
    }
    result.end = state_;
    for (std::size_t q = 0; q < 6; ++q) {
      Real sum = 0.0L;
      for (std::size_t j = 0; j < stage_count; ++j) sum += gauss.b[j] * slope[j][q];
      result.end[q] += h * sum;
    }
    return result;
  }

  Vec derivative(Real t, const Vec& s) {
    ++result_.evaluations;
    const Evaluation e = evaluate(p_, mode_, t, s);
    if (!e.unique) fail("the friction of several sticking contacts is not determined");
    return e.derivative;
  }

  // One accepted step of at most h, to the first event at the latest.
  void advance(Real h, Real t_end) {
    static const Gauss gauss;
    const bool to_the_end = h == t_end - time_;
    const Real h_asked = h;
    const std::vector<Guard> at_start = guardsOf(p_, mode_, time_, state_);
    Step trial;
    bool event = false;
    for (int attempt = 0;; ++attempt) {
      if (attempt > 4000 || h < 1.0e-25L) fail("no step found");
      trial = step(h);
      if (!trial.converged) {
        h *= 0.5L;
        continue;
      }
      // Shorten the step to the first stage behind an event, until no stage but perhaps the end is.
      std::size_t i = 0;
      while (i < stage_count && !anyFired(guardsOf(p_, mode_, time_ + gauss.c[i] * h, trial.stage[i]), at_start)) ++i;
      event = anyFired(guardsOf(p_, mode_, time_ + h, trial.end), at_start);
      if (i == stage_count) break;
      h *= gauss.c[i];
    }
    Real lasted = h;
    if (event) lasted = locate(gauss.c[stage_count - 1] * h, h, at_start, trial);
    recordForces(lasted, trial);

    // Durations for the record.
    bool contact = false, stuck = false;
    for (const ContactMode& m : mode_) {
      contact = contact || m.loaded;
      stuck = stuck || (m.loaded && m.slip == 0 && p_.f > 0.0L && p_.eps == 0.0L);
    }
    if (contact) result_.time_in_contact += lasted;
    if (stuck) result_.time_sticking += lasted;

    time_ = !event && to_the_end && lasted == h_asked ? t_end : time_ + lasted;
    const std::vector<Guard> now = guardsOf(p_, mode_, time_, trial.end);
    state_ = trial.end;
    ++result_.steps;
    if (event) {
      transition(now, at_start);
      if (result_.events.size() > 1000000) fail("events without end");
    }
  }

  // Bisection in the length of the step; `trial` becomes the step that ends just behind the event.
  Real locate(Real before, Real behind, const std::vector<Guard>& at_start, Step& trial) {
    // The stage said "before", a whole step must say so too.
    const auto behindEvent = [&](Real h, Step& s) {
      s = step(h);
      if (!s.converged) fail("a shorter step did not converge");
      return anyFired(guardsOf(p_, mode_, time_ + h, s.end), at_start);
    };
    Step s;
    if (behindEvent(before, s)) before = 0.0L;
    for (;;) {
      const Real middle = 0.5L * (before + behind);
      if (middle <= before || middle >= behind || behind - before < 2.0e-20L) break;
      if (behindEvent(middle, s)) {
        behind = middle;
        trial = s;
      } else {
        before = middle;
      }
    }
    return behind;
  }

  // Largest normal forces: at the ends of the step, and at a maximum inside it (golden section over the step length).
  void recordForces(Real h, const Step& trial) {
    const Evaluation first = evaluate(p_, mode_, time_, state_);
    const Evaluation last = evaluate(p_, mode_, time_ + h, trial.end);
    for (std::size_t u = 0; u < candidate_count; ++u) {
      if (!mode_[u].loaded) continue;
      Real& peak = result_.peak_force[u];
      peak = std::max(peak, std::max(first.normal[u], last.normal[u]));
      // A maximum lies inside where N rises at the start and falls at the end; search it if it may be the largest.
      const int candidate = static_cast<int>(u);
      Real highest = 0.0L;
      for (const Vec& s : trial.stage) highest = std::max(highest, contactAt(p_, s, candidate, mode_[u].face).push);
      if (highest < 0.99L * peak || normalRate(state_, first.derivative, u) <= 0.0L) continue;
      if (normalRate(trial.end, last.derivative, u) >= 0.0L) continue;
      const auto normalAfter = [&](Real g) { return evaluate(p_, mode_, time_ + g, step(g).end).normal[u]; };
      const Real ratio = 0.5L * (std::sqrt(5.0L) - 1.0L);
      Real low = 0.0L, high = h, g1 = high - ratio * (high - low), g2 = low + ratio * (high - low);
      Real n1 = normalAfter(g1), n2 = normalAfter(g2);
      while (high - low > 1.0e-9L * h) {
        if (n1 < n2) {
          low = g1;
          g1 = g2;
          n1 = n2;
          g2 = low + ratio * (high - low);
          n2 = normalAfter(g2);
        } else {
          high = g2;
          g2 = g1;
          n2 = n1;
          g1 = high - ratio * (high - low);
          n1 = normalAfter(g1);
        }
      }
      peak = std::max(peak, std::max(n1, n2));
    }
  }

  // Rate of N along the motion, by a central difference: only its sign is used.
  Real normalRate(const Vec& s, const Vec& slope, std::size_t u) const {
    constexpr Real dt = 1.0e-7L;
    Vec ahead = s, behind = s;
    for (std::size_t q = 0; q < 6; ++q) {
      ahead[q] += dt * slope[q];
      behind[q] -= dt * slope[q];
    }
    const int i = static_cast<int>(u);
    return contactAt(p_, ahead, i, mode_[u].face).push - contactAt(p_, behind, i, mode_[u].face).push;
  }

  // Which law holds next: pure function of the state, the mode and the guards that fired.
  void transition(const std::vector<Guard>& now, const std::vector<Guard>& at_start) {
    std::array<bool, candidate_count> reversed{}, broken{};
    for (std::size_t g = 0; g < now.size(); ++g) {
      if (!fired(now[g], at_start[g])) continue;
      const int i = now[g].candidate;
      const std::size_t u = static_cast<std::size_t>(i);
      ContactMode& m = mode_[u];
      const Face face_before = m.face;
      EventKind kind = now[g].kind;
      switch (kind) {
        case EventKind::touch:
          m = ContactMode{isEdge(i) ? edgePlace(p_, state_, i).nearestFace() : Face::top, true, 0};
          if (!isEdge(i) && std::abs(cornerPosition(p_, state_, i).x) < p_.l) {
            m = ContactMode{Face::below, false, 0};
            kind = EventKind::enter_slot;
          } else {
            ++result_.touches[u];
          }
          break;
        case EventKind::leave_slot: m = ContactMode{}; break;
        case EventKind::close: m = ContactMode{}; break;
        case EventKind::run_off:
          // With the depth closed in the same instant the contact has ended already.
          if (!isContact(m.face)) continue;
          m = ContactMode{isEdge(i) ? Face::none : Face::below, false, 0};
          break;
        case EventKind::unload:
        case EventKind::reload:
          if (!isContact(m.face)) continue;
          m.loaded = kind == EventKind::reload;
          break;
        case EventKind::stick:
          if (!m.loaded) continue;
          reversed[u] = true;
          continue;  // what it becomes is decided, and logged, below
        case EventKind::slip_plus:
        case EventKind::slip_minus:
          if (!m.loaded) continue;
          broken[u] = true;
          m.slip = kind == EventKind::slip_plus ? 1 : -1;
          continue;
        case EventKind::enter_slot: break;
      }
      log(kind, i, kind == EventKind::touch || kind == EventKind::enter_slot ? m.face : face_before);
    }
    decideFriction(reversed, broken, true);
  }

  // Stick or slip for every loaded contact that is at V = 0; the others slip as they move.
  void decideFriction(const std::array<bool, candidate_count>& reversed,
                      const std::array<bool, candidate_count>& broken, bool to_log) {
    if (p_.f == 0.0L || p_.eps > 0.0L) return;
    const Mode before = mode_;
    std::vector<std::size_t> open;
    for (std::size_t u = 0; u < candidate_count; ++u) {
      ContactMode& m = mode_[u];
      if (!m.loaded || broken[u]) continue;
      const Real v = contactAt(p_, state_, static_cast<int>(u), m.face).v;
      // A slip of 0 means "sticks" only where the contact was loaded before; on touching V decides.
      const bool held = stuck_[u];
      if (reversed[u] || held || std::abs(v) < standstill)
        open.push_back(u);
      else
        m.slip = v > 0.0L ? 1 : -1;
    }
    // Every combination of stick, slip + and slip -; the one that is consistent by the widest margin.
    int combinations = 1;
    for (std::size_t i = 0; i < open.size(); ++i) combinations *= 3;
    Mode best = mode_;
    Real best_margin = -1.0L;
    for (int number = 0; !open.empty() && number < combinations; ++number) {
      int rest = number;
      for (const std::size_t u : open) {
        mode_[u].slip = rest % 3 - 1;
        rest /= 3;
      }
      const Evaluation e = evaluate(p_, mode_, time_, state_);
      if (!e.unique) continue;
      Real margin = 1.0e30L;
      for (const std::size_t u : open) {
        // As accelerations: how far a stick is from breaking, how fast a slip leaves V = 0.
        const Contact& c = e.contact[u];
        const Real yield = dot(c.t, c.t) + c.lever_t * c.lever_t / p_.mu;
        const Real one = mode_[u].slip == 0 ? (p_.f * e.normal[u] - std::abs(e.tangential[u])) * yield
                                            : static_cast<Real>(mode_[u].slip) * e.v_rate[u];
        margin = std::min(margin, one);
      }
      if (margin > best_margin) {
        best_margin = margin;
        best = mode_;
      }
    }
    if (!open.empty() && best_margin < -1.0e-12L) fail("no consistent combination of stick and slip");
    mode_ = best;
    for (std::size_t u = 0; u < candidate_count; ++u) {
      const ContactMode& m = mode_[u];
      const bool stuck_now = m.loaded && m.slip == 0;
      const bool changed = reversed[u] || broken[u] || stuck_now != stuck_[u];
      if (to_log && m.loaded && changed && (stuck_now || stuck_[u] || before[u].slip != m.slip || broken[u]))
        log(m.slip == 0  ? EventKind::stick
            : m.slip > 0 ? EventKind::slip_plus
                         : EventKind::slip_minus,
            static_cast<int>(u), m.face);
      stuck_[u] = stuck_now;
    }
  }

  // The mode of the start: inside a face already counts as contact, through the nearest face.
  void startMode() {
    for (int i = 0; i < candidate_count; ++i) {
      ContactMode& m = mode_[static_cast<std::size_t>(i)];
      if (isEdge(i)) {
        const EdgePlace place = edgePlace(p_, state_, i);
        if (p_.edges && place.inside() > 0.0L) m.face = place.nearestFace();
      } else if (p_.corners) {
        const Plane corner = cornerPosition(p_, state_, i);
        if (corner.y < 0.0L) m.face = std::abs(corner.x) >= p_.l ? Face::top : Face::below;
      }
      if (isContact(m.face)) m.loaded = contactAt(p_, state_, i, m.face).push > 0.0L;
    }
    decideFriction({}, {}, false);
  }

  void log(EventKind kind, int candidate, Face face) { result_.events.push_back({time_, kind, candidate, face}); }

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error("reference integrator: " + what + " at t = " + std::to_string(time_));
  }

  const ReferenceParameters p_;
  Real time_ = 0.0L;
  Vec state_{};
  Mode mode_{};
  std::array<bool, candidate_count> stuck_{};
  ReferenceResult result_;
};

}  // namespace

int ReferenceResult::totalTouches() const {
  int sum = 0;
  for (const int n : touches) sum += n;
  return sum;
}

Real ReferenceResult::peakForce() const { return *std::max_element(peak_force.begin(), peak_force.end()); }

ReferenceResult integrate(const ReferenceParameters& parameters, const ReferenceState& start, Real t_end,
                          Real max_step) {
  const ReferenceParameters& p = parameters;
  if (!(p.a > 0.0L && p.b > 0.0L && p.mu > 0.0L && p.l > p.a && max_step > 0.0L && t_end >= 0.0L))
    throw std::invalid_argument("reference integrator: a, b, mu, l - a, max_step must be positive, t_end not negative");
  if (!(p.f >= 0.0L && p.eps >= 0.0L && p.c1 >= 0.0L && p.c2 >= 0.0L && p.h1 >= 0.0L && p.h2 >= 0.0L))
    throw std::invalid_argument("reference integrator: f, eps, c1, c2, h1 and h2 must not be negative");
  return Run(p, start).go(t_end, max_step);
}

}  // namespace vibratory_alignment::reference
