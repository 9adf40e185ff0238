#include "random_scene.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "dice.h"
#include "round_scene.h"

namespace vibratory_alignment::hunt {
namespace {

constexpr double kPi = 3.14159265358979323846;

// A scene is to cost some milliseconds: at most so many periods of what is fastest, and so many steps.
constexpr double kOrdinaryPeriods = 30.0, kWildPeriods = 8.0;
constexpr long kOrdinarySteps = 20000, kWildSteps = 1000;

/// Below, at and above the critical damping of an oscillator.
double random_damping(Dice& dice, double inertia, double stiffness, double highest_ratio) {
  const double critical = 2.0 * std::sqrt(inertia * std::max(stiffness, 1e-3));
  if (dice.chance(0.25)) return 0.0;
  if (dice.chance(0.05)) return critical;
  if (dice.chance(0.15)) return critical * dice.decades(1.0, highest_ratio);
  return critical * dice.decades(1e-3, 1.0);
}

void roll_part_and_slot(Dice& dice, bool wild, Scene& s) {
  const auto length = [&] { return wild && dice.chance(0.2) ? dice.decades(1e-4, 1e4) : dice.decades(0.1, 3.0); };
  s.part = {length(), length()};
  s.slot.clearance = s.part.half_width * dice.decades(1e-3, 0.3);
  if (wild && dice.chance(0.5)) s.slot.clearance = dice.decades(1e-9, 1.0);
  const int features = 1 + dice.below(7);
  s.contacts = {(features & 1) != 0, (features & 2) != 0, (features & 4) != 0};
  if (dice.chance(0.35)) s.contacts = {true, true, false};
  if (s.contacts.walls && dice.chance(0.6)) s.slot.depth = s.part.base_distance * dice.uniform(0.05, 2.0);
}

void roll_gripper(Dice& dice, bool wild, Scene& s) {
  Gripper& g = s.gripper;
  const double highest_ratio = wild ? 100.0 : 5.0;
  g.y = {true, 1.0, 1.0, random_damping(dice, 1.0, 1.0, highest_ratio)};
  g.x = {dice.chance(0.9), 1.0, dice.chance(0.15) ? 0.0 : dice.decades(1e-3, 10.0), 0.0};
  if (wild && dice.chance(0.1)) g.x.stiffness = dice.decades(1e-12, 1e6);
  if (!g.x.moves) g.x.stiffness = 0.0;
  g.x.damping = random_damping(dice, 1.0, g.x.stiffness, highest_ratio);
  g.phi.moves = dice.chance(0.9);
  g.phi.inertia = dice.decades(0.02, 2.0) * s.part.half_width * s.part.half_width;
  if (wild && dice.chance(0.4)) g.phi.inertia = dice.decades(1e-8, 1e3);
  if (!g.phi.moves) g.phi.inertia = 1.0;
  g.phi.stiffness = dice.chance(0.15) ? 0.0 : dice.decades(1e-2, 100.0) * (wild ? dice.decades(1e-3, 1e3) : 1.0);
  g.phi.damping = random_damping(dice, g.phi.inertia, g.phi.stiffness, highest_ratio);
}

void roll_base(Dice& dice, bool wild, Scene& s) {
  Base& base = s.base;
  const auto damping = [&](double stiffness) {
    if (dice.chance(0.2)) return 0.0;
    const double ratio = dice.chance(0.15) ? dice.decades(1.0, wild ? 100.0 : 4.0) : dice.decades(0.01, 1.0);
    return 2.0 * ratio * std::sqrt(stiffness);
  };
  base.stiffness_y = wild ? dice.decades(10.0, 1e12) : dice.decades(100.0, 1e5);
  base.damping_y = damping(base.stiffness_y);
  base.stiffness_x = base.stiffness_y;
  base.damping_x = base.damping_y;
  if (dice.chance(0.5)) {
    base.stiffness_x *= dice.decades(0.1, 10.0);
    base.damping_x = damping(base.stiffness_x);
  }
  base.recovery = dice.chance(0.2);
  if (dice.chance(0.8)) {
    s.friction = Friction{dice.chance(0.1) ? dice.uniform(1.0, 5.0) : dice.uniform(0.02, 1.0), {}};
    if (dice.chance(0.25)) s.friction->regularization = dice.decades(wild ? 1e-6 : 1e-4, 0.1);
  }
  if (dice.chance(0.3)) s.weight = dice.decades(0.01, wild ? 100.0 : 2.0);
}

Excitation random_excitation(Dice& dice, bool wild, bool first) {
  Excitation e;
  e.direction = first && dice.chance(0.8) ? Direction::y : static_cast<Direction>(dice.below(3));
  e.waveform = dice.chance(0.5) ? Waveform::sine : static_cast<Waveform>(dice.below(4));
  e.amplitude = first && dice.chance(0.5) ? 1.0 : dice.uniform(-3.0, 3.0);
  if (wild && dice.chance(0.2)) e.amplitude *= dice.decades(1.0, 100.0);
  if (e.direction == Direction::phi) e.amplitude *= 0.1;
  e.frequency = wild ? dice.decades(1e-3, 1e4) : dice.decades(0.5, 50.0);
  if (dice.chance(0.1)) e.frequency = 1.0;  // the resonance along the insertion
  e.phase = dice.chance(0.5) ? 0.0 : dice.uniform(-10.0, 10.0);
  if (e.waveform == Waveform::chirp) {
    e.end_frequency = e.frequency * dice.decades(0.1, 10.0);
    e.sweep_time = dice.decades(0.1, 50.0) / std::max(1.0, 0.05 * e.frequency);
  }
  return e;
}

void roll_excitations(Dice& dice, bool wild, Scene& s) {
  const int count = dice.chance(0.08) ? 0 : dice.chance(0.6) ? 1 : 1 + dice.below(3);
  for (int i = 0; i < count; ++i) s.excitations.push_back(random_excitation(dice, wild, i == 0));
}

/// From far above the base to deep inside it, and all the close calls between.
double random_height(Dice& dice, bool wild, const Scene& s, double tilt) {
  const double a = s.part.half_width, b = s.part.base_distance;
  const double corner_drop = a * std::abs(std::sin(tilt));
  const double corner_touches = b * std::cos(tilt) + corner_drop;
  if (wild && dice.chance(0.1)) return dice.uniform(-3.0, 3.0) * b;
  if (dice.chance(0.3)) return corner_touches + dice.uniform(0.0, 0.5);
  if (dice.chance(0.3)) return corner_touches + (dice.chance(0.5) ? -1.0 : 1.0) * dice.decades(1e-12, 1e-2);
  if (dice.chance(0.5)) return corner_touches - dice.uniform(0.0, wild ? 1.0 : 0.1) * b;
  return corner_touches + dice.uniform(-1.0, 1.0) * corner_drop;
}

void roll_start(Dice& dice, bool wild, Scene& s) {
  const double a = s.part.half_width;
  double tilt = dice.chance(0.1) ? 0.0 : wild && dice.chance(0.2) ? dice.uniform(-3.2, 3.2) : dice.uniform(-0.2, 0.2);
  if (dice.chance(0.05)) tilt = dice.decades(1e-9, 1e-3);
  double x = dice.uniform(-1.0, 1.0) * (wild ? 3.0 : 0.8) * a;
  if (dice.chance(0.3)) x = dice.uniform(-1.5, 1.5) * s.slot.clearance;
  if (dice.chance(0.1)) x = 0.0;
  s.initial.x = x;
  s.gripper.anchor_x = dice.chance(0.5) ? x : dice.chance(0.5) ? 0.0 : dice.uniform(-1.0, 1.0) * a;
  s.gripper.anchor_phi = dice.chance(0.5) ? 0.0 : dice.chance(0.5) ? tilt : dice.uniform(-0.2, 0.2);
  const double y = random_height(dice, wild, s, tilt);
  const bool at_rest = dice.chance(0.25);
  if (!at_rest) s.initial.y = y;
  if (!at_rest || !s.gripper.phi.moves || dice.chance(0.5)) s.initial.phi = tilt;
  if (at_rest || dice.chance(0.6))
    s.gripper.pressing_force = dice.chance(0.1) ? 0.0 : dice.decades(0.01, wild ? 50.0 : 2.0);
  else
    s.gripper.anchor_y = y - dice.uniform(-1.0, 1.0) * (wild ? 3.0 : 1.0);
  if (dice.chance(0.4)) {
    const double speed = wild ? dice.decades(1e-6, 100.0) : dice.decades(1e-3, 3.0);
    s.initial.vx = dice.uniform(-1.0, 1.0) * speed;
    s.initial.vy = dice.uniform(-1.0, 1.0) * speed;
    s.initial.omega = dice.uniform(-1.0, 1.0) * speed / (wild ? 1.0 : a);
  }
}

/// Of the excitations and, in flight, the gripper.
double fastest_rate(const Scene& s) {
  double rate = 1.0;
  for (const GripperAxis* axis : {&s.gripper.x, &s.gripper.phi})
    if (axis->moves) rate = std::max({rate, std::sqrt(axis->stiffness / axis->inertia), axis->damping / axis->inertia});
  for (const Excitation& e : s.excitations) rate = std::max({rate, e.frequency, e.end_frequency});
  return rate;
}

void roll_trial(Dice& dice, bool wild, Scene& s) {
  const double b = s.part.base_distance, deepest = s.slot.depth.value_or(INFINITY);
  s.trial.aligned_depth = dice.chance(0.3) ? 0.0 : std::min(0.02 * b, deepest);
  if (s.contacts.walls && dice.chance(0.3))
    s.trial.inserted_depth = std::max(
        s.trial.aligned_depth, s.slot.depth ? *s.slot.depth * dice.uniform(0.3, 1.0) : b * dice.uniform(0.1, 1.0));
  const double longest = 2.0 * kPi / fastest_rate(s) * (wild ? kWildPeriods : kOrdinaryPeriods);
  s.trial.time_limit = std::min(dice.decades(0.3, 10.0), longest);
  s.solver.tolerance = dice.chance(0.5) ? 1e-8 : dice.decades(1e-13, 1e-3);
  s.solver.step_limit = wild ? kWildSteps : kOrdinarySteps;
}

}  // namespace

const char* to_string(Range range) {
  return range == Range::ordinary ? "ordinary" : range == Range::wild ? "wild" : "round";
}

Scene random_scene(std::uint64_t seed, Range range) {
  if (range == Range::round) return round_scene(seed);
  const bool wild = range == Range::wild;
  Dice dice(2 * seed + (wild ? 1 : 0));
  Scene s;
  s.name = std::string(to_string(range)) + "_" + std::to_string(seed);
  roll_part_and_slot(dice, wild, s);
  roll_gripper(dice, wild, s);
  roll_base(dice, wild, s);
  roll_excitations(dice, wild, s);
  roll_start(dice, wild, s);
  roll_trial(dice, wild, s);
  return s;
}

}  // namespace vibratory_alignment::hunt
