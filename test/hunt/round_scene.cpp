#include "round_scene.h"

#include <cmath>
#include <initializer_list>
#include <string>

#include "dice.h"

namespace vibratory_alignment::hunt {
namespace {

/// Streams of their own, apart from those of the other random scenes.
constexpr std::uint64_t kFirstStream = std::uint64_t{1} << 62;

constexpr double kQuarterTurn = 1.57079632679489661923;

constexpr long kSteps = 2000;

/// One of these; what stands there twice is as likely again.
double one_of(Dice& dice, std::initializer_list<double> values) {
  return values.begin()[dice.below(static_cast<int>(values.size()))];
}

/// A damping ratio of one of these.
double damping_of(Dice& dice, double inertia, double stiffness) {
  return 2.0 * one_of(dice, {0.0, 0.0, 0.1, 0.3, 1.0}) * std::sqrt(inertia * stiffness);
}

void roll_bodies(Dice& dice, Scene& s) {
  s.part = {one_of(dice, {0.2, 0.5, 1.0, 1.0}), one_of(dice, {0.5, 1.0, 1.0, 2.0})};
  s.slot.clearance = one_of(dice, {0.001, 0.01, 0.01, 0.1});
  const int features = 1 + dice.below(7);
  s.contacts = {(features & 1) != 0, (features & 2) != 0, (features & 4) != 0};
  if (s.contacts.walls && dice.chance(0.5)) s.slot.depth = s.part.base_distance * one_of(dice, {0.1, 0.5, 1.0});
}

void roll_gripper(Dice& dice, Scene& s) {
  Gripper& g = s.gripper;
  g.y = {true, 1.0, 1.0, damping_of(dice, 1.0, 1.0)};
  g.x = {!dice.chance(0.1), 1.0, one_of(dice, {0.0, 0.1, 1.0, 1.0}), 0.0};
  if (!g.x.moves) g.x.stiffness = 0.0;
  g.x.damping = damping_of(dice, 1.0, g.x.stiffness);
  g.phi = {!dice.chance(0.1), one_of(dice, {0.1, 0.5, 1.0}), one_of(dice, {0.0, 0.1, 1.0, 10.0}), 0.0};
  if (!g.phi.moves) g.phi.inertia = 1.0;
  g.phi.damping = damping_of(dice, g.phi.inertia, g.phi.stiffness);
}

void roll_base(Dice& dice, Scene& s) {
  Base& base = s.base;
  base.stiffness_y = one_of(dice, {1e2, 1e3, 1e4, 1e5});
  base.damping_y = damping_of(dice, 1.0, base.stiffness_y);
  base.stiffness_x = base.stiffness_y;
  base.damping_x = base.damping_y;
  if (dice.chance(0.2)) base.stiffness_x *= 0.5;
  if (dice.chance(0.2)) base.damping_x = 0.0;
  base.recovery = dice.chance(0.2);
  if (dice.chance(0.8)) {
    s.friction = Friction{one_of(dice, {0.1, 0.2, 0.5, 1.0, 2.0}), {}};
    if (dice.chance(0.2)) s.friction->regularization = one_of(dice, {0.001, 0.01});
  }
  if (dice.chance(0.4)) s.weight = one_of(dice, {0.5, 1.0});
}

void roll_excitations(Dice& dice, Scene& s) {
  for (int count = dice.below(3); count > 0; --count) {
    Excitation e;
    e.direction = static_cast<Direction>(dice.below(3));
    e.waveform = dice.chance(0.5) ? Waveform::sine : static_cast<Waveform>(dice.below(4));
    e.amplitude = one_of(dice, {0.1, 0.5, 1.0, 1.0, 2.0});
    e.frequency = one_of(dice, {1.0, 2.0, 5.0, 10.0});
    e.phase = one_of(dice, {0.0, 0.0, kQuarterTurn, 2.0 * kQuarterTurn});
    if (e.waveform == Waveform::chirp) {
      e.end_frequency = 2.0 * e.frequency;
      e.sweep_time = 5.0;
    }
    s.excitations.push_back(e);
  }
}

void roll_start(Dice& dice, Scene& s) {
  const double a = s.part.half_width, b = s.part.base_distance, c = s.slot.clearance;
  const double phi = one_of(dice, {0.0, 0.0, 0.0, 0.1, -0.1, kQuarterTurn});
  const double x = one_of(dice, {0.0, 0.0, 0.0, c, -c, 0.2 * a, a, -2.0 * a, 2.0 * a + c});
  s.initial.x = x;
  s.gripper.anchor_x = dice.chance(0.5) ? x : 0.0;
  s.gripper.anchor_phi = dice.chance(0.5) ? phi : 0.0;
  const bool at_rest = dice.chance(0.4);
  const double floor = s.slot.depth.value_or(0.1 * b);
  if (!at_rest) {
    const double touches = b * std::cos(phi) + a * std::abs(std::sin(phi));
    s.initial.y = touches + one_of(dice, {0.0, 0.0, 0.1, 0.5, -0.01, -floor});
  }
  if (!at_rest || !s.gripper.phi.moves || dice.chance(0.5)) s.initial.phi = phi;
  if (at_rest || dice.chance(0.6))
    s.gripper.pressing_force = one_of(dice, {0.0, 0.1, 0.5, 1.0, 1.0, 2.0});
  else
    s.gripper.anchor_y = *s.initial.y - one_of(dice, {0.0, 0.5, 1.0});
  if (dice.chance(0.5)) {
    s.initial.vx = one_of(dice, {0.0, 0.0, 0.1, -0.1, 1.0});
    s.initial.vy = one_of(dice, {0.0, 0.0, -0.1, -1.0});
    s.initial.omega = one_of(dice, {0.0, 0.0, 0.1, -0.1, 1.0});
  }
}

void roll_trial(Dice& dice, Scene& s) {
  s.trial.aligned_depth = one_of(dice, {0.0, 0.01});
  if (s.slot.depth && dice.chance(0.5)) s.trial.inserted_depth = *s.slot.depth;
  s.trial.time_limit = one_of(dice, {0.5, 1.0, 5.0});
  s.solver.tolerance = one_of(dice, {1e-10, 1e-8, 1e-8, 1e-6});
  s.solver.step_limit = kSteps;
}

}  // namespace

Scene round_scene(std::uint64_t seed) {
  Dice dice(kFirstStream + seed);
  Scene s;
  s.name = "round_" + std::to_string(seed);
  roll_bodies(dice, s);
  roll_gripper(dice, s);
  roll_base(dice, s);
  roll_excitations(dice, s);
  roll_start(dice, s);
  roll_trial(dice, s);
  return s;
}

}  // namespace vibratory_alignment::hunt
