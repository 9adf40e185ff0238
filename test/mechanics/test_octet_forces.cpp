// The equations of motion at eight states at once against those at one: every contact, every law of friction, small and
// large tilts; and under other normal forces than those of the states.
#include "mechanics/octet_forces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "../support/touching.h"

namespace vibratory_alignment {
namespace {

using test::anisotropic_system;
using test::states_of;
using test::TouchWithSlip;

std::vector<std::vector<TouchWithSlip>> all_touches() {
  std::vector<std::vector<TouchWithSlip>> all;
  for (const Slip slip : {Slip::none, Slip::plus, Slip::minus, Slip::stick, Slip::regularized}) {
    for (const Face face : {Face::bottom, Face::right_side, Face::left_side}) all.push_back({{Site::a1, face, slip}});
    for (const Face face : {Face::top, Face::left_wall}) all.push_back({{Site::b2, face, slip}});
    all.push_back({{Site::b1, Face::right_wall, slip}, {Site::b1_floor, Face::floor, slip}});
    all.push_back({{Site::a1, Face::bottom, Slip::plus}, {Site::b2, Face::top, slip}});
    all.push_back({{Site::a1, Face::bottom, slip}, {Site::b2, Face::left_wall, slip}});
    all.push_back({{Site::a2, Face::left_side, Slip::stick},
                   {Site::b1, Face::right_wall, Slip::plus},
                   {Site::b1_floor, Face::floor, slip}});
  }
  return all;
}

/// Forces at every state by themselves, and their normal forces.
struct OneByOne {
  std::array<Forces, Octet::kSize> forces;
  NormalForcesOctet normal{};
};

OneByOne one_by_one(const System& system, const StateOctet& states, const Load3& drive, const ContactStates& contacts) {
  OneByOne all;
  for (std::size_t i = 0; i < Octet::kSize; ++i) {
    evaluate_forces(system, states[i], drive, contacts, all.forces[i]);
    for (std::size_t c = 0; c < static_cast<std::size_t>(all.forces[i].count); ++c)
      all.normal[c][i] = all.forces[i].contact[c].normal_force;
  }
  return all;
}

class OctetForces : public testing::TestWithParam<double> {  // largest tilt
 protected:
  StateOctet random_states() {
    StateOctet states;
    for (std::size_t i = 0; i < Octet::kSize; ++i) {
      states.x[i] = 0.5 * u_(random_);
      states.y[i] = 0.9 + 0.5 * u_(random_);
      states.phi[i] = GetParam() * u_(random_);
      states.vx[i] = u_(random_);
      states.vy[i] = u_(random_);
      states.omega[i] = 2.0 * u_(random_);
    }
    return states;
  }

  std::mt19937 random_{7};
  std::uniform_real_distribution<double> u_{-1.0, 1.0};
};

constexpr double kRounding = 1e-13;

TEST_P(OctetForces, are_those_of_every_state) {
  const System system = anisotropic_system();
  const LoadOctet drive{0.3, -0.2, 0.1};
  for (const auto& touches : all_touches()) {
    const ContactStates contacts = states_of(touches);
    const StateOctet states = random_states();
    const auto [expected, acting] = one_by_one(system, states, {0.3, -0.2, 0.1}, contacts);
    ForcesOctet forces;
    evaluate_forces_under(acting, system, states, drive, contacts, forces);
    for (std::size_t i = 0; i < Octet::kSize; ++i) {
      const Forces got = forces[i];
      const Forces& want = expected[i];
      ASSERT_EQ(got.count, want.count);
      const double size = kRounding * (std::abs(want.ax) + std::abs(want.ay) + std::abs(want.alpha) + 10.0);
      EXPECT_NEAR(got.ax, want.ax, size);
      EXPECT_NEAR(got.ay, want.ay, size);
      EXPECT_NEAR(got.alpha, want.alpha, size);
      for (std::size_t c = 0; c < touches.size(); ++c) {
        EXPECT_EQ(got.contact[c].site, want.contact[c].site);
        EXPECT_NEAR(got.contact[c].depth, want.contact[c].depth, kRounding);
        EXPECT_NEAR(got.contact[c].normal_force, want.contact[c].normal_force, 100.0 * kRounding);
        EXPECT_NEAR(got.contact[c].tangential_force, want.contact[c].tangential_force, 100.0 * size);
        EXPECT_NEAR(got.contact[c].friction_ratio, want.contact[c].friction_ratio, kRounding);
        EXPECT_NEAR(got.contact[c].slip_velocity, want.contact[c].slip_velocity, kRounding);
      }
    }
  }
}

// A locked axis takes no part in what holds two contacts.
TEST_P(OctetForces, of_a_part_with_a_locked_axis_are_those_of_every_state) {
  const ContactStates contacts =
      states_of({{Site::a1, Face::bottom, Slip::stick}, {Site::b2, Face::left_wall, Slip::stick}});
  for (const int locked : {0, 1, 2}) {
    System system = anisotropic_system();
    (locked == 0 ? system.x : locked == 1 ? system.y : system.phi).inverse_inertia = 0.0;
    const StateOctet states = random_states();
    const auto [expected, acting] = one_by_one(system, states, {}, contacts);
    ForcesOctet forces;
    EXPECT_TRUE(evaluate_forces_under(acting, system, states, {}, contacts, forces)) << locked;
    for (std::size_t i = 0; i < Octet::kSize; ++i) {
      const Forces& want = expected[i];
      double size = 10.0;
      for (std::size_t c = 0; c < 2; ++c) size += std::abs(want.contact[c].tangential_force);
      EXPECT_NEAR(forces.ax[i], want.ax, kRounding * size) << locked;
      EXPECT_NEAR(forces.ay[i], want.ay, kRounding * size) << locked;
      EXPECT_NEAR(forces.alpha[i], want.alpha, kRounding * size) << locked;
      for (std::size_t c = 0; c < 2; ++c)
        EXPECT_NEAR(forces.contact[c].tangential_force[i], want.contact[c].tangential_force, 100.0 * kRounding * size)
            << locked;
    }
  }
}

// On a base 1.7 times as stiff and damped these would be the forces of the states.
TEST_P(OctetForces, other_normal_forces_push_with_their_friction) {
  const System system = anisotropic_system();
  System stiffer = system;
  for (double* rate : {&stiffer.stiffness_x, &stiffer.stiffness_y, &stiffer.damping_x, &stiffer.damping_y})
    *rate *= 1.7;
  for (const auto& touches : all_touches()) {
    const ContactStates contacts = states_of(touches);
    const StateOctet states = random_states();
    const auto [expected, acting] = one_by_one(stiffer, states, {}, contacts);
    ForcesOctet forces;
    evaluate_forces_under(acting, system, states, {}, contacts, forces);
    for (std::size_t i = 0; i < Octet::kSize; ++i) {
      const Forces& want = expected[i];
      const double size = kRounding * (std::abs(want.ax) + std::abs(want.ay) + std::abs(want.alpha) + 10.0);
      EXPECT_NEAR(forces.ax[i], want.ax, size);
      EXPECT_NEAR(forces.ay[i], want.ay, size);
      EXPECT_NEAR(forces.alpha[i], want.alpha, size);
      for (std::size_t c = 0; c < touches.size(); ++c)
        EXPECT_NEAR(1.7 * forces.contact[c].normal_force[i], want.contact[c].normal_force, 100.0 * kRounding);
    }
  }
}

// What is no number shows in the accelerations, also where contacts stick: a step is given up by them.
TEST_P(OctetForces, what_is_no_number_stays_so) {
  const System system = anisotropic_system();
  for (const auto& touches : all_touches()) {
    StateOctet states = random_states();
    states.omega[2] = std::numeric_limits<double>::quiet_NaN();
    ForcesOctet forces;
    evaluate_forces_under({}, system, states, {}, states_of(touches), forces);
    EXPECT_TRUE(std::isnan(forces.ax[2] + forces.ay[2] + forces.alpha[2]));
    EXPECT_TRUE(std::isfinite(forces.ax[1] + forces.ay[1] + forces.alpha[1]));
  }
}

// T of two that stick is that of every state also where the part hardly turns, or hardly does anything else: rows of
// J M^-1/2 may be nearly parallel then, as those of two feet of a tilted part are.
TEST(OctetHolding, of_two_contacts_keeps_its_digits_at_any_inertia) {
  System system = anisotropic_system();
  for (const Face second : {Face::left_wall, Face::top})
    for (const double inertia : {1e-8, 1e-4, 1.0, 1e4, 1e5, 9e5, 1e7, 1e65}) {
      const ContactStates contacts = states_of({{Site::b1, Face::top, Slip::stick}, {Site::b2, second, Slip::stick}});
      system.phi.inertia = inertia;
      system.phi.inverse_inertia = 1.0 / inertia;
      StateOctet states;
      for (std::size_t i = 0; i < Octet::kSize; ++i) {
        const double t = 0.1 * static_cast<double>(i + 1);
        states.x[i] = 0.2 * t;
        states.y[i] = 0.9 - 0.1 * t;
        states.phi[i] = 0.3 - 0.1 * t;
        states.vx[i] = t;
        states.vy[i] = -0.5 * t;
        states.omega[i] = i % 2 == 0 ? 0.0 : 0.75 - t;
      }
      const auto [expected, acting] = one_by_one(system, states, {}, contacts);
      ForcesOctet forces;
      evaluate_forces_under(acting, system, states, {}, contacts, forces);
      for (std::size_t i = 0; i < Octet::kSize; ++i)
        for (std::size_t c = 0; c < 2; ++c) {
          const double want = expected[i].contact[c].tangential_force;
          EXPECT_NEAR(forces.contact[c].tangential_force[i], want, 1e-12 * std::abs(want)) << inertia << " " << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Tilts, OctetForces, testing::Values(0.3, 2.0));

TEST(OctetDrives, are_those_of_every_time) {
  std::array<DriveForm, 4> forms;
  forms[0] = {0.3, -0.2, 1.5, 20.0, 0.0, std::sin(0.4), std::cos(0.4)};
  forms[1] = {0.0, 0.1, 0.7, 3.0, 50.0, std::sin(2.0), std::cos(2.0)};
  forms[2] = {-0.4, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0};
  forms[3] = {0.0, 0.0, 2.0, 1e6, 0.0, std::sin(1.0), std::cos(1.0)};  // angles beyond those of the fast functions
  const std::array<Direction, 4> directions = {Direction::y, Direction::x, Direction::phi, Direction::x};
  for (const DriveForm& form : forms) EXPECT_EQ(form.at_start(), form.at(0.0));
  Octet times;
  for (std::size_t i = 0; i < Octet::kSize; ++i) times[i] = 0.13 * static_cast<double>(i);
  LoadOctet load;
  evaluate_drives(forms.data(), directions.data(), 4, times, load);
  for (std::size_t i = 0; i < Octet::kSize; ++i) {
    EXPECT_NEAR(load.y[i], forms[0].at(times[i]), 1e-14);
    EXPECT_NEAR(load.x[i], forms[1].at(times[i]) + forms[3].at(times[i]), 1e-14);
    EXPECT_NEAR(load.phi[i], forms[2].at(times[i]), 1e-14);
  }
}

}  // namespace
}  // namespace vibratory_alignment
