// One implicit step by itself: what its equations take to be solved, when it is given up, what it follows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "../support/hard_scene.h"
#include "../support/scenes.h"
#include "mechanics/forces.h"
#include "mechanics/octet_forces.h"
#include "solver/implicit_step.h"
#include "solver/stage_equations.h"

namespace vibratory_alignment {
namespace {

/// A part that rests on the edge a1, tilted by phi; without friction if none is set.
System resting(double phi, const std::vector<std::string>& settings = {"friction=null"}) {
  Scene scene = test::scene_of(test::plain, settings);
  scene.initial.y.reset();
  scene.gripper.pressing_force = 3.0;
  scene.initial.phi = phi;
  return make_system(scene);
}

ContactStates on_edge() {
  ContactStates contacts{};
  contacts[0] = {Phase::loaded, Face::bottom};
  return contacts;
}

const DriveForms kNoDrives{};

// Equations that turn with the part take more iterations the farther it turns in the step, until they do not converge.
TEST(ImplicitStep, what_is_to_be_solved_easily_takes_six_iterations_at_most) {
  const ContactStates contacts = on_edge();
  const long in_six = 7 * StageEquations::kStages;  // and the forces once more where they have converged
  int easy = 0, hard = 0;
  for (const double phi : {0.01, 0.1, 0.2, 0.3, 0.4, 0.6}) {
    const System system = resting(phi);
    for (double h = 0.005; h < 1.0; h *= 1.2) {
      const auto solve = [&](bool easily, long& evaluations) {
        StageEquations equations(system, 1e-10);
        SolverCounts counts;
        equations.begin(system.start, kNoDrives, contacts, false, counts);
        const long before = counts.rhs_evaluations;
        const bool solved = equations.solve(h, counts, easily);
        evaluations = counts.rhs_evaluations - before;
        return solved;
      };
      long few = 0, many = 0;
      const bool easily = solve(true, few), at_all = solve(false, many);
      EXPECT_LE(few, in_six) << phi << " " << h;
      EXPECT_TRUE(at_all || !easily) << phi << " " << h;
      easy += easily;
      hard += at_all && !easily;
    }
  }
  EXPECT_GT(easy, 0);
  EXPECT_GT(hard, 0);
}

// The part slides off along a face that turns with it. With the N of each state in the residual every iteration would
// leave h^2 k times that turn.
TEST(ImplicitStep, a_normal_that_turns_takes_as_many_iterations_on_any_base) {
  constexpr double kStep = 0.01;
  for (const char* friction : {"friction=null", "friction={coefficient: 0.3, regularization: 0.2}"}) {
    for (const double stiffness : {1e4, 1e6, 1e8, 1e10}) {
      std::ostringstream base;
      base << "base={stiffness: {y: " << stiffness << "}}";
      const System system = resting(0.6, {base.str(), friction});
      StageEquations equations(system, 1e-6);
      ContactStates contacts = on_edge();
      contacts[0].slip = system.regularization > 0.0 ? Slip::regularized : Slip::none;
      SolverCounts counts;
      equations.begin(system.start, kNoDrives, contacts, false, counts);
      EXPECT_TRUE(equations.solve(kStep, counts)) << stiffness;
      EXPECT_LE(counts.rhs_evaluations, 1 + 6 * 7) << stiffness << " " << friction;
      // and the N of its places is that of its accelerations
      for (std::size_t i = 0; i < StageEquations::kStages; ++i) {
        Forces of_state;
        evaluate_forces(system, equations.stages()[i], {}, contacts, of_state);
        const double lag = of_state.contact[0].normal_force - equations.forces().contact[0].normal_force[i];
        EXPECT_LT(kStep * std::abs(lag), equations.allowed(kStep)) << stiffness << " " << friction;
      }
    }
  }
}

// The last digit of a place is worth some 1e-4 of N here.
TEST(ImplicitStep, normal_forces_are_those_that_the_accelerations_are_made_by) {
  const System system = resting(0.6, {"base={stiffness: {y: 1e12}}", "friction=null"});
  StageEquations equations(system, 1e-6);
  const ContactStates contacts = on_edge();
  SolverCounts counts;
  equations.begin(system.start, kNoDrives, contacts, false, counts);
  ASSERT_TRUE(equations.solve(0.01, counts));
  const Stages& a = equations.acceleration();
  const auto differs = [&](const Octet& normal_force, std::size_t i) {
    ForcesOctet forces;
    evaluate_forces_under({normal_force}, system, equations.stages(), equations.drive(), contacts, forces);
    return std::hypot(forces.ax[i] - a[0][i], forces.ay[i] - a[1][i]) / std::hypot(a[0][i], a[1][i]);
  };
  double most_of_states = 0.0;
  for (std::size_t i = 0; i < StageEquations::kStages; ++i) {
    EXPECT_LT(differs(equations.forces().contact[0].normal_force, i), 1e-7) << i;
    Forces of_state;
    evaluate_forces(system, equations.stages()[i], {}, contacts, of_state);
    most_of_states = std::max(most_of_states, differs(of_state.contact[0].normal_force, i));
  }
  EXPECT_GT(most_of_states, 3e-6);
}

TEST(ImplicitStep, a_step_that_is_to_be_easy_is_given_up_at_the_first_trouble) {
  const System system = resting(0.6);
  const auto take = [&](bool easily, long& rejected) {
    ImplicitStep step(system, 1e-10);
    step.leave_start();
    Segment segment;
    segment.contacts = on_edge();
    SolverCounts counts;
    const double length = step.take(system.start, kNoDrives, {10.0, 0.0, 1000, easily}, segment, counts);
    rejected = counts.rejected;
    return length;
  };
  long few = 0, many = 0;
  EXPECT_EQ(take(true, few), 0.0);
  EXPECT_GT(take(false, many), 0.0);
  EXPECT_EQ(few, 0);
  EXPECT_GT(many, 0);
}

// An iteration evaluates the forces at all stages, after one at the start. A length may take more than there has to be
// left for it.
TEST(ImplicitStep, a_step_that_has_taken_what_it_may_is_given_up) {
  const System system = resting(0.6);
  const auto evaluations = [&](long cost, long most_cost) {
    ImplicitStep step(system, 1e-10);
    step.leave_start();
    Segment segment;
    segment.contacts = on_edge();
    SolverCounts counts;
    const double length = step.take(system.start, kNoDrives,
                                    {10.0, 0.0, StepBounds::kAny, false, false, cost, most_cost}, segment, counts);
    return std::pair{length > 0.0, counts.rhs_evaluations};
  };
  constexpr long kIteration = StageEquations::kStages;
  EXPECT_EQ(evaluations(20, 20), (std::pair{false, 1 + 3 * kIteration}));
  const auto [first_holds, of_first] = evaluations(20, StepBounds::kAny);
  EXPECT_FALSE(first_holds);
  EXPECT_GT(of_first, 1 + 3 * kIteration);
  const auto [second_holds, of_both] = evaluations(of_first, of_first + kIteration);
  EXPECT_FALSE(second_holds);
  EXPECT_EQ(of_both, of_first + 2 * kIteration);
  EXPECT_TRUE(evaluations(StepBounds::kAny, StepBounds::kAny).first);
}

// 1/sqrt(k (1/m + reach^2/J)), with the stiffer direction and the part's farthest point, is the fastest that the base
// answers: five of these are short, if they are so for the excitation as well.
TEST(ImplicitStep, short_steps_follow_the_base) {
  const System system = resting(0.0);
  const ImplicitStep step(system, 1e-6);
  const double base_time = 1.0 / std::sqrt(4100.0 * (1.0 + (0.67 * 0.67 + 0.93 * 0.93) / 0.17));
  EXPECT_TRUE(step.follows_base(4.9 * base_time, kNoDrives));
  EXPECT_FALSE(step.follows_base(5.1 * base_time, kNoDrives));
  DriveForms drives{};
  drives.count = 1;
  drives.form[0] = {};
  drives.form[0].amplitude = 1.0;
  drives.form[0].frequency = 100.0;
  EXPECT_TRUE(step.follows_base(0.44 / 100.0, drives));
  EXPECT_FALSE(step.follows_base(0.46 / 100.0, drives));
}

// What rounds a place by delta makes the springs of the base ring with delta omega at most, however fast a damper or
// the tanh layer answers: faster motion is none of rounding, and is not passed over as if it were.
TEST(ImplicitStep, takes_for_rounding_what_springs_make_of_it) {
  constexpr double kStiffness = 1e6, kOmega = 1e3, kFast = 1e12, kDigits = 1e-15;
  Scene scene = test::scene_of(test::ball, {});
  test::set_base(scene, kStiffness, 0.0);
  const System system = make_system(scene);
  Segment segment;
  segment.x[0] = system.start.x;
  segment.y[0] = system.start.y;
  const double place = std::abs(system.start.x) + std::abs(system.start.y);
  ImplicitStep step(system, 1e-10);
  const auto length_over = [&](double rate, double speed) {
    return step.length_over({rate, speed}, 0.0, 1.0, kNoDrives, segment);
  };
  EXPECT_GT(length_over(kOmega, kDigits * place * kOmega), 0.0);
  EXPECT_GT(length_over(kFast, kDigits * place * kOmega), 0.0);
  EXPECT_EQ(length_over(kFast, kDigits * place * kFast), 0.0);
}

// What may be left out is measured by what the contact forces together make of the part: two walls that hold it between
// them with a million times the press add nothing to that, one alone does.
TEST(ImplicitStep, walls_that_hold_each_other_allow_no_larger_errors) {
  constexpr double kPress = 3.0, kBetweenWalls = 1e6 * kPress, kRate = 1e3;
  const System system = resting(0.0, {"contacts=[edges, corners, walls]"});
  const auto most_speed_passed_over = [&](double right, double left) {
    Segment segment;
    const auto load = [&segment](Site site, Face face, double force) {
      segment.contacts[static_cast<std::size_t>(site)] = {Phase::loaded, face, Slip::plus};
      ContactSeries& contact = segment.loaded[segment.loaded_count++];
      contact.site = site;
      contact.normal_force[0] = force;
    };
    load(Site::a1, Face::bottom, kPress);
    load(Site::b1, Face::right_wall, right);
    load(Site::b2, Face::left_wall, left);
    ImplicitStep step(system, 1e-6);
    double speed = 1e9;
    while (step.length_over({kRate, speed}, 0.0, 1.0, kNoDrives, segment) == 0.0) speed *= 0.5;
    return speed;
  };
  const double by_press = most_speed_passed_over(0.0, 0.0);
  EXPECT_EQ(most_speed_passed_over(kBetweenWalls, kBetweenWalls), by_press);
  EXPECT_GT(most_speed_passed_over(kBetweenWalls, 0.0), 1e5 * by_press);
  EXPECT_GT(most_speed_passed_over(0.0, kBetweenWalls), 1e5 * by_press);
}

}  // namespace
}  // namespace vibratory_alignment
