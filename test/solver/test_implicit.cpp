// The solvers `implicit` and `auto` on stiff bases: the same answers as `event`, at a cost that does not
// depend on the stiffness of a base that the part stays in contact with.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <utility>

#include "../support/hard_scene.h"
#include "../support/motion_check.h"
#include "../support/random_scenes.h"
#include "../support/reference_scene.h"
#include "../support/restitution.h"
#include "../support/runs.h"
#include "../support/scenes.h"
#include "model/scene_loader.h"
#include "solver/collocation.h"
#include "solver/event_solver.h"
#include "solver/implicit_step.h"
#include "solver/stage_equations.h"
#include "trial/make_solver.h"
#include "trial/simulation.h"

namespace vibratory_alignment {
namespace {

TrialResult run_with(Scene scene, const std::string& solver, double tolerance) {
  scene.solver.name = solver;
  scene.solver.tolerance = tolerance;
  return test::run(scene, {}, scene.trial.time_limit);
}

/// Pressed so hard that it never leaves the base, shaken across and along: sticks and slips twenty times.
Scene pressed(double stiffness, double damping_ratio) {
  Scene scene =
      test::scene_of(test::plain, {"gripper.pressing_force=3", "friction.coefficient=0.2", "trial.time_limit=5"});
  scene.initial.y.reset();
  scene.initial.phi.reset();
  scene.base.stiffness_x = scene.base.stiffness_y = stiffness;
  scene.base.damping_x = scene.base.damping_y = 2.0 * damping_ratio * std::sqrt(stiffness);
  return scene;
}

// Bounded whatever k: what is left is a rigid base. A base whose answer to a slip is below the tolerance costs less.
TEST(Implicit, cost_of_lasting_contact_does_not_depend_on_the_stiffness) {
  for (const double damping_ratio : {1.0, 10.0, 100.0}) {
    long least = 0, most = 0;
    for (const double stiffness : {1e4, 1e6, 1e8, 1e10}) {
      const TrialResult result = run_with(pressed(stiffness, damping_ratio), "implicit", 1e-6);
      ASSERT_EQ(result.outcome, Outcome::time_limit) << result.failure;
      const long cost = result.counts.rhs_evaluations;
      least = least == 0 ? cost : std::min(least, cost);
      most = std::max(most, cost);
    }
    EXPECT_LE(most, 3 * least) << "damping ratio " << damping_ratio;
  }
}

/// Touches and the end, by both.
void expect_as_event(const Scene& scene, const std::string& solver, double tolerance) {
  const TrialResult expected = run_with(scene, "event", tolerance), result = run_with(scene, solver, tolerance);
  ASSERT_EQ(result.outcome, expected.outcome) << solver << ": " << result.failure;
  EXPECT_EQ(result.impacts, expected.impacts) << solver;
  EXPECT_LT(test::distance(result.final_state, expected.final_state), 1e-5) << solver;
}

// The frequency at the start of a chirp does not tell how far a step may go: what it becomes in the step does.
TEST(Implicit, steps_follow_a_chirp) {
  const Scene scene = test::scene_of(R"(
part: {half_width: 0.6, base_distance: 0.9}
slot: {clearance: 0.09}
gripper: {damping: {y: 0.05}, pressing_force: 0.95}
base: {stiffness: {y: 1.0e8}, damping: {y: 2.0e4}}
contacts: [corners]
excitation: {amplitude: 1.0, frequency: 1.0e-3, waveform: chirp, end_frequency: 30.0, sweep_time: 20.0}
initial: {x: 0.3}
trial: {time_limit: 20}
)");
  ASSERT_GT(run_with(scene, "event", 1e-6).impacts[static_cast<std::size_t>(Spot::b1)], 10);
  for (const char* solver : {"implicit", "auto"}) expect_as_event(scene, solver, 1e-6);
}

// An excitation without amplitude asks for no steps.
TEST(Implicit, steps_do_not_follow_what_has_no_amplitude) {
  Scene scene = pressed(1e8, 1.0);
  const long alone = run_with(scene, "implicit", 1e-6).counts.steps;
  scene.excitations.push_back({});
  scene.excitations.back().amplitude = 0.0;
  scene.excitations.back().frequency = 1e4;
  EXPECT_EQ(run_with(scene, "implicit", 1e-6).counts.steps, alone);
}

// A level part on two corners, of which one slides from rest as t^3: a long step finds V = 0 within its error, at once,
// and would from there again and again.
TEST(Implicit, events_of_a_long_step_that_a_short_one_does_not_have_stop_nothing) {
  const Scene scene = test::scene_of(R"(
part: {half_width: 1.2, base_distance: 0.9, inertia: 0.2}
slot: {clearance: 0.09}
gripper: {stiffness: {x: 0.08, phi: 60.0}, damping: {x: 0.02, y: 0.05, phi: 0.03}, pressing_force: 3}
base: {stiffness: {y: 1.0e4}, damping: {y: 2.0e4}}
contacts: [corners]
friction: {coefficient: 0.5}
excitation: {direction: phi, amplitude: 5.0, frequency: 5.0}
initial: {x: 2.5}
trial: {time_limit: 2}
)");
  for (const char* solver : {"implicit", "auto", kImplicitAlone}) {
    expect_as_event(scene, solver, 1e-6);
    EXPECT_LT(run_with(scene, solver, 1e-6).counts.steps, 1000) << solver;
  }
}

// ... and cost `auto` no more steps than `implicit`.
TEST(Implicit, automatic_choice_finds_no_events_that_are_none_again_and_again) {
  for (const auto& [stiffness, damping_ratio] : {std::pair{1e7, 0.01}, {1e7, 0.1}, {1e8, 1.0}}) {
    const Scene scene = pressed(stiffness, damping_ratio);
    const long implicit = run_with(scene, "implicit", 1e-4).counts.steps;
    EXPECT_LT(run_with(scene, "auto", 1e-4).counts.steps, 1.2 * static_cast<double>(implicit)) << stiffness;
  }
}

// After a thousand turns phi is known to fewer digits, and so is what they make of the forces.
TEST(Implicit, steps_are_as_long_after_a_thousand_turns) {
  const auto steps = [](double turns) {
    Scene scene = pressed(1e8, 1.0);
    scene.initial.phi = scene.gripper.anchor_phi = 2.0 * 3.14159265358979323846 * turns;
    return run_with(scene, "implicit", 1e-6).counts.steps;
  };
  EXPECT_LT(steps(1000.0), 2 * steps(0.0));
}

// On the stiffest bases rounding moves an event whatever the length of its step, which is not taken again for that.
TEST(Implicit, events_that_only_rounding_moves_are_not_sought_again) {
  const auto cost = [](double stiffness) {
    Scene scene = test::hard_scene("lasting_contact");
    test::set_base(scene, stiffness, 1.0);
    return static_cast<double>(run_with(scene, "implicit", scene.solver.tolerance).counts.rhs_evaluations);
  };
  EXPECT_LE(cost(1e10), 1.05 * cost(1e8));
}

// The stiffer the base, the nearer to a rigid one: differences fall as 1/k.
TEST(Implicit, a_stiff_base_tends_to_a_rigid_one) {
  const State rigid = run_with(pressed(1e10, 1.0), "implicit", 1e-6).final_state;
  const double at_1e6 = std::abs(run_with(pressed(1e6, 1.0), "implicit", 1e-8).final_state.x - rigid.x);
  const double at_1e8 = std::abs(run_with(pressed(1e8, 1.0), "implicit", 1e-8).final_state.x - rigid.x);
  EXPECT_NEAR(at_1e6 / at_1e8, 100.0, 30.0);
}

TEST(Implicit, agrees_with_the_series_on_a_stiff_base) {
  for (const double damping_ratio : {0.3, 1.0, 3.0}) {
    const Scene scene = pressed(1e6, damping_ratio);
    const State series = run_with(scene, "event", 1e-10).final_state;
    EXPECT_LT(test::distance(run_with(scene, "implicit", 1e-8).final_state, series), 1e-7) << damping_ratio;
    EXPECT_LT(test::distance(run_with(scene, "auto", 1e-8).final_state, series), 1e-7) << damping_ratio;
  }
}

// In the thin layer of regularised friction the part creeps: a stiff damper.
TEST(Implicit, follows_the_creep_in_a_thin_layer_of_friction) {
  Scene scene = pressed(1e4, 1.0);
  long steps = 0;
  for (const double eps : {1e-3, 1e-4}) {
    scene.friction->regularization = eps;
    const State series = run_with(scene, "event", 1e-10).final_state;
    const TrialResult implicit = run_with(scene, "implicit", 1e-8);
    EXPECT_LT(test::distance(implicit.final_state, series), 1e-6) << eps;
    if (steps > 0) {
      EXPECT_LT(implicit.counts.steps, 2 * steps) << eps;
    }
    steps = implicit.counts.steps;
  }
}

// After a touch the base rings for as long as it is stiff: no step may pass over the rebound, however long it could be.
TEST(Implicit, follows_every_rebound) {
  for (const double k : {1e6, 1e9, 1e12}) {
    Scene scene = test::hard_scene("stiff_bounce", {"trial.time_limit=50"});
    test::set_base(scene, k, 0.3);
    double speed = 0.0, restitution = 0.0;
    scene.solver.name = "implicit";
    test::run(scene, [&](const Segment& g) {
      for (int i = 0; i < g.event_count; ++i) {
        if (g.events[static_cast<std::size_t>(i)].kind == EventKind::touch) speed = -g.end.vy;
        if (g.events[static_cast<std::size_t>(i)].kind == EventKind::release && restitution == 0.0)
          restitution = g.end.vy / speed;
      }
    });
    EXPECT_NEAR(restitution, test::linear_restitution(0.3), 10.0 / std::sqrt(k)) << k;
  }
}

// The series take no part in implicit steps alone: in a bounce they follow the base themselves, to the same
// restitution.
TEST(Implicit, steps_alone_follow_every_rebound) {
  for (const double k : {1e6, 1e9, 1e12}) {
    Scene scene = test::hard_scene("stiff_bounce", {"trial.time_limit=50"});
    test::set_base(scene, k, 0.3);
    scene.solver.name = kImplicitAlone;
    scene.solver.tolerance = 1e-4;
    double speed = 0.0, restitution = 0.0;
    int by_series = 0;
    test::run(scene, [&](const Segment& g) {
      by_series += g.loaded_count > 0 && !g.coarse;
      for (int i = 0; i < g.event_count; ++i) {
        if (g.events[static_cast<std::size_t>(i)].kind == EventKind::touch) speed = -g.end.vy;
        if (g.events[static_cast<std::size_t>(i)].kind == EventKind::release && restitution == 0.0)
          restitution = g.end.vy / speed;
      }
    });
    EXPECT_NEAR(restitution, test::linear_restitution(0.3), 10.0 / std::sqrt(k) + 1e-3) << k;
    EXPECT_EQ(by_series, 0) << k;
  }
}

// A part that starts deep in the base is thrown off as fast as its spring throws, v^2 = k d^2: its first step, however
// long it could be, must not find it at rest.
TEST(Implicit, follows_what_the_base_throws_off) {
  for (const double k : {1e4, 1e6, 1e8})
    for (const double tolerance : {1e-3, 1e-5, 1e-8}) {
      constexpr double kDepth = 0.01;
      Scene scene = test::scene_of(test::ball, {"trial.time_limit=8"});
      scene.excitations.clear();
      scene.initial.y = scene.part.base_distance - kDepth;
      test::set_base(scene, k, 0.0);
      scene.solver.name = "implicit";
      scene.solver.tolerance = tolerance;
      double speed = 0.0;
      test::run(scene, [&](const Segment& g) {
        for (int i = 0; i < g.event_count; ++i)
          if (g.events[static_cast<std::size_t>(i)].kind == EventKind::release && speed == 0.0) speed = g.end.vy;
      });
      // the gripper's spring and press, of order one, have acted over the depth
      EXPECT_NEAR(speed / (std::sqrt(k) * kDepth), 1.0, 2.0 / (k * kDepth) + 10.0 * tolerance) << k << " " << tolerance;
    }
}

// A ring at the start, of a small share of the sag under the press, goes on for ever without damping: it is passed over
// where the tolerance allows its amplitude, and followed where it does not.
TEST(Implicit, passes_over_a_ring_at_the_start_below_its_tolerance) {
  constexpr double kPress = 2.0, kStiffness = 1e6, kShare = 0.25, kTime = 2.0;
  Scene scene = test::scene_of(test::ball, {"gripper={pressing_force: 2.0}", "trial.time_limit=2"});
  scene.excitations.clear();
  scene.initial.y = scene.part.base_distance - (1.0 + kShare) * kPress / kStiffness;
  test::set_base(scene, kStiffness, 0.0);
  constexpr double kPeriods = kTime * 1e3 / 6.283;
  EXPECT_LT(run_with(scene, "implicit", 1e-4).counts.steps, 20);
  EXPECT_GT(run_with(scene, "implicit", 1e-9).counts.steps, 0.5 * kPeriods);
}

// N swings between 1 - s and 1 + s times the press. Friction that holds at the one may not at the other: a ring is
// passed over at the start where N begins within a factor of two of what the step goes on with.
TEST(Implicit, follows_a_ring_at_the_start_that_more_than_halves_or_doubles_a_force) {
  constexpr double kPress = 2.0, kStiffness = 1e8, kTime = 0.1;
  constexpr double kPeriods = kTime * 1e4 / 6.283;
  Scene scene = test::scene_of(test::ball, {"gripper={pressing_force: 2.0}", "trial.time_limit=0.1"});
  scene.excitations.clear();
  test::set_base(scene, kStiffness, 0.0);
  for (const double share : {-0.75, -0.25, 0.75}) {
    scene.initial.y = scene.part.base_distance - (1.0 + share) * kPress / kStiffness;
    const long steps = run_with(scene, "implicit", 1e-4).counts.steps;
    if (share < -0.5)
      EXPECT_GT(steps, 0.5 * kPeriods) << share;
    else
      EXPECT_LT(steps, 20) << share;
  }
}

// A start 1 + s times as deep as the sag rings by s times the press, and lifts off at cos omega t = -1/s however small
// the ring is. No step may pass over it, though its amplitude is far below the tolerance.
TEST(Implicit, follows_a_ring_at_the_start_that_lifts_the_part) {
  constexpr double kPress = 2.0, kShare = 4.0;
  for (const double stiffness : {1e8, 1e10}) {
    Scene scene = test::scene_of(test::ball, {"gripper={pressing_force: 2.0}", "trial.time_limit=0.01"});
    scene.excitations.clear();
    scene.initial.y = scene.part.base_distance - (1.0 + kShare) * kPress / stiffness;
    test::set_base(scene, stiffness, 0.0);
    scene.solver.tolerance = 1e-4;
    for (const char* solver : {"implicit", "auto"}) {
      scene.solver.name = solver;
      double lifts = 0.0;
      test::run(scene, [&](const Segment& g) {
        for (int i = 0; i < g.event_count; ++i)
          if (g.events[static_cast<std::size_t>(i)].kind == EventKind::release && lifts == 0.0) lifts = g.end_time();
      });
      // the depth is known to the last digit of the place
      const double digits = 1e-15 * stiffness / kPress;
      EXPECT_NEAR(lifts * std::sqrt(stiffness), std::acos(-1.0 / kShare), 1e-6 + digits) << solver << " " << stiffness;
    }
  }
}

// When the press is let go from F to F', N swings about F' by F - F', and falls to zero at cos omega t = -F'/(F - F').
TEST(Implicit, follows_the_ring_after_a_jump_of_the_press) {
  constexpr double kBefore = 2.0, kAfter = 0.2, kJump = 1.0;
  for (const double stiffness : {1e4, 1e6, 1e8})
    for (const char* solver : {"implicit", kImplicitAlone, "auto"})
      for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
        Scene scene = test::scene_of(test::ball, {"gripper={pressing_force: 2.0}", "trial.time_limit=8"});
        scene.initial.y.reset();
        test::set_base(scene, stiffness, 0.0);
        scene.solver.name = solver;
        scene.solver.tolerance = tolerance;
        Simulation simulation(scene, {});
        while (simulation.advance() && simulation.segment().end_time() < kJump) {
        }
        simulation.cut(kJump);
        simulation.set_pressing_force(kAfter);
        double release = 0.0;
        while (release == 0.0 && simulation.advance()) {
          const Segment& g = simulation.segment();
          for (int i = 0; i < g.event_count; ++i)
            if (g.events[static_cast<std::size_t>(i)].kind == EventKind::release) release = g.end_time();
        }
        const double expected = std::acos(-kAfter / (kBefore - kAfter)) / std::sqrt(stiffness);
        EXPECT_NEAR((release - kJump) / expected, 1.0, 1e-2) << stiffness << " " << solver << " " << tolerance;
      }
}

// Beyond what rounding leaves of the velocities there is nothing to converge to.
TEST(Implicit, smallest_tolerances_cost_no_more_than_their_digits) {
  for (const char* name : {"shaken_table", "chatter", "lasting_contact"}) {
    Scene scene = test::hard_scene(name);
    const auto evaluations = [&](double tolerance) {
      const TrialResult result = run_with(scene, "implicit", tolerance);
      EXPECT_NE(result.outcome, Outcome::failed) << name << ": " << result.failure;
      return result.counts.rhs_evaluations;
    };
    const long usual = evaluations(1e-11);
    for (const double tolerance : {1e-12, 1e-13, 1e-14})
      EXPECT_LT(evaluations(tolerance), 2 * usual) << name << tolerance;
  }
}

TEST(Implicit, automatic_choice_takes_few_steps_where_either_does) {
  for (const double tolerance : {1e-6, 1e-8})
    for (const double stiffness : {1e6, 1e7, 1e8, 1e9, 1e10}) {
      const Scene scene = pressed(stiffness, 10.0);
      const auto implicit = static_cast<double>(run_with(scene, "implicit", tolerance).counts.steps);
      EXPECT_LT(run_with(scene, "auto", tolerance).counts.steps, 1.4 * implicit) << stiffness;
    }
  // a start at rest, whose ring is passed over: its speed is the rate of the force, 7, over the stiffness
  for (const double stiffness : {1e7, 1e8})
    for (const double damping_ratio : {0.01, 0.1, 1.0, 10.0}) {
      Scene scene = test::hard_scene("lasting_contact");
      test::set_base(scene, stiffness, damping_ratio);
      EXPECT_EQ(run_with(scene, "auto", 1e-6).counts.steps, run_with(scene, "implicit", 1e-6).counts.steps)
          << stiffness << " " << damping_ratio;
    }
  // impacts are over before an implicit step is thought of: the answer is that of the series to the bit
  Scene bouncing = test::scene_of_reference(reference::referenceCases()[0]);
  bouncing.friction->regularization.reset();
  const State a = run_with(bouncing, "event", 1e-8).final_state, b = run_with(bouncing, "auto", 1e-8).final_state;
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.omega, b.omega);
}

// A slip or stick event makes a stiff base ring, hardly damped: implicit steps that follow the ring go no farther than
// half of what the series do, and cost as much.
TEST(Implicit, rings_after_slip_events_are_left_to_the_series) {
  for (const double stiffness : {1e5, 1e6, 1e7}) {
    Scene scene = pressed(stiffness, 0.1);
    scene.solver.name = "auto";
    scene.solver.tolerance = 1e-6;
    const double radian = 1.0 / std::sqrt(stiffness);
    long slips = 0, following = 0;
    test::run(scene, [&](const Segment& g) {
      for (int i = 0; i < g.event_count; ++i) slips += g.events[static_cast<std::size_t>(i)].kind == EventKind::slip;
      following += g.coarse && g.event_count == 0 && g.duration < 2.0 * radian;
    });
    EXPECT_GT(slips, 5) << stiffness;
    EXPECT_LE(following, 4 * slips) << stiffness;
  }
}

// A base without a damper, kicked twice a period, under a thin tanh layer: after each kick the first implicit step is
// as short as the last ones before it had to be, and grows by five times with each. One that would not pay is not
// tried.
constexpr char kKicked[] = R"(
part: {half_width: 0.14327078333104765, base_distance: 2.0466699283927987, inertia: 0.009268976822390971}
slot: {clearance: 0.011215609417885845}
gripper:
  stiffness: {phi: 3.2822604340448884}
  damping: {y: 0.05299719627815023, phi: 0.1324704311693375}
  anchor: {x: 0.011390566103434273, y: 2.6744905723007117}
base: {stiffness: {y: 1718.7821613827412}}
contacts: [edges, corners]
friction: {coefficient: 0.19665325588976607, regularization: 0.0006969330282191599}
weight: 0.23835610024084802
excitation:
  - {amplitude: 1, frequency: 23.104610928587537, phase: 3.6320733641778684, direction: y}
  - {amplitude: 0.46584695910633345, frequency: 3.00774792232322, phase: 1.2642614054473338, direction: y,
     waveform: square}
initial: {x: 0.011390566103434273, y: 1.921075049709474, phi: -0.032978719663615264}
trial: {time_limit: 1.7107606220489322}
solver: {step_limit: 20000}
)";

TEST(Implicit, automatic_choice_goes_on_after_a_ring_however_short_the_last_implicit_steps_were) {
  const Scene scene = load_scene(YAML::Load(kKicked), "kicked");
  const long implicit = run_with(scene, "implicit", 1e-6).counts.steps;
  ASSERT_GT(run_with(scene, "event", 1e-6).counts.steps, 10 * implicit);
  EXPECT_LT(run_with(scene, "auto", 1e-6).counts.steps, 1.4 * static_cast<double>(implicit));
}

// A part that only moves along the insertion, wedged between two edges, where friction holds: T is found stage by stage
// (docs/implicit_steps.md "All stages at once"), so that an implicit step costs several times what it gains.
constexpr char kWedged[] = R"(
part: {half_width: 0.10145, base_distance: 1.30807}
slot: {clearance: 0.0001422}
gripper:
  stiffness: {phi: 0.31578}
  damping: {x: 0.00032, y: 0.002738, phi: 0.18647}
  anchor: {x: 0.07491, y: 1.50332, phi: 0.006864}
base: {stiffness: {x: 210.985, y: 210.985}}
contacts: [edges, corners]
friction: {coefficient: 2.40574}
excitation:
  - {amplitude: 1, frequency: 43.9438, phase: -8.71299, direction: y}
  - {amplitude: -1.17212, frequency: 1.10554, direction: y}
initial: {x: 0.07491, y: 1.22162, phi: -0.040185, vx: -0.1958, vy: -0.36652, omega: -3.48863}
trial: {time_limit: 1.65943, aligned_depth: 0.02616}
solver: {tolerance: 1.0e-4}
)";

TEST(Implicit, automatic_choice_knows_that_what_is_held_stage_by_stage_is_dear) {
  Scene scene = load_scene(YAML::Load(kWedged), "wedged");
  const auto implicit_steps_of = [&](const char* solver) {
    scene.solver.name = solver;
    long steps = 0;
    test::run(scene, [&](const Segment& g) { steps += g.coarse; });
    return steps;
  };
  const long implicit = implicit_steps_of("implicit");
  ASSERT_GT(implicit, 30);
  EXPECT_LT(implicit_steps_of("auto"), implicit / 4);
}

// Early only in contact that has settled: four steps of the series since an event, or ten in one contact. Trials that
// begin with an implicit step pass over a ring of the start.
TEST(Implicit, automatic_choice_first_waits_for_contact_to_settle) {
  int early = 0;
  for (unsigned seed = 1; seed <= 1000; ++seed) {
    Scene scene = test::random_scene(seed);
    scene.solver.name = "auto";
    scene.solver.tolerance = 1e-4;
    scene.solver.step_limit = 200;  // the first one comes soon
    int in_contact = 0, since_event = 0;
    bool first = true;
    test::run(scene, [&](const Segment& g) {
      if (g.coarse && first) {
        const bool starts_with_it = g.start.value() == 0.0;
        EXPECT_TRUE(starts_with_it || since_event >= 4 || in_contact >= 10) << "seed " << seed;
        early += !starts_with_it && in_contact < 10;
        first = false;
      }
      in_contact = g.loaded_count > 0 ? in_contact + 1 : 0;
      since_event = g.loaded_count > 0 && g.event_count == 0 ? since_event + 1 : 0;
    });
  }
  EXPECT_GT(early, 10);
}

// A part wedged at rest is aligned from the start: the first series step tells, and nothing else is asked.
TEST(Implicit, automatic_choice_asks_no_implicit_step_where_the_trial_ends_at_once) {
  for (const char* name : {"wedging", "jamming"}) {
    Scene scene = test::hard_scene(name);
    scene.trial.inserted_depth.reset();
    scene.solver.name = "event";
    const TrialResult series = test::run(scene);
    scene.solver.name = "auto";
    const TrialResult automatic = test::run(scene);
    EXPECT_EQ(series.outcome, Outcome::aligned) << name;
    EXPECT_EQ(automatic.counts.steps, 1) << name;
    EXPECT_EQ(automatic.counts.rhs_evaluations, series.counts.rhs_evaluations) << name;
  }
}

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
TEST(Implicit, what_is_to_be_solved_easily_takes_six_iterations_at_most) {
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
TEST(Implicit, a_normal_that_turns_takes_as_many_iterations_on_any_base) {
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
TEST(Implicit, normal_forces_are_those_that_the_accelerations_are_made_by) {
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

TEST(Implicit, a_step_that_is_to_be_easy_is_given_up_at_the_first_trouble) {
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
TEST(Implicit, a_step_that_has_taken_what_it_may_is_given_up) {
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

// Friction is decided by the series. Where the polynomials of an implicit step say the contrary at its start (N and V
// begin with a zero of second order, or a creep ends that the step passes over), the same events would follow each
// other for ever. The final states are those of `event` up to what small errors make of the slips before.
TEST(Implicit, steps_that_contradict_what_friction_has_decided_are_left_to_the_series) {
  const char* const scenes[] = {
      // touches without depth or speed, on a base without damping
      R"(part: {half_width: 1.9, base_distance: 0.9, inertia: 0.4}
slot: {clearance: 0.01}
gripper: {stiffness: {x: 0.7, phi: 0.02}, anchor: {y: 0.3, phi: 0}}
base: {stiffness: {y: 5000}}
contacts: [edges]
friction: {coefficient: 0.3}
excitation: {amplitude: 1, frequency: 2.6}
initial: {x: 0.5, y: 0.9, phi: 0}
trial: {time_limit: 3})",
      // slides and stops within a step that passes over the ring
      R"(part: {half_width: 0.21107143375190934, base_distance: 1.5351490899179907}
slot: {clearance: 0.032905560760169233}
gripper: {damping: {x: 0.07, y: 0.09, phi: 0.0001}, anchor: {x: -0.18, phi: 0.0243}, pressing_force: 0.27}
base: {stiffness: {x: 250000, y: 44000}, damping: {x: 960, y: 60}}
contacts: [edges]
friction: {coefficient: 0.15}
excitation: {amplitude: -0.54, frequency: 1.67}
initial: {x: -0.1634, phi: 0.0243}
trial: {time_limit: 0.36})",
      // creeps to rest between top and wall, one corner sticking
      R"(part: {half_width: 0.548, base_distance: 0.383, inertia: 0.484}
slot: {clearance: 0.103, depth: 0.72}
gripper: {stiffness: {x: 0.4446, phi: 2.705}, damping: {x: 0.0913, phi: 0.737}, anchor: {x: 0, phi: 0}, pressing_force: 0.2012}
base: {stiffness: {x: 71000, y: 73140}, damping: {x: 90.4, y: 1685}}
contacts: [corners, walls]
friction: {coefficient: 0.7253}
excitation: {amplitude: -0.0996, frequency: 1}
initial: {x: 0.1}
trial: {time_limit: 3.845})",
      // a corner that sticks leaves the edge, N and T at zero together, with the last digits
      // of the tilt for V
      R"(part: {half_width: 0.6395941729966813, base_distance: 1.4948799687257952, inertia: 0.21621873460731952}
slot: {clearance: 0.0212043518220212}
gripper: {stiffness: {phi: 26.09061502335928}, damping: {x: 0.00043059553036305684, phi: 4.750275682727251}, anchor: {x: 0.08611030628744135, phi: 0}, pressing_force: 0.09654673033386857}
base: {stiffness: {x: 3515.6456005580226, y: 420.5690685475413}, damping: {y: 2.8578727042586585}}
contacts: [corners, walls]
friction: {coefficient: 0.4740621413860048}
excitation: {amplitude: 1, frequency: 4.2000178268768655}
initial: {x: 0.08611030628744135, y: 1.717180210492156, phi: 0, vx: 0.008894950879891844, vy: -0.009582710210639406, omega: -0.019394772390858562}
trial: {time_limit: 5.714212137189151})"};
  for (const char* text : scenes) {
    const Scene scene =
        load_scene(YAML::Load(std::string("name: contradiction\nunits: dimensionless\n") + text), "test");
    const State expected = run_with(scene, "event", 1e-8).final_state;
    for (const char* solver : {"implicit", "auto"})
      for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-8}) {
        const TrialResult result = run_with(scene, solver, tolerance);
        EXPECT_EQ(result.failure, "") << solver << " " << tolerance;
        EXPECT_NEAR(result.final_state.x, expected.x, 1e-3) << solver << " " << tolerance;
        EXPECT_NEAR(result.final_state.y, expected.y, 1e-3) << solver << " " << tolerance;
      }
  }
}

// A corner deep in a wall starts at its very top and sticks: it may not run off by the error of a step. The final state
// is that of `event`.
TEST(Implicit, a_foot_that_sticks_at_the_end_of_its_face_stays_there) {
  const Scene scene = load_scene(YAML::Load(R"(name: end_of_face
units: dimensionless
part: {half_width: 0.19398107554746835, base_distance: 0.2981012823672499, inertia: 0.039428841581522454}
slot: {clearance: 0.011887989696827386}
gripper: {stiffness: {x: 0.11888397901576861, phi: 0.0880687755753846}, damping: {x: 0.5709452652435159, y: 0.16065215005540467}, anchor: {x: 0.0972855057006014, phi: 0}, pressing_force: 0.1471295256567219}
base: {stiffness: {x: 2392.1449805555353, y: 836.9704598976714}, damping: {x: 1.7782787630033254}}
contacts: [edges, walls]
friction: {coefficient: 0.805554218876793}
excitation: {amplitude: 1, frequency: 5.837379297443074, phase: -5.390296541249646}
initial: {x: 0.08504835377008968, y: 0.32884882128120246, phi: -0.18612138467158448, vx: 0, vy: 0, omega: 0}
trial: {time_limit: 0.47683951821407833})"),
                                 "test");
  const State expected = run_with(scene, "event", 1e-10).final_state;
  for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
    const TrialResult result = run_with(scene, "implicit", tolerance);
    EXPECT_LT(test::distance(result.final_state, expected), 100.0 * tolerance) << tolerance;
  }
}

// What is found inside a long step lies elsewhere in the step that is taken again to end there: that one is to end
// where its own event is. There N is zero, and a base without damping has let go of the point.
TEST(Implicit, a_release_is_where_its_step_ends) {
  long releases = 0;
  for (const char* damping : {"base.damping.y=0", "base.damping.y=20", "base.damping.y=60", "base.damping.y=150"})
    for (const char* law : {"friction.regularization=0.002", "friction.coefficient=0.2"}) {
      Scene scene = test::scene_of(test::plain, {damping, law, "trial.time_limit=8"});
      scene.solver.name = "implicit";
      scene.solver.tolerance = 1e-4;
      Simulation simulation(scene);
      while (simulation.advance()) {
        const Segment& s = simulation.segment();
        for (int i = 0; i < s.event_count && s.coarse; ++i) {
          if (s.events[static_cast<std::size_t>(i)].kind != EventKind::release) continue;
          const ContactSeries& contact = s.loaded[0];
          ++releases;
          EXPECT_NEAR(value_at(contact.normal_force, s.order, s.duration), 0.0, 1e-10 * contact.normal_force[0]);
        }
      }
    }
  EXPECT_GT(releases, 20);
}

// In the tanh layer a contact is stiff as long as N is large: a step up to its release sees at its start nothing of the
// slip in which it ends.
// A corner that the base has left, and that it meets again while an edge slides in the tanh layer.
TEST(Implicit, a_reload_is_where_the_state_has_it) {
  const Scene scene = test::scene_of(R"(
part: {half_width: 0.2, base_distance: 2, inertia: 0.0013}
slot: {clearance: 0.002}
gripper: {stiffness: {x: 0, phi: 0.5}, damping: {x: 0, y: 0, phi: 0}, anchor: {x: 0, phi: 0.003}, pressing_force: 0.3}
base: {stiffness: {x: 2.7e+03, y: 2.7e+03}, damping: {x: 4e+02, y: 4e+02}}
contacts: [edges, corners]
friction: {coefficient: 1, regularization: 0.0007}
excitation: {amplitude: 1, frequency: 4}
initial: {x: 0, vx: 0, vy: 0, omega: 0}
trial: {time_limit: 7}
solver: {name: implicit, tolerance: 1e-6, step_limit: 20000}
)");
  const System system = make_system(scene);
  Simulation simulation(scene);
  int reloads = 0;
  while (simulation.advance()) {
    const Segment& segment = simulation.segment();
    for (int i = 0; i < segment.event_count; ++i) {
      const Event& event = segment.events[i];
      if (!segment.coarse || event.kind != EventKind::reload) continue;
      const Face face = segment.contacts[static_cast<std::size_t>(event.site)].face;
      const ContactKinematics k = contact_kinematics(system, segment.end, event.site, face);
      const double spring = system.stiffness_y * k.depth;
      EXPECT_NEAR(spring + system.damping_y * k.depth_rate, 0.0, 1e-12);
      ++reloads;
    }
  }
  EXPECT_GT(reloads, 0);
}

TEST(Implicit, follows_the_slip_of_a_contact_that_is_released_in_the_tanh_layer) {
  const Scene scene = load_scene(YAML::Load(R"(name: released_in_the_layer
units: dimensionless
part: {half_width: 0.165, base_distance: 1.2613, inertia: 0.012565}
slot: {clearance: 0.000553}
gripper: {stiffness: {x: 0}, anchor: {x: 0.12228, phi: 0}, pressing_force: 0.6639}
base: {stiffness: {x: 253.13, y: 730.38}, damping: {y: 6.373}}
contacts: [edges, corners]
friction: {coefficient: 4.0815, regularization: 0.0009076}
excitation:
  - {amplitude: 1, frequency: 0.54377}
  - {amplitude: 0.22208, frequency: 13.513, direction: phi}
initial: {x: 0.12228, y: 1.18865, phi: 0.00475, vx: -1.8095, vy: -0.72854, omega: -5.7514}
trial: {time_limit: 0.5})"),
                                 "test");
  const State expected = run_with(scene, "event", 1e-10).final_state;
  for (const double tolerance : {4e-7, 2e-7, 1e-7})
    EXPECT_LT(test::distance(run_with(scene, "implicit", tolerance).final_state, expected), tolerance) << tolerance;
}

// A part that starts at rest on a stiff base whose static place moves rings with that speed. The ring is small, but
// once the part is released it flies with the ring's speed: the place at the end is that of `event`.
TEST(Implicit, passes_over_no_ring_whose_speed_shows_after_a_release) {
  const Scene scene = load_scene(YAML::Load(R"(name: ring_of_speed
units: dimensionless
part: {half_width: 0.5, base_distance: 0.8}
slot: {clearance: 0.01}
gripper: {stiffness: {x: 0}, anchor: {x: 0.2, phi: 0}, pressing_force: 0.6}
base: {stiffness: {y: 40000}}
contacts: [edges]
excitation: {amplitude: 1.5, frequency: 0.7}
initial: {x: 0.2}
trial: {time_limit: 9})"),
                                 "test");
  const TrialResult expected = run_with(scene, "event", 1e-12);
  ASSERT_GT(expected.impacts[0] + expected.impacts[1], 0);
  for (const char* solver : {"implicit", "auto"})
    for (const double tolerance : {1e-6, 1e-7, 1e-8}) {
      const State end = run_with(scene, solver, tolerance).final_state;
      EXPECT_LT(test::distance(end, expected.final_state), 100.0 * tolerance) << solver << " " << tolerance;
    }
}

// Between the contacts in which implicit steps go the part flies in closed form, which follows all there is; without a
// damper it does so as soon as it is released.
TEST(Implicit, flights_are_not_coarse) {
  int at_once = 0;
  for (const char* law : {"friction.regularization=0.002", "friction.coefficient=0.2"}) {
    Scene scene = test::scene_of(test::plain, {"base.damping={x: 0, y: 0}", law, "trial.time_limit=8"});
    scene.solver.name = "implicit";
    scene.solver.tolerance = 1e-4;
    bool coarse = false;
    test::run(scene, [&](const Segment& g) {
      at_once += coarse && g.flight != nullptr;
      coarse = g.coarse;
      EXPECT_FALSE(g.coarse && g.loaded_count == 0) << g.end_time();
    });
  }
  EXPECT_GT(at_once, 0);
}

// 1/sqrt(k (1/m + reach^2/J)), with the stiffer direction and the part's farthest point, is the fastest that the base
// answers: five of these are short, if they are so for the excitation as well.
TEST(Implicit, short_steps_follow_the_base) {
  const System system = resting(0.0);
  const ImplicitStep step(system, 1e-6);
  const double base_time = 1.0 / std::sqrt(4100.0 * (1.0 + (0.67 * 0.67 + 0.93 * 0.93) / 0.17));
  EXPECT_TRUE(step.follows_base(4.9 * base_time, kNoDrives));
  EXPECT_FALSE(step.follows_base(5.1 * base_time, kNoDrives));
  DriveForms drives{};
  drives.count = 1;
  drives.form[0].frequency = 100.0;
  EXPECT_TRUE(step.follows_base(0.44 / 100.0, drives));
  EXPECT_FALSE(step.follows_base(0.46 / 100.0, drives));
}

// Rounding may leave nothing, or a last digit, of the way to a kink.
TEST(Implicit, goes_over_every_kink_of_the_excitation) {
  for (const Waveform waveform : {Waveform::square, Waveform::triangle})
    for (const char* friction : {"null", "{coefficient: 0.3, regularization: 0.2}"})
      for (const double stiffness : {3e3, 3e4, 3e5})
        for (const double frequency : {3.0, 8.4, 11.1, 16.5, 21.9, 30.0}) {
          Scene scene = test::scene_of(
              test::plain, {"gripper.pressing_force=2", "trial.time_limit=60", std::string("friction=") + friction});
          scene.initial.y.reset();
          scene.excitations[0].waveform = waveform;
          scene.excitations[0].amplitude = 0.05;
          scene.excitations[0].frequency = frequency;
          scene.base.stiffness_x = scene.base.stiffness_y = stiffness;
          scene.base.damping_x = scene.base.damping_y = 0.3 * std::sqrt(stiffness);
          const TrialResult result = run_with(scene, "implicit", 1e-8);
          EXPECT_NE(result.outcome, Outcome::failed)
              << (waveform == Waveform::square ? "square" : "triangle") << ", friction " << friction << ", "
              << stiffness << ", " << frequency << ": " << result.failure;
        }
}

// While the base rings, for 1/(zeta sqrt(k)), the series go a fraction of a radian of it; after that farther than
// implicit steps for their cost.
TEST(Implicit, automatic_choice_goes_back_to_the_series_once_a_ring_has_decayed) {
  Scene scene = test::hard_scene("lasting_contact");
  test::set_base(scene, 1e3, 0.1);
  scene.solver.name = "auto";
  double implicit_time = 0.0;
  test::run(scene, [&](const Segment& g) { implicit_time += g.coarse ? g.duration : 0.0; });
  EXPECT_GT(implicit_time, 0.0);
  EXPECT_LT(implicit_time, 0.3 * scene.trial.time_limit);
}

// After a kink an implicit step would have to follow the ring, hardly farther than one of the series. Once the ring has
// decayed it passes over what hundreds of the others follow.
TEST(Implicit, rings_after_kinks_are_left_to_the_series) {
  for (const double stiffness : {3e5, 3e6, 3e7})
    for (const char* solver : {"implicit", "auto"}) {
      Scene scene = pressed(stiffness, 1.0);
      scene.excitations[0].waveform = Waveform::square;
      scene.excitations[0].amplitude = 0.05;
      scene.excitations[0].frequency = 5.0;
      scene.friction = Friction{0.3, {}};
      scene.trial.time_limit = 20.0;
      const long series_steps = run_with(scene, "event", 1e-6).counts.steps;
      scene.solver.name = solver;
      scene.solver.tolerance = 1e-6;
      bool after_kink = false;
      long kinks = 0, by_series = 0;
      test::run(scene, [&](const Segment& g) {
        EXPECT_FALSE(after_kink && g.coarse) << stiffness << solver;
        after_kink = g.event_count > 0 && g.events[0].kind == EventKind::drive_kink;
        kinks += after_kink;
        by_series += !g.coarse;
      });
      EXPECT_GT(kinks, 20);
      EXPECT_LT(by_series, series_steps / 5) << stiffness << solver;
    }
}

// When the press is let go from F to F' a part of mass 1 rings with the speed (F - F')/omega exp(-zeta omega t). A step
// passes over it once it is so slow that, filtered twice at z = 3, it is below the tolerance of a step (beside itself
// and what the press makes of the part in such a step); and the series do not go on for long after that.
TEST(Implicit, passes_over_a_ring_once_it_has_decayed_below_its_tolerance) {
  constexpr double kBefore = 2.0, kAfter = 1.5, kJump = 1.0, kStiffness = 1e6, kOmega = 1e3, kRatio = 0.05, kZ = 3.0;
  constexpr double kStepShare = 1e-2;  // of the tolerance
  constexpr double kLeft = (1.0 + kZ * kZ) * (1.0 + kZ * kZ) / kZ;
  const double press_in_step = kAfter * kZ / (kOmega * collocation().eigenvalue[0].real());
  for (const double tolerance : {1e-3, 1e-5, 1e-7}) {
    Scene scene = test::scene_of(test::ball, {"gripper={pressing_force: 2.0}", "trial.time_limit=8"});
    scene.excitations.clear();
    scene.initial.y.reset();
    test::set_base(scene, kStiffness, kRatio);
    scene.solver.name = "implicit";
    scene.solver.tolerance = tolerance;
    Simulation simulation(scene, {});
    while (simulation.advance() && simulation.segment().end_time() < kJump) {
    }
    simulation.cut(kJump);
    simulation.set_pressing_force(kAfter);
    while (simulation.advance() && !simulation.segment().coarse) {
    }
    const double since = simulation.segment().start.value() - kJump;
    const double speed = (kBefore - kAfter) / kOmega * std::exp(-kRatio * kOmega * since);
    const double allowed = kLeft * kStepShare * tolerance * (speed + press_in_step);
    EXPECT_LT(speed, 1.5 * allowed) << tolerance;
    EXPECT_GT(speed, 0.2 * allowed) << tolerance;
    EXPECT_EQ(simulation.segment().end_time(), 8.0) << tolerance;
  }
}

// What rounds a place by delta makes the springs of the base ring with delta omega at most, however fast a damper or
// the tanh layer answers: faster motion is none of rounding, and is not passed over as if it were.
TEST(Implicit, takes_for_rounding_what_springs_make_of_it) {
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

// On an overdamped base the part creeps to its new place with k/c when the press is let go, after a ring of c/m that is
// over at once: steps that pass over that one still follow the creep, delta'' + c delta' + k delta = 0.
TEST(Implicit, follows_a_slow_ring_under_a_fast_one) {
  constexpr double kBefore = 2.0, kAfter = 1.5, kJump = 1.0, kStiffness = 1e6, kRatio = 10.0;
  const double omega = std::sqrt(kStiffness), root = std::sqrt(kRatio * kRatio - 1.0);
  const double fast = omega * (kRatio + root), slow = omega * (kRatio - root);
  const double jump = (kBefore - kAfter) / kStiffness;
  Scene scene = test::scene_of(test::ball, {"gripper={pressing_force: 2.0}", "trial.time_limit=8"});
  scene.excitations.clear();
  scene.initial.y.reset();
  test::set_base(scene, kStiffness, kRatio);
  scene.solver.name = "implicit";
  scene.solver.tolerance = 1e-6;
  Simulation simulation(scene, {});
  while (simulation.advance() && simulation.segment().end_time() < kJump) {
  }
  simulation.cut(kJump);
  simulation.set_pressing_force(kAfter);
  int coarse = 0;
  while (simulation.advance()) {
    const Segment& g = simulation.segment();
    coarse += g.coarse;
    for (double share = 0.0; share < 1.0; share += 0.125) {
      const double t = g.start.value() + share * g.duration - kJump;
      const double left = (fast * std::exp(-slow * t) - slow * std::exp(-fast * t)) / (fast - slow);
      const double y = scene.part.base_distance - kAfter / kStiffness - jump * left;
      EXPECT_NEAR(state_at(g, share * g.duration).y, y, 1e-2 * jump) << t * slow;
    }
  }
  EXPECT_GT(coarse, 1);
}

// In the tanh layer a series step on a stiff base goes a small part of the way to the next kink.
TEST(Implicit, automatic_choice_tries_soon_in_the_tanh_layer_where_the_way_to_a_kink_is_long) {
  Scene scene = pressed(3e6, 1.0);
  scene.excitations[0].waveform = Waveform::triangle;
  scene.excitations[0].amplitude = 0.05;
  scene.excitations[0].frequency = 5.0;
  scene.friction = Friction{0.3, 0.2};
  scene.solver.name = "auto";
  scene.solver.tolerance = 1e-4;
  int by_series = 0, implicit = 0;
  test::run(scene, [&](const Segment& g) {
    implicit += g.coarse;
    by_series += implicit == 0;
  });
  EXPECT_GT(implicit, 0);
  EXPECT_LT(by_series, 100);  // 0.8 x 11.4/0.144 = 64, 131 where the first trial has to be earned twice
}

// A part exactly at rest, whose first series has no end, is shaken from some time on.
TEST(Implicit, automatic_choice_knows_steps_after_a_rest) {
  Scene scene = test::scene_of(test::plain, {"gripper.anchor={x: 0.25, phi: 0.0}", "initial.x=0.25",
                                             "part.base_distance=1.0", "friction=null", "trial.time_limit=50"});
  // spring and base hold the part with a force of 1/2 each, without rounding
  scene.base.stiffness_x = scene.base.stiffness_y = std::ldexp(1.0, 17);
  scene.base.damping_x = scene.base.damping_y = 100.0;
  scene.initial.y = 1.0 - std::ldexp(1.0, -18);
  scene.initial.phi = 0.0;
  scene.gripper.phi.moves = false;
  scene.gripper.pressing_force.reset();
  scene.gripper.anchor_y = *scene.initial.y - 0.5;
  scene.excitations[0].frequency = 1.0;
  std::vector<Excitation> still = scene.excitations;
  still[0].amplitude = 0.0;
  scene.excitations[0].amplitude = 0.2;
  const auto steps = [&](ContactMethod method) {
    EventSolver solver(make_system(scene), still, 1e-8, 1'000'000, method);
    EXPECT_EQ(solver.advance(50.0).vy[1], 0.0);
    solver.cut(1.0);
    solver.set_excitations(scene.excitations);
    while (solver.advance(50.0).end_time() < 50.0) {
    }
    return solver.counts().steps;
  };
  EXPECT_LT(steps(ContactMethod::automatic), 2 * steps(ContactMethod::implicit));
}

}  // namespace
}  // namespace vibratory_alignment
