// A case of the independent reference integrator as a scene for the project's solvers.
#pragma once

#include <algorithm>
#include <cmath>

#include "../reference/reference_cases.h"
#include "mechanics/state.h"
#include "model/scene.h"

namespace vibratory_alignment::test {

inline Scene scene_of_reference(const reference::ReferenceParameters& p, const reference::ReferenceState& start,
                                double end_time) {
  const auto d = [](reference::Real value) { return static_cast<double>(value); };
  Scene s;
  s.part = {d(p.a), d(p.b)};
  s.slot.clearance = d(p.l - p.a);
  s.gripper.x = {true, 1.0, d(p.k_x), d(p.h_x)};
  s.gripper.y = {true, 1.0, 1.0, d(p.h_y)};
  s.gripper.phi = {true, d(p.mu), d(p.k_phi), d(p.h_phi)};
  s.gripper.anchor_x = d(p.x_a);
  s.gripper.anchor_y = d(p.y_a);
  s.gripper.anchor_phi = d(p.phi_a);
  s.base = {d(p.c2), d(p.c1), d(p.h2), d(p.h1), false};
  s.contacts = {p.edges, p.corners, false};
  if (p.f > 0.0L) s.friction = Friction{d(p.f), {}};
  if (p.eps > 0.0L) s.friction->regularization = d(p.eps);
  s.weight = d(p.weight);
  const auto drive = [&](const reference::Sine& sine, Direction direction) {
    if (sine.amplitude == 0.0L) return;
    Excitation e;
    e.direction = direction;
    e.amplitude = d(sine.amplitude);
    e.frequency = d(sine.frequency);
    e.phase = d(sine.phase);
    s.excitations.push_back(e);
  };
  drive(p.excitation_x, Direction::x);
  drive(p.excitation_y, Direction::y);
  drive(p.excitation_phi, Direction::phi);
  s.initial.x = d(start.x);
  s.initial.y = d(start.y);
  s.initial.phi = d(start.phi);
  s.initial.vx = d(start.vx);
  s.initial.vy = d(start.vy);
  s.initial.omega = d(start.omega);
  s.trial.time_limit = end_time;
  s.trial.aligned_depth = 10.0;  // go on after the slip-down
  return s;
}

inline Scene scene_of_reference(const reference::ReferenceCase& c) {
  Scene s = scene_of_reference(c.parameters, c.start, static_cast<double>(c.end_time));
  s.name = c.name;
  return s;
}

/// Largest difference of any coordinate or velocity.
inline double distance(const State& a, const reference::ReferenceState& b) {
  using std::abs;
  return static_cast<double>(std::max({abs(a.x - b.x), abs(a.y - b.y), abs(a.phi - b.phi), abs(a.vx - b.vx),
                                       abs(a.vy - b.vy), abs(a.omega - b.omega)}));
}

}  // namespace vibratory_alignment::test
