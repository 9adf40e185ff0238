// The solver `ode`: what is its own beside what all solvers with a fixed step do (test/solver/test_step_*.cpp).
#include <gtest/gtest.h>
#include <ode/ode.h>

#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "../support/fixed_step.h"
#include "../support/random_scenes.h"
#include "engine_ode/ode_library.h"
#include "mechanics/contact_frame.h"
#include "mechanics/system.h"
#include "trial/make_solver.h"

namespace vibratory_alignment {
namespace {

using test::distance;
using test::run;
using test::scene_of;
using test::with_solver;

double moment(const Vec2& lever, const Vec2& direction) { return lever.x * direction.y - lever.y * direction.x; }

// ODE takes the friction limit from the normal forces that it finds without friction. Friction then changes N, by as
// much as the compliance lets it: |T|/(f N) = 1/(1 + f G_nt/(G_nn + CFM/h)) of a contact that slides forward.
TEST(OdeStep, friction_limit_is_that_of_the_frictionless_normal_force) {
  const Scene scene = scene_of(test::plain, {"gripper.pressing_force=2", "initial={x: 0.21, phi: 0.02, vx: 0.5}",
                                             "excitation.frequency=9", "trial.time_limit=0.2"});
  const System system = make_system(scene);
  for (const double h : {1e-3, 1e-4}) {
    const auto inverse = [h](const Axis& axis) {
      return 1.0 / (axis.inertia + h * (axis.damping + h * axis.stiffness));
    };
    long looked = 0;
    double most = 0.0;
    run(with_solver(scene, "ode", h), [&](const Segment& g) {
      if (g.loaded_count != 1 || g.contacts[0].slip != Slip::plus) return;
      const ContactKinematics k = contact_kinematics(system, g.begin, Site::a1, Face::bottom);
      const double mn = moment(k.lever, k.normal), mt = moment(k.lever, k.tangent);
      const double gnn = k.normal.x * k.normal.x * inverse(system.x) + k.normal.y * k.normal.y * inverse(system.y) +
                         mn * mn * inverse(system.phi);
      const double gnt = k.normal.x * k.tangent.x * inverse(system.x) + k.normal.y * k.tangent.y * inverse(system.y) +
                         mn * mt * inverse(system.phi);
      const double c = std::cos(g.begin.phi), s = std::sin(g.begin.phi);
      const double softness =
          1.0 / (h * (h * stiffness_of(system, Face::bottom, c, s) + damping_of(system, Face::bottom, c, s)));
      const double ratio = std::abs(g.loaded[0].tangential_force[0]) / (0.24 * g.loaded[0].normal_force[0]);
      EXPECT_NEAR(ratio, 1.0 / (1.0 + 0.24 * gnt / (gnn + softness)), 1e-8);
      most = std::max(most, std::abs(ratio - 1.0));
      ++looked;
    });
    EXPECT_GT(looked, 50);
    EXPECT_LT(most, 20.0 * h);
  }
}

// In any scene: the base never pulls, and what a contact rubs too much is at most f times what friction changes in the
// normal forces of a step: h (h k + h_base) G beside them, G the largest mobility of a point of the part.
TEST(OdeStep, forces_leave_the_friction_cone_by_no_more_than_the_step) {
  for (const double h : {1e-3, 1e-4})
    for (unsigned seed = 1; seed <= 25; ++seed) {
      Scene s = with_solver(test::random_scene(seed), "ode", h);
      if (!s.friction) continue;
      s.trial.time_limit = 1.0;
      const double reach = s.part.half_width + s.part.base_distance;
      const double mobility = 1.0 + (s.gripper.phi.moves ? reach * reach / s.gripper.phi.inertia : 0.0);
      const double damping = std::max(s.base.damping_x, s.base.damping_y);
      const double stiffness = std::max(s.base.stiffness_x, s.base.stiffness_y);
      double largest = 0.0, excess = 0.0;
      run(s, [&](const Segment& g) {
        for (int i = 0; i < g.loaded_count; ++i) {
          const double n = g.loaded[static_cast<std::size_t>(i)].normal_force[0];
          const double t = g.loaded[static_cast<std::size_t>(i)].tangential_force[0];
          EXPECT_GE(n, 0.0);
          largest = std::max(largest, n);
          excess = std::max(excess, std::abs(t) - s.friction->coefficient * n);
        }
      });
      EXPECT_LE(excess, s.friction->coefficient * h * (h * stiffness + damping) * mobility * largest)
          << "seed " << seed;
    }
}

TEST(OdeStep, locked_motions_stay_where_they_are) {
  for (const char* locked : {"gripper.stiffness.x=null", "part.inertia=null"}) {
    const Scene scene =
        with_solver(scene_of(test::plain, {locked, "initial={x: 0.21, y: 0.95, phi: 0.02}"}), "ode", 1e-3);
    const System system = make_system(scene);
    const TrialResult result = run(scene);
    EXPECT_NE(result.final_state.y, system.start.y);
    EXPECT_EQ(system.x.moves, result.final_state.x != system.start.x);
    EXPECT_EQ(system.phi.moves, result.final_state.phi != system.start.phi);
    EXPECT_EQ(system.x.moves, result.final_state.vx != 0.0);
    EXPECT_EQ(system.phi.moves, result.final_state.omega != 0.0);
    EXPECT_GT(test::total_impacts(result), 3);
  }
}

// Springs, dampers and contacts are taken at the end of the step: none of them limits it.
TEST(OdeStep, is_stable_however_stiff_the_gripper_and_the_base) {
  const Scene scene = scene_of(test::plain, {"gripper={stiffness: {x: 1.0e+8, phi: 1.0e+9}, damping: {x: 1.0e+3, phi: "
                                             "1.0e+4}, anchor: {x: 0.23, phi: 0.007}, pressing_force: 0.27}",
                                             "base={stiffness: {y: 1.0e+10}, damping: {y: 1.0e+6}}"});
  for (const double h : {1e-2, 1e-3}) {
    double fastest = 0.0, largest = 0.0;
    const TrialResult result = run(with_solver(scene, "ode", h), [&](const Segment& g) {
      fastest = std::max({fastest, std::abs(g.end.vy), std::abs(g.end.vx), std::abs(g.end.omega)});
      for (int i = 0; i < g.loaded_count; ++i)
        largest = std::max(largest, g.loaded[static_cast<std::size_t>(i)].normal_force[0]);
    });
    EXPECT_NEAR(result.final_state.x, 0.23, 1e-6);
    EXPECT_NEAR(result.final_state.phi, 0.007, 1e-6);
    // the first step takes the part to its anchor
    EXPECT_LT(fastest, 0.03 / h);
    EXPECT_NE(result.outcome, Outcome::failed) << result.failure;
  }
}

// ERP and CFM follow the length of every step: a part at rest stays there while steps of other lengths come between.
TEST(OdeStep, steps_of_any_length_carry_the_same_load) {
  Scene scene =
      scene_of(test::plain, {"excitation.amplitude=0", "friction=null", "gripper.stiffness.x=50",
                             "gripper.damping={x: 14, y: 1.5, phi: 3}", "initial={x: 0.21}", "trial.time_limit=1"});
  const State rest = run(scene, {}, 60.0).final_state;
  scene.gripper.anchor_y = make_system(scene).y.anchor;
  scene.gripper.pressing_force.reset();
  scene.initial = {rest.x, rest.y, rest.phi, 0.0, 0.0, 0.0};
  SimulationOptions options;
  options.until = 0.4;
  Simulation simulation(with_solver(scene, "ode", 1e-3), options);
  int step = 0;
  while (simulation.advance()) {
    if (++step % 3 == 0) simulation.cut(simulation.segment().start.value() + (step % 2 == 0 ? 1e-5 : 7.3e-4));
    ASSERT_EQ(simulation.segment().loaded_count, 1);
    EXPECT_NEAR(simulation.segment().loaded[0].normal_force[0], 0.27, 0.01);
  }
  EXPECT_GT(step, 400);
  EXPECT_LT(distance(simulation.result().final_state, rest), 1e-10);
}

// Worlds in several threads, opened and closed while others run, give what one after the other gives.
TEST(OdeStep, worlds_in_threads_do_not_disturb_each_other) {
  std::vector<Scene> scenes;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    scenes.push_back(with_solver(test::random_scene(seed), "ode", 1e-3));
    scenes.back().trial.time_limit = 0.5;
  }
  std::vector<TrialResult> alone(scenes.size()), together(scenes.size());
  for (std::size_t i = 0; i < scenes.size(); ++i) alone[i] = run(scenes[i]);
  for (int repeat = 0; repeat < 3; ++repeat) {
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < scenes.size(); ++i) threads.emplace_back([&, i] { together[i] = run(scenes[i]); });
    for (std::thread& thread : threads) thread.join();
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      EXPECT_EQ(distance(alone[i].final_state, together[i].final_state), 0.0);
      EXPECT_EQ(alone[i].peak_force, together[i].peak_force);
    }
  }
}

// A solver made in one thread may run in another.
TEST(OdeStep, a_world_may_go_to_another_thread) {
  Scene scene = with_solver(scene_of(test::plain), "ode", 1e-3);
  const TrialResult here = run(scene);
  Simulation simulation(scene);
  std::thread([&] {
    while (simulation.advance()) {
    }
  }).join();
  EXPECT_EQ(distance(simulation.result().final_state, here.final_state), 0.0);
}

// What ODE has to say of a step ends the run, and is not printed.
TEST(OdeLibrary, messages_become_failures) {
  const OdeLibrary library;
  library.enter_thread();
  EXPECT_NO_THROW(OdeLibrary::check_messages());
  dMessage(3, "LCP internal error, s <= 0 (s=%.4e)", -1.0);
  try {
    OdeLibrary::check_messages();
    ADD_FAILURE() << "the message is lost";
  } catch (const SolverFailure& failure) {
    EXPECT_NE(std::string(failure.what()).find("LCP internal error"), std::string::npos);
  }
  EXPECT_NO_THROW(OdeLibrary::check_messages());
  EXPECT_THROW(dError(1, "bad argument"), SolverFailure);
}

}  // namespace
}  // namespace vibratory_alignment
