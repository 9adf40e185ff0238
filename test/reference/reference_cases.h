// Cases with known answers: parameters, start, end time and the converged state there.
//
// Where the numbers come from: `end` was computed by a second method in __float128 (extrapolation of the modified
// midpoint rule, Gragg-Bulirsch-Stoer with 9 columns, events by bisection to 1e-26, contact forces from numerical
// differentiation of the depth and of the slip) and agrees with integrate() of reference_integrator.h. All decimal
// values below are meant exactly as printed; a solver in double starts from rounded ones, and `amplification` says
// how much of that to expect at the end. Digits past the 17th are there so that nobody has to ask about the 16th.
//
// `agreement` is the largest absolute difference between any two of: integrate() with max_step, with max_step / 2, and
// the __float128 values. `peak_force` comes from integrate() alone (two step sizes agree to 1e-14).
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "reference_integrator.h"

namespace vibratory_alignment::reference {

struct ReferenceCase {
  std::string name;
  ReferenceParameters parameters;
  ReferenceState start;
  Real end_time = 0.0L;
  Real max_step = 0.0L;       // step with which integrate() reaches the agreement
  ReferenceState end;         // the answer
  Real agreement = 0.0L;      // see above
  Real amplification = 0.0L;  // largest |change of an end value / change of a start value|, by differences
  std::array<int, candidate_count> touches{};      // A1, A2, B1, B2, after the initial contact
  std::array<Real, candidate_count> peak_force{};  // largest normal force of each
  int events = 0;                                  // all that integrate() logs, friction included
};

// R1: one edge, vertical excitation, impacts on A1 only; tanh friction. 15 touches.
// The __float128 values at max_step 1e-4 and 5e-5 agree to 2e-20, and with the published 16 digits in every digit.
// The anchor y_a is set from the loaded height, not from y_touch.
inline ReferenceCase caseR1Regularised() {
  ReferenceCase c;
  c.name = "r1_regularised";
  ReferenceParameters& p = c.parameters;
  p.a = 0.7L;
  p.b = 0.9L;
  p.mu = 0.3L;
  p.l = 0.79L;
  p.k_x = 0.05L;
  p.k_phi = 60.0L;
  p.h_x = p.h_y = p.h_phi = 0.05L;
  p.c1 = p.c2 = 2500.0L;
  p.h1 = p.h2 = 20.0L;
  p.f = 0.2L;
  p.eps = 2.0e-3L;
  p.excitation_y = {1.0L, 20.0L, 0.0L};
  const Real f0 = 0.2L, depth = f0 / p.c1;
  c.start.x = p.x_a = 0.2L;
  c.start.phi = f0 * (p.l - c.start.x) / p.k_phi;
  c.start.y = (p.b - depth - (p.l - c.start.x) * std::sin(c.start.phi)) / std::cos(c.start.phi);
  p.y_a = c.start.y - f0;
  c.end_time = 5.0L;
  c.max_step = 1.0e-4L;
  c.end.x = 0.12099488446620299147L;
  c.end.y = 0.90464298892498888642L;
  c.end.phi = 1.3668650288823522792e-4L;
  c.end.vx = -0.017180591088593584558L;
  c.end.vy = -0.064815161470456974655L;
  c.end.omega = -0.082252387392653536589L;
  c.agreement = 3.0e-16L;
  c.amplification = 120.0L;
  c.touches = {15, 0, 0, 0};
  c.peak_force = {3.2514128415754817L, 0.0L, 0.0L, 0.0L};
  c.events = 47;
  return c;
}

// R1 with dry friction: begins in stick (to 0.0147), 15 touches, one or no reversal of slip in each.
// The __float128 values with steps 4e-3 and 2e-3 agree to 1e-23. The 0.119072 quoted elsewhere for x is a straight
// line through eps = 5e-5 and 2e-5 continued to 0; the limit is not approached in a straight line.
inline ReferenceCase caseR1Dry() {
  ReferenceCase c = caseR1Regularised();
  c.name = "r1_dry";
  c.parameters.eps = 0.0L;
  c.max_step = 4.0e-3L;
  c.end.x = 0.11906772661922458753L;
  c.end.y = 0.90463475625264330395L;
  c.end.phi = 1.2106103329458314540e-4L;
  c.end.vx = -0.017703614288259649231L;
  c.end.vy = -0.064866261508083639483L;
  c.end.omega = -0.082411879728828324003L;
  c.agreement = 2.0e-17L;
  c.amplification = 160.0L;
  c.touches = {15, 0, 0, 0};
  c.peak_force = {3.2736724400180120L, 0.0L, 0.0L, 0.0L};
  c.events = 63;
  return c;
}

// The part slips into the slot: impacts on A1, A1 runs off the bottom face at 1.630, then the left side meets A2
// (slip + and -) and, after crossing the slot, the right side meets A1. Dry friction. Without `walls` nothing stops it.
inline ReferenceCase caseSlot() {
  ReferenceCase c;
  c.name = "slot";
  ReferenceParameters& p = c.parameters;
  p.a = 0.67L;
  p.b = 0.96L;
  p.mu = 0.15L;
  p.l = 0.70L;
  p.k_x = 0.8L;
  p.k_phi = 7.5L;
  p.h_x = p.h_y = 0.01L;
  p.h_phi = 0.3L;
  p.x_a = -0.02L;
  p.y_a = 0.746L;
  p.c1 = p.c2 = 7600.0L;
  p.h1 = p.h2 = 20.0L;
  p.f = 0.25L;
  p.excitation_y = {1.0L, 20.0L, 0.0L};
  c.start.x = 0.2L;
  c.start.y = 0.946L;
  c.start.phi = 0.025L;
  c.end_time = 4.0L;
  c.max_step = 2.0e-3L;
  c.end.x = 0.025186425818115583765L;
  c.end.y = 0.65629851326443740438L;
  c.end.phi = 0.0052606884306839599637L;
  c.end.vx = -0.045591000358089293667L;
  c.end.vy = -0.087904274520974672094L;
  c.end.omega = 0.036760049767159070074L;
  c.agreement = 3.0e-17L;
  c.amplification = 240.0L;
  c.touches = {6, 4, 0, 0};
  c.peak_force = {13.6565285083018294L, 12.1393009928458281L, 0.0L, 0.0L};
  c.events = 36;
  return c;
}

// Corner B1 on the top surface (phi < 0), anisotropic base C2 / C1 = H2 / H1 = 0.5, dry friction. Later phi changes
// sign again and again: A1 on the bottom face and B1 on the top surface at the same time, B2 in and out of the slot,
// reloading of a base still compressed, stick.
inline ReferenceCase caseCorner() {
  ReferenceCase c;
  c.name = "corner";
  ReferenceParameters& p = c.parameters;
  p.corners = true;
  p.a = 0.67L;
  p.b = 0.96L;
  p.mu = 0.15L;
  p.l = 0.76L;
  p.k_x = 0.2L;
  p.k_phi = 7.5L;
  p.h_x = p.h_y = 0.01L;
  p.h_phi = 0.3L;
  p.x_a = 0.1L;
  p.y_a = 0.81L;
  p.phi_a = -0.02L;
  p.c1 = 5000.0L;
  p.c2 = 2500.0L;
  p.h1 = 20.0L;
  p.h2 = 10.0L;
  p.f = 0.3L;
  p.excitation_y = {1.0L, 20.0L, 0.7L};
  c.start.x = 0.3L;
  c.start.y = 1.0104L;
  c.start.phi = -0.08L;
  c.end_time = 2.7L;
  c.max_step = 2.0e-3L;
  c.end.x = 0.15874942796480993650L;
  c.end.y = 0.96358134964530120320L;
  c.end.phi = -0.0054041823489896341458L;
  c.end.vx = -0.067772343348079115883L;
  c.end.vy = -2.3070596065496819915e-4L;
  c.end.omega = -0.0036716923217248046546L;
  c.agreement = 4.0e-17L;
  c.amplification = 38.0L;
  c.touches = {4, 0, 11, 0};
  c.peak_force = {2.9707589604409118L, 0.0L, 4.2525795863326913L, 0.0L};
  c.events = 62;
  return c;
}

// The same with regularised friction, eps = 5e-3.
inline ReferenceCase caseCornerRegularised() {
  ReferenceCase c = caseCorner();
  c.name = "corner_regularised";
  c.parameters.eps = 5.0e-3L;
  c.max_step = 1.0e-4L;
  c.end.x = 0.16145436817267927805L;
  c.end.y = 0.96353518501643073564L;
  c.end.phi = -0.0053307374796943979472L;
  c.end.vx = -0.066360049857864067300L;
  c.end.vy = -0.0011099811228706415749L;
  c.end.omega = -0.0015264850244924490483L;
  c.agreement = 7.0e-16L;
  c.amplification = 38.0L;
  c.touches = {3, 0, 10, 0};
  c.peak_force = {3.0012910123311625L, 0.0L, 4.2501571764289517L, 0.0L};
  c.events = 45;
  return c;
}

// Large tilt (0.3 to 0.4) on an anisotropic base C2 / C1 = H2 / H1 = 0.5, so that k(n), h(n) differ much between the
// bottom face and the side faces: A1 on the bottom face, A2 on the left, A1 on the right side. Dry friction, stick.
inline ReferenceCase caseTilt() {
  ReferenceCase c;
  c.name = "tilt";
  ReferenceParameters& p = c.parameters;
  p.a = 0.6L;
  p.b = 0.8L;
  p.mu = 0.2L;
  p.l = 0.68L;
  p.k_x = 0.3L;
  p.k_phi = 4.0L;
  p.h_x = 0.02L;
  p.h_y = 0.03L;
  p.h_phi = 0.04L;
  p.x_a = -0.4L;
  p.y_a = 0.2L;
  p.phi_a = 0.4L;
  p.c1 = 4000.0L;
  p.c2 = 2000.0L;
  p.h1 = 24.0L;
  p.h2 = 12.0L;
  p.f = 0.25L;
  p.excitation_y = {1.0L, 12.0L, 0.0L};
  c.start.x = 0.3L;
  c.start.y = 0.71975L;
  c.start.phi = 0.3L;
  c.start.vx = -0.05L;
  c.end_time = 3.5L;
  c.max_step = 2.0e-3L;
  c.end.x = -0.11932811588764896276L;
  c.end.y = 0.42267365933481225719L;
  c.end.phi = 0.35469269310223736173L;
  c.end.vx = 0.013408586096004844439L;
  c.end.vy = -0.21483032391480216953L;
  c.end.omega = 0.041556848579095107362L;
  c.agreement = 1.0e-16L;
  c.amplification = 40.0L;
  c.touches = {5, 2, 0, 0};
  c.peak_force = {10.1417894041966386L, 15.7210771304190422L, 0.0L, 0.0L};
  c.events = 26;
  return c;
}

// Stick and slip in nearly lasting contact: pressed hard (weight and anchor), shaken along x as well, f = 0.6.
// In contact for 86 % of the time, sticking for 58 %; it ends in stick, with V = 0 (vx is not 0: phi moves).
inline ReferenceCase caseStick() {
  ReferenceCase c;
  c.name = "stick";
  ReferenceParameters& p = c.parameters;
  p.a = 0.7L;
  p.b = 0.9L;
  p.mu = 0.3L;
  p.l = 0.79L;
  p.k_x = 0.05L;
  p.k_phi = 60.0L;
  p.h_x = p.h_y = p.h_phi = 0.05L;
  p.x_a = 0.2L;
  p.y_a = -0.4L;
  p.weight = 0.3L;
  p.c1 = p.c2 = 2500.0L;
  p.h1 = p.h2 = 20.0L;
  p.f = 0.6L;
  p.excitation_x = {0.8L, 7.0L, 0.0L};
  p.excitation_y = {1.0L, 20.0L, 0.0L};
  c.start.x = 0.2L;
  c.start.y = 0.89L;
  c.start.phi = 0.015L;
  c.end_time = 3.0L;
  c.max_step = 2.0e-3L;
  c.end.x = 0.20483810233588839489L;
  c.end.y = 0.88840882602918513892L;
  c.end.phi = 0.018681439642679783500L;
  c.end.vx = 0.19106550462583779191L;
  c.end.vy = 0.12169405868047678795L;
  c.end.omega = -0.21497855093641256233L;
  c.agreement = 2.0e-17L;
  c.amplification = 5.0L;
  c.touches = {3, 0, 0, 0};
  c.peak_force = {14.3857144298164269L, 0.0L, 0.0L, 0.0L};
  c.events = 25;
  return c;
}

// Wedged between both edges: A2 on the left side, A1 on the bottom face, pressed into that corner and shaken by a force
// along y and a moment. Either contact sticks or slips, at times both stick (1.369-1.443, 1.782-2.020, 2.633-2.799).
inline ReferenceCase caseWedge() {
  ReferenceCase c;
  c.name = "wedge";
  ReferenceParameters& p = c.parameters;
  p.a = 0.6L;
  p.b = 0.8L;
  p.mu = 0.2L;
  p.l = 0.62L;
  p.k_x = 1.0L;
  p.k_phi = 5.0L;
  p.h_x = p.h_y = p.h_phi = 0.05L;
  p.x_a = -1.0L;
  p.y_a = -0.4L;
  p.phi_a = 0.2L;
  p.c1 = p.c2 = 4000.0L;
  p.h1 = p.h2 = 40.0L;
  p.f = 0.5L;
  p.excitation_y = {0.5L, 6.0L, 0.0L};
  p.excitation_phi = {0.4L, 9.0L, 0.0L};
  c.start.x = -0.1425L;
  c.start.y = 0.6612L;
  c.start.phi = 0.2L;
  c.end_time = 3.0L;
  c.max_step = 2.0e-3L;
  c.end.x = -0.17618438502526260415L;
  c.end.y = 0.58846575639364479998L;
  c.end.phi = 0.30421008320993292095L;
  c.end.vx = -0.011854998245629539864L;
  c.end.vy = -0.034224195854649921906L;
  c.end.omega = 0.049688445406918085982L;
  c.agreement = 2.0e-17L;
  c.amplification = 0.25L;
  c.touches = {4, 2, 0, 0};
  c.peak_force = {11.1157734614902165L, 2.6321902364505820L, 0.0L, 0.0L};
  c.events = 49;
  return c;
}

inline std::vector<ReferenceCase> referenceCases() {
  return {caseR1Regularised(),     caseR1Dry(), caseSlot(),  caseCorner(),
          caseCornerRegularised(), caseTilt(),  caseStick(), caseWedge()};
}

}  // namespace vibratory_alignment::reference
