// Independent reference integrator: the second opinion that the project's solvers are compared with.
//
// It shares nothing with src/: own parameters, own mechanics, own method, `long double` throughout. It is made to be
// right rather than fast: Gauss-Legendre collocation with 6 stages (order 12) and one fixed largest step, every event
// located by repeating the step with another length (no interpolation) until the instant is known to roundoff.
// The method is described in reference_integrator.cpp and README.md, the cases with known answers in reference_cases.h.
//
// Equations (model description: "Free motion", "Contact", "Settled readings"; everything dimensionless, mass 1, k_y 1):
//
//   y up                    part: centre C = (x, y), tilt phi counter-clockwise, half width a, bottom at distance b
//    |    +-------+         e1 = (cos phi, sin phi), e2 = (-sin phi, cos phi)
//    |    |   C   |         lower corners B1 = C + a e1 - b e2, B2 = C - a e1 - b e2
//   -+-A2-+-   ---+-A1- x   base: top surface y = 0 for |x| >= l, edges A1 = (l, 0), A2 = (-l, 0)
//
//      x'' + h_x x' + k_x (x - x_a)           = e_x(t)     + sum of (N n + T t)_x
//      y'' + h_y y' + (y - y_a)               = e_y(t) - w + sum of (N n + T t)_y
//   mu phi'' + h_phi phi' + k_phi (phi - phi_a) = e_phi(t) + sum of r x (N n + T t)
//
// At a contact: r = point - C, d' = -v_p . n, N = max(0, k(n) d + h(n) d'), V = v_p . t, with v_p the velocity of the
// part's material point there, k(n) = C1 n_y^2 + C2 n_x^2, h(n) = H1 n_y^2 + H2 n_x^2, t = (n_y, -n_x).
//   edge on the bottom face   n =  e2      edge on the right side   n = -e1
//   corner on the top surface n = (0, 1)   edge on the left side    n = +e1
// Dry friction: T = -f N sgn V, or the T that keeps V' = 0 while |T| <= f N. Regularised: T = -f N tanh(V / eps).
#pragma once

#include <array>
#include <vector>

namespace vibratory_alignment::reference {

using Real = long double;

// amplitude * sin(frequency * t + phase), phase in radians.
struct Sine {
  Real amplitude = 0.0L;
  Real frequency = 0.0L;
  Real phase = 0.0L;
};

struct ReferenceParameters {
  // Part and slot.
  Real a = 0.0L;   // half width of the part
  Real b = 0.0L;   // distance of its bottom face from the mass centre
  Real mu = 0.0L;  // dimensionless inertia
  Real l = 0.0L;   // half width of the slot, a + clearance
  // Gripper: springs, dampers, where the springs are unstretched. The axial stiffness and the mass are 1.
  Real k_x = 0.0L, k_phi = 0.0L;
  Real h_x = 0.0L, h_y = 0.0L, h_phi = 0.0L;
  Real x_a = 0.0L, y_a = 0.0L, phi_a = 0.0L;
  Real weight = 0.0L;
  // Base: C1, H1 vertical, C2, H2 horizontal.
  Real c1 = 0.0L, c2 = 0.0L;
  Real h1 = 0.0L, h2 = 0.0L;
  // Friction coefficient; eps = 0 means dry (set valued) friction, eps > 0 replaces sgn V by tanh(V / eps).
  Real f = 0.0L;
  Real eps = 0.0L;
  // Force along x, force along y, moment about C.
  Sine excitation_x, excitation_y, excitation_phi;
  // Which contact features exist.
  bool edges = true;
  bool corners = false;
};

struct ReferenceState {
  Real x = 0.0L, y = 0.0L, phi = 0.0L;
  Real vx = 0.0L, vy = 0.0L, omega = 0.0L;
};

// Order of the contact candidates in every array below.
enum Candidate { candidate_a1, candidate_a2, candidate_b1, candidate_b2, candidate_count };

enum class EventKind {
  touch,       // depth crosses zero from outside
  unload,      // N falls to zero, the base is left with d > 0
  reload,      // N rises from zero again, d > 0
  close,       // depth crosses zero from inside
  run_off,     // the foot leaves the end of the face with d > 0
  stick,       // V reaches zero (or is zero when a law begins) and friction can hold it
  slip_plus,   // slipping with V > 0 begins, out of V = 0
  slip_minus,  // slipping with V < 0 begins, out of V = 0
  enter_slot,  // a corner passes y = 0 between the edges: it touches nothing
  leave_slot   // and comes back above y = 0
};

// What the candidate is in after the event.
enum class Face { none, bottom, right_side, left_side, top, below };

struct ReferenceEvent {
  Real time;
  EventKind kind;
  int candidate;  // a Candidate
  Face face;      // face that the event concerns
};

struct ReferenceResult {
  Real time = 0.0L;
  ReferenceState state;
  std::array<int, candidate_count> touches{};      // contacts begun out of flight; one the start lies in is none
  std::array<Real, candidate_count> peak_force{};  // largest N of each candidate, located in time
  std::vector<ReferenceEvent> events;              // in order; those at t = 0 are left out
  Real time_in_contact = 0.0L;                     // how long any N > 0
  Real time_sticking = 0.0L;                       // how long any contact stuck
  long steps = 0;                                  // accepted steps
  long evaluations = 0;                            // right-hand sides, repeated steps included

  int totalTouches() const;
  Real peakForce() const;
};

// Integrates from t = 0 to t_end with steps of at most max_step between events.
// max_step must be so small that no guard crosses zero twice between two of the 7 points looked at in each step.
// Throws std::invalid_argument for impossible parameters and std::runtime_error where the method does not reach:
// a stage iteration that does not converge, a friction problem without a unique answer, events without end.
ReferenceResult integrate(const ReferenceParameters& parameters, const ReferenceState& start, Real t_end,
                          Real max_step);

}  // namespace vibratory_alignment::reference
