// Derivatives of the accelerations against differences of fourth order of the equations of motion, at random states in
// every contact, under every law of friction, on an anisotropic base whose normal turns with the part.
#include "mechanics/force_jacobian.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "../support/random_state.h"
#include "../support/touching.h"
#include "mechanics/octet_forces.h"

namespace vibratory_alignment {
namespace {

using test::anisotropic_system;
using test::random_state;
using test::states_of;

Forces forces_at(const System& system, const State& state, const ContactStates& contacts) {
  Forces forces;
  evaluate_forces(system, state, {0.3, -0.2, 0.1}, contacts, forces);
  return forces;
}

/// Largest difference of a Jacobian from differences, relative to the largest entry.
double error_of(const System& system, const State& state, const ContactStates& contacts) {
  const ForceJacobian jacobian = force_jacobian(system, state, contacts, forces_at(system, state, contacts));
  constexpr double State::*kMembers[] = {&State::x, &State::y, &State::phi, &State::vx, &State::vy, &State::omega};
  double error = 0.0, size = 0.0;
  for (int column = 0; column < 6; ++column) {
    const auto at = [&](double step) {
      State moved = state;
      moved.*kMembers[column] += step;
      const Forces f = forces_at(system, moved, contacts);
      return Eigen::Vector3d(f.ax, f.ay, f.alpha);
    };
    const double h = 1e-3;
    const Eigen::Vector3d expected = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
    const Eigen::Vector3d actual = column < 3 ? jacobian.by_position.col(column) : jacobian.by_velocity.col(column - 3);
    error = std::max(error, (actual - expected).cwiseAbs().maxCoeff());
    size = std::max(size, expected.cwiseAbs().maxCoeff());
  }
  return error / size;
}

/// Likewise of the normal forces: by the state, and of the accelerations by them.
double error_of_normal_forces(const System& system, const State& state, const ContactStates& contacts) {
  const Forces here = forces_at(system, state, contacts);
  const ForceJacobian jacobian = force_jacobian(system, state, contacts, here);
  constexpr double State::*kMembers[] = {&State::x, &State::y, &State::phi, &State::vx, &State::vy, &State::omega};
  double error = 0.0, size = 0.0;
  const auto hold_against = [&](double actual, double expected) {
    error = std::max(error, std::abs(actual - expected));
    size = std::max(size, std::abs(expected));
  };
  for (std::size_t c = 0; c < static_cast<std::size_t>(here.count); ++c) {
    const NormalJacobian& normal = jacobian.normal[c];
    for (int column = 0; column < 6; ++column) {
      const auto at = [&](double step) {
        State moved = state;
        moved.*kMembers[column] += step;
        return forces_at(system, moved, contacts).contact[c].normal_force;
      };
      const double h = 1e-3;
      hold_against(column < 3 ? normal.by_position[column] : normal.by_velocity[column - 3],
                   (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h));
    }
    // accelerations are linear in the normal forces that act
    const auto under = [&](double more) {
      NormalForcesOctet acting{};
      for (std::size_t i = 0; i < static_cast<std::size_t>(here.count); ++i) acting[i] = here.contact[i].normal_force;
      acting[c] += more;
      const StateOctet states{state.x, state.y, state.phi, state.vx, state.vy, state.omega};
      ForcesOctet forces;
      evaluate_forces_under(acting, system, states, {0.3, -0.2, 0.1}, contacts, forces);
      return Eigen::Vector3d(forces.ax[0], forces.ay[0], forces.alpha[0]);
    };
    const Eigen::Vector3d expected = under(1.0) - under(0.0);
    for (Eigen::Index axis = 0; axis < 3; ++axis) hold_against(normal.push[axis], expected[axis]);
    EXPECT_LT((under(0.0) - Eigen::Vector3d(here.ax, here.ay, here.alpha)).norm(), 1e-12);
  }
  return error / size;
}

constexpr double kDifferenceError = 1e-8;

TEST(ForceJacobian, is_the_derivative_of_the_accelerations_in_every_contact) {
  const System system = anisotropic_system();
  const std::vector<std::pair<Site, Face>> places = {
      {Site::a1, Face::bottom},     {Site::a1, Face::right_side}, {Site::a2, Face::left_side},  {Site::b1, Face::top},
      {Site::b1, Face::right_wall}, {Site::b2, Face::left_wall},  {Site::b2_floor, Face::floor}};
  std::mt19937 random(1);
  for (const auto& [site, face] : places)
    for (const Slip slip : {Slip::none, Slip::plus, Slip::minus, Slip::regularized, Slip::stick})
      for (int i = 0; i < 10; ++i)
        EXPECT_LT(error_of(system, random_state(random), states_of({{site, face, slip}})), kDifferenceError)
            << static_cast<int>(face) << " " << static_cast<int>(slip);
}

TEST(ForceJacobian, holds_several_contacts_at_once) {
  const System system = anisotropic_system();
  std::mt19937 random(2);
  for (const Slip slip : {Slip::stick, Slip::regularized, Slip::plus})
    for (int i = 0; i < 10; ++i) {
      const ContactStates contacts =
          states_of({{Site::a1, Face::bottom, Slip::stick}, {Site::b2, Face::left_wall, slip}});
      EXPECT_LT(error_of(system, random_state(random), contacts), kDifferenceError) << static_cast<int>(slip);
    }
}

TEST(ForceJacobian, tells_what_normal_forces_depend_on_and_what_they_push) {
  const System system = anisotropic_system();
  std::mt19937 random(4);
  for (const Slip slip : {Slip::none, Slip::plus, Slip::minus, Slip::regularized, Slip::stick})
    for (const Slip other : {Slip::stick, Slip::plus})
      for (int i = 0; i < 10; ++i) {
        const ContactStates contacts = states_of({{Site::a1, Face::bottom, slip}, {Site::b2, Face::left_wall, other}});
        EXPECT_LT(error_of_normal_forces(system, random_state(random), contacts), kDifferenceError)
            << static_cast<int>(slip) << " " << static_cast<int>(other);
      }
}

TEST(ForceJacobian, a_locked_axis_changes_nothing) {
  System system = anisotropic_system();
  system.phi = Axis{};
  std::mt19937 random(3);
  const State state = random_state(random);
  for (const Slip slip : {Slip::regularized, Slip::stick}) {
    const ContactStates contacts = states_of({{Site::a1, Face::bottom, slip}});
    const ForceJacobian jacobian = force_jacobian(system, state, contacts, forces_at(system, state, contacts));
    EXPECT_TRUE(jacobian.by_position.col(2).isZero(0.0) && jacobian.by_position.row(2).isZero(0.0));
    EXPECT_TRUE(jacobian.by_velocity.col(2).isZero(0.0) && jacobian.by_velocity.row(2).isZero(0.0));
    EXPECT_FALSE(jacobian.by_velocity.col(0).isZero(0.0));
  }
}

}  // namespace
}  // namespace vibratory_alignment
