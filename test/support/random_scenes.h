// Random scenes with fixed seeds: all effects, wide ranges, nothing that a trial could not meet.
#pragma once

#include <cmath>
#include <random>

#include "model/scene.h"

namespace vibratory_alignment::test {

inline Scene random_scene(unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto decades = [&](double low, double high) {
    return std::pow(10.0, uniform(std::log10(low), std::log10(high)));
  };
  const auto chance = [&](double p) { return uniform(0.0, 1.0) < p; };
  Scene s;
  s.name = "random";
  s.part = {uniform(0.4, 0.9), uniform(0.6, 1.2)};
  s.slot.clearance = decades(0.01, 0.2);
  const double l = s.slot_half_width();
  s.gripper.x = {chance(0.9), 1.0, decades(0.01, 2.0), decades(0.003, 0.5)};
  s.gripper.y = {true, 1.0, 1.0, decades(0.003, 0.5)};
  s.gripper.phi = {chance(0.9), decades(0.01, 2.0), decades(1.0, 100.0), decades(0.003, 2.0)};
  const double k = decades(100.0, 1e5), zeta = decades(0.02, 1.0), ratio = chance(0.5) ? 1.0 : uniform(0.3, 1.5);
  s.base = {ratio * k, k, ratio * 2.0 * zeta * std::sqrt(k), 2.0 * zeta * std::sqrt(k), chance(0.2)};
  s.contacts = {true, chance(0.6), chance(0.4)};
  if (chance(0.1)) s.contacts.edges = false, s.contacts.corners = true;
  if (s.contacts.walls && chance(0.7)) s.slot.depth = uniform(0.05, 0.5);
  if (chance(0.85)) s.friction = Friction{uniform(0.05, 0.8), {}};
  if (s.friction && chance(0.2)) s.friction->regularization = decades(1e-4, 1e-2);
  if (chance(0.3)) s.weight = uniform(0.0, 0.3);
  const int drives = chance(0.75) ? 1 : 2;
  for (int i = 0; i < drives; ++i) {
    Excitation e;
    e.direction = i == 0 ? Direction::y : chance(0.5) ? Direction::x : Direction::phi;
    e.waveform = chance(0.6) ? Waveform::sine : static_cast<Waveform>(std::uniform_int_distribution<int>(1, 3)(random));
    e.amplitude = i == 0 ? 1.0 : uniform(0.1, 0.6);
    e.frequency = decades(2.0, 40.0);
    e.phase = uniform(0.0, 6.28);
    if (e.waveform == Waveform::chirp) {
      e.end_frequency = decades(2.0, 40.0);
      e.sweep_time = uniform(1.0, 10.0);
    }
    s.excitations.push_back(e);
  }
  const double reach = s.part.half_width + l;
  s.initial.x = uniform(-0.35, 0.35) * reach;
  s.gripper.anchor_x = chance(0.5) ? s.initial.x : 0.0;
  s.gripper.anchor_phi = chance(0.5) ? 0.0 : uniform(-0.1, 0.1);
  s.initial.phi = uniform(-0.15, 0.15);
  s.initial.y = s.part.base_distance * std::cos(*s.initial.phi) + uniform(0.05, 0.25);
  s.gripper.anchor_y = s.part.base_distance - uniform(0.1, 0.9);
  if (chance(0.3))
    s.initial.vx = uniform(-0.5, 0.5), s.initial.omega = uniform(-1.0, 1.0), s.initial.vy = uniform(-0.5, 0.5);
  s.trial.time_limit = 20.0;
  s.trial.aligned_depth = s.slot.depth ? 0.5 * *s.slot.depth : 0.02;
  return s;
}

/// Gives the scene a tanh law and a tolerance with which the solver `event` crosses its layer in one segment.
inline void cross_layers(Scene& scene) {
  if (!scene.friction) scene.friction.emplace();
  if (scene.friction->coefficient == 0.0) scene.friction->coefficient = 0.2;
  scene.friction->regularization = 2e-3;
  scene.solver.tolerance = 1e-4;
}

}  // namespace vibratory_alignment::test
