// The paper's equations as printed, beside those of the model: what is wrong with the print, by energy and by what each
// term does (docs/paper.md "Equations"). The model's are those of evaluate_forces(), at random states in contact at A1.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "../support/numbers.h"
#include "../support/scenes.h"
#include "mechanics/contact_frame.h"
#include "mechanics/forces.h"
#include "mechanics/statics.h"

namespace vibratory_alignment {
namespace {

using test::kPi;

constexpr double kFriction = 0.24;

/// Force and moment that the base exerts on the part.
struct Reaction {
  double x = 0.0, y = 0.0, moment = 0.0;

  double power(const State& q) const { return x * q.vx + y * q.vy + moment * q.omega; }
};

/// A contact at A1 on the bottom face: N, the sign of V, the lever q and d.
struct EdgeTouch {
  double normal_force = 0.0, sign = 0.0, lever = 0.0, depth = 0.0, depth_rate = 0.0, slip = 0.0;
};

/// An isotropic base (k = 4100), and without its dampers unless they are asked for.
System system_with(double base_damping = 0.0) {
  System system = make_system(test::scene_of(test::plain, {"base={stiffness: {y: 4100}}"}));
  system.damping_x = system.damping_y = base_damping;
  return system;
}

/// Part pressed into the edge by up to 0.02, tilted and moving at random.
State pressed_state(std::mt19937& random, const System& system) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  State q = {0.2 + 0.1 * u(random), 0.0, 0.4 * u(random), u(random), u(random), u(random)};
  const double depth = 0.01 * (1.0 + u(random));
  // d = w + b with w = -(l - x) sin(phi) - y cos(phi)
  q.y = (system.base_distance - depth - (system.slot_half_width - q.x) * std::sin(q.phi)) / std::cos(q.phi);
  return q;
}

EdgeTouch touch_of(const System& system, const State& q) {
  const ContactKinematics k = contact_kinematics(system, q, Site::a1, Face::bottom);
  const double n = system.stiffness_y * k.depth + system.damping_y * k.depth_rate;
  return {n,
          k.slip_velocity > 0.0 ? 1.0 : -1.0,
          k.lever.x * k.normal.y - k.lever.y * k.normal.x,
          k.depth,
          k.depth_rate,
          k.slip_velocity};
}

/// What evaluate_forces() has beyond the gripper's springs and dampers.
Reaction model(const System& system, const State& q) {
  ContactStates contacts{};
  ContactState& a1 = contacts[static_cast<std::size_t>(Site::a1)];
  a1.phase = Phase::loaded;
  a1.face = Face::bottom;
  a1.slip = system.friction == 0.0 ? Slip::none : touch_of(system, q).sign > 0.0 ? Slip::plus : Slip::minus;
  Forces f;
  evaluate_forces(system, q, {}, contacts, f);
  return {
      f.ax + system.x.damping * q.vx + system.x.stiffness * (q.x - system.x.anchor),
      f.ay + system.y.damping * q.vy + system.y.stiffness * (q.y - system.y.anchor),
      system.phi.inertia * f.alpha + system.phi.damping * q.omega + system.phi.stiffness * (q.phi - system.phi.anchor)};
}

/// The model's reaction written out as in docs/paper.md.
Reaction written(const System& system, const State& q) {
  const EdgeTouch t = touch_of(system, q);
  const double c = std::cos(q.phi), s = std::sin(q.phi), f = system.friction * t.sign;
  return {-t.normal_force * (s + f * c), t.normal_force * (c - f * s),
          t.normal_force * (t.lever - f * (system.base_distance - t.depth))};
}

enum class Print { fx, fy, fy_friction, moment, damper };

/// The same with one term as the paper prints it in (1), (2), (4). F_Y is subtracted there.
Reaction printed(const System& system, const State& q, Print term) {
  const EdgeTouch t = touch_of(system, q);
  const double c = std::cos(q.phi), s = std::sin(q.phi), f = system.friction * t.sign;
  Reaction r = written(system, q);
  if (term == Print::damper) {
    const double share = (system.damping_y + system.stiffness_y) * t.depth / t.normal_force;
    return {share * r.x, share * r.y, share * r.moment};
  }
  if (term == Print::fx) r.x = t.normal_force * (s - f * c);
  if (term == Print::fy) r.y = -t.normal_force * (c - f * s);
  if (term == Print::fy_friction) r.y = t.normal_force * (c + f * s);
  if (term == Print::moment) r.moment = t.normal_force * (t.lever + f * (system.base_distance - t.depth));
  return r;
}

/// Energy that the part gains from the base beyond what its spring gives, per time, with elastic base and no friction.
double gain_without_losses(const System& system, const State& q, const Reaction& r) {
  const EdgeTouch t = touch_of(system, q);
  return r.power(q) + system.stiffness_y * t.depth * t.depth_rate;
}

/// Power of friction: what is left of the reaction's after that of N along the normal, -N d'.
double friction_power(const System& system, const State& q, const Reaction& r) {
  const EdgeTouch t = touch_of(system, q);
  return r.power(q) + t.normal_force * t.depth_rate;
}

template <class Look>
void for_random_states(const System& system, const Look& look) {
  std::mt19937 random(4);
  for (int i = 0; i < 300; ++i) look(pressed_state(random, system));
}

TEST(WrittenEquations, are_those_of_the_program) {
  for (const double friction : {0.0, kFriction}) {
    System system = system_with(17.0);
    system.friction = friction;
    for_random_states(system, [&](const State& q) {
      const Reaction a = model(system, q), b = written(system, q);
      const double size = 1e-13 * (1.0 + std::abs(touch_of(system, q).normal_force));
      EXPECT_NEAR(a.x, b.x, size);
      EXPECT_NEAR(a.y, b.y, size);
      EXPECT_NEAR(a.moment, b.moment, size);
    });
  }
}

// Departure 1. The paper's q is the lever at d = 0.
TEST(WrittenEquations, have_the_paper_s_lever) {
  const System system = system_with();
  for_random_states(system, [&](State q) {
    q.y = (system.base_distance - (system.slot_half_width - q.x) * std::sin(q.phi)) / std::cos(q.phi);
    const double lever = (system.slot_half_width - q.x) / std::cos(q.phi) - system.base_distance * std::tan(q.phi);
    EXPECT_NEAR(touch_of(system, q).lever, lever, 1e-14);
  });
}

// Departures 1 and 3: without damper and friction nothing may be gained or lost.
TEST(PrintedEquations, of_the_normal_force_make_energy) {
  System system = system_with();
  system.friction = 0.0;
  double largest = 0.0, by_fx = 0.0, by_fy = 0.0;
  for_random_states(system, [&](const State& q) {
    largest = std::max(largest, std::abs(gain_without_losses(system, q, model(system, q))));
    by_fx = std::max(by_fx, gain_without_losses(system, q, printed(system, q, Print::fx)));
    by_fy = std::max(by_fy, gain_without_losses(system, q, printed(system, q, Print::fy)));
  });
  EXPECT_LT(largest, 1e-12);
  EXPECT_GT(by_fx, 1.0);
  EXPECT_GT(by_fy, 1.0);
}

// Departure 3: with F_Y subtracted the base pulls a part that lies on it down.
TEST(PrintedEquations, of_fy_pull_the_part_into_the_base) {
  System system = system_with();
  system.friction = 0.0;
  for_random_states(system, [&](const State& q) {
    EXPECT_GT(model(system, q).y, 0.0);
    EXPECT_LT(printed(system, q, Print::fy).y, 0.0);
  });
}

// Departures 2 and 3: friction does not drive. Its power is -f N |V|.
TEST(PrintedEquations, of_friction_drive) {
  System system = system_with();
  system.friction = kFriction;
  double by_moment = 0.0, by_fy = 0.0;
  for_random_states(system, [&](const State& q) {
    const EdgeTouch t = touch_of(system, q);
    EXPECT_NEAR(friction_power(system, q, model(system, q)), -kFriction * t.normal_force * std::abs(t.slip), 1e-12);
    by_moment = std::max(by_moment, friction_power(system, q, printed(system, q, Print::moment)));
    by_fy = std::max(by_fy, friction_power(system, q, printed(system, q, Print::fy_friction)));
  });
  EXPECT_GT(by_moment, 0.1);
  EXPECT_GT(by_fy, 0.1);
}

// Departures 4 and 5: K_Y Y sin(omega t) once, with the frequency nu. Multiplied by the sine again its mean is 1/2 and
// it never pushes down; sin(tau) has another period.
TEST(PrintedEquations, of_the_excitation_push_on_one_side) {
  const Scene scene = test::scene_of(test::plain);
  const Excitation& excitation = scene.excitations.front();
  const Drive drive(excitation, Instant());
  const DriveForm form = drive.form_at(Instant());
  double mean = 0.0, mean_of_print = 0.0, least = 0.0, other_frequency = 0.0;
  constexpr int kParts = 1000;
  for (int i = 0; i < kParts; ++i) {
    const double tau = 2.0 * kPi / excitation.frequency * i / kParts, sine = std::sin(excitation.frequency * tau);
    EXPECT_NEAR(form.at(tau), sine, 1e-13);
    mean += form.at(tau) / kParts;
    mean_of_print += sine * sine / kParts;
    least = std::min(least, form.at(tau));
    other_frequency = std::max(other_frequency, std::abs(form.at(tau) - std::sin(tau)));
  }
  EXPECT_NEAR(mean, 0.0, 1e-13);
  EXPECT_NEAR(mean_of_print, 0.5, 1e-13);
  EXPECT_NEAR(least, -1.0, 1e-4);
  EXPECT_GT(other_frequency, 0.9);
}

// Departure 5: without the dot, N = (h + k) d, the damper is a spring: it gives back at the opening what the closing
// cost it. With it the damper takes h d'^2, both ways.
TEST(PrintedEquations, of_the_damper_lose_nothing) {
  System system = system_with(17.0);
  system.friction = 0.0;
  for_random_states(system, [&](const State& q) {
    State back = q;
    back.vx = -q.vx;
    back.vy = -q.vy;
    back.omega = -q.omega;
    const double rate = touch_of(system, q).depth_rate;
    const auto both_ways = [&](const auto& reaction) {
      return gain_without_losses(system, q, reaction(q)) + gain_without_losses(system, back, reaction(back));
    };
    EXPECT_NEAR(both_ways([&](const State& s) { return model(system, s); }), -2.0 * 17.0 * rate * rate, 1e-10);
    EXPECT_NEAR(both_ways([&](const State& s) { return printed(system, s, Print::damper); }), 0.0, 1e-10);
  });
}

// Departure 6: in flight the pressing force goes on. At the height of touch it is f0; without the static offset of the
// spring, as (3) and (5) have it, the spring would pull to y = 0 with the force y, whatever f0 is.
TEST(PrintedEquations, of_flight_lose_the_pressing_force) {
  for (const double force : {0.1, 0.27, 0.8}) {
    const System system = make_system(
        test::scene_of(test::plain, {"gripper.pressing_force=" + std::to_string(force), "gripper.damping=null"}));
    const std::optional<double> touch = touch_height(system, system.start.x, system.start.phi);
    ASSERT_TRUE(touch);
    State q = system.start;
    q.y = *touch;
    Forces f;
    evaluate_forces(system, q, {}, ContactStates{}, f);
    EXPECT_NEAR(f.ay, -force, 1e-14);
    EXPECT_LT(-q.y, -0.9);  // what the print has there, for each of these forces
  }
}

// Departure 8: the reaction at A2 is one of its own, the mirror image of that at A1, and not -f_x.
TEST(PrintedEquations, of_n2_are_no_condition_on_the_motion) {
  System system = system_with();
  system.friction = 0.0;
  ContactStates at_a1{}, at_a2{};
  for (auto [site, contacts] : {std::pair(Site::a1, &at_a1), std::pair(Site::a2, &at_a2)}) {
    ContactState& contact = (*contacts)[static_cast<std::size_t>(site)];
    contact.phase = Phase::loaded;
    contact.face = Face::bottom;
  }
  double largest = 0.0;
  for_random_states(system, [&](const State& q) {
    const State mirrored = {-q.x, q.y, -q.phi, -q.vx, q.vy, -q.omega};
    Forces right, left;
    evaluate_forces(system, q, {}, at_a1, right);
    evaluate_forces(system, mirrored, {}, at_a2, left);
    EXPECT_DOUBLE_EQ(left.contact[0].normal_force, right.contact[0].normal_force);
    largest = std::max(largest, std::abs(model(system, q).x));
  });
  EXPECT_GT(largest, 1.0);  // on the edge A1 alone there is f_x and no n2; the printed condition would ask for f_x = 0
}

}  // namespace
}  // namespace vibratory_alignment
