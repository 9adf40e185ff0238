// Rings of a stiff base that implicit steps pass over: which they may, which they have to follow or leave to the
// series.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/hard_scene.h"
#include "../support/pressed_part.h"
#include "../support/restitution.h"
#include "../support/runs.h"
#include "../support/scenes.h"
#include "model/scene_loader.h"
#include "solver/collocation.h"
#include "trial/make_solver.h"
#include "trial/simulation.h"

namespace vibratory_alignment {
namespace {

// After a touch the base rings for as long as it is stiff: no step may pass over the rebound, however long it could be.
TEST(ImplicitRings, follows_every_rebound) {
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
TEST(ImplicitRings, steps_alone_follow_every_rebound) {
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
TEST(ImplicitRings, follows_what_the_base_throws_off) {
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
TEST(ImplicitRings, passes_over_a_ring_at_the_start_below_its_tolerance) {
  constexpr double kPress = 2.0, kStiffness = 1e6, kShare = 0.25, kTime = 2.0;
  Scene scene = test::scene_of(test::ball, {"gripper={pressing_force: 2.0}", "trial.time_limit=2"});
  scene.excitations.clear();
  scene.initial.y = scene.part.base_distance - (1.0 + kShare) * kPress / kStiffness;
  test::set_base(scene, kStiffness, 0.0);
  constexpr double kPeriods = kTime * 1e3 / 6.283;
  EXPECT_LT(test::run_to_limit_with(scene, "implicit", 1e-4).counts.steps, 20);
  EXPECT_GT(test::run_to_limit_with(scene, "implicit", 1e-9).counts.steps, 0.5 * kPeriods);
}

// A part that starts at its balance with a speed V rings by V/omega there, within the tolerance: so it does between the
// nodes of its first steps as well, whose polynomials begin with V.
TEST(ImplicitRings, places_between_the_nodes_keep_the_tolerance_at_the_start) {
  constexpr double kPress = 2.0, kStiffness = 1e8, kSpeed = 2e-5, kTolerance = 1e-7;
  Scene scene = test::scene_of(test::ball, {"gripper={pressing_force: 2.0}", "trial.time_limit=5"});
  scene.excitations.clear();
  test::set_base(scene, kStiffness, 0.5);
  const double balance = scene.part.base_distance - kPress / kStiffness;
  scene.initial.y = balance;
  scene.initial.vy = kSpeed;
  scene.solver.tolerance = kTolerance;
  for (const char* solver : {"implicit", "auto"}) {
    scene.solver.name = solver;
    double farthest = 0.0;
    long steps = 0;
    test::run(scene, [&](const Segment& g) {
      for (int i = 1; i <= 40; ++i)
        farthest = std::max(farthest, std::abs(state_at(g, g.duration * i / 40.0).y - balance));
      ++steps;
    });
    EXPECT_LT(farthest, kTolerance * (scene.part.half_width + scene.part.base_distance)) << solver;
    EXPECT_LT(steps, 20) << solver;
  }
}

// N swings between 1 - s and 1 + s times the press. Friction that holds at the one may not at the other: a ring is
// passed over at the start where N begins within a factor of two of what the step goes on with.
TEST(ImplicitRings, follows_a_ring_at_the_start_that_more_than_halves_or_doubles_a_force) {
  constexpr double kPress = 2.0, kStiffness = 1e8, kTime = 0.1;
  constexpr double kPeriods = kTime * 1e4 / 6.283;
  Scene scene = test::scene_of(test::ball, {"gripper={pressing_force: 2.0}", "trial.time_limit=0.1"});
  scene.excitations.clear();
  test::set_base(scene, kStiffness, 0.0);
  for (const double share : {-0.75, -0.25, 0.75}) {
    scene.initial.y = scene.part.base_distance - (1.0 + share) * kPress / kStiffness;
    const long steps = test::run_to_limit_with(scene, "implicit", 1e-4).counts.steps;
    if (share < -0.5)
      EXPECT_GT(steps, 0.5 * kPeriods) << share;
    else
      EXPECT_LT(steps, 20) << share;
  }
}

// A start 1 + s times as deep as the sag rings by s times the press, and lifts off at cos omega t = -1/s however small
// the ring is. No step may pass over it, though its amplitude is far below the tolerance.
TEST(ImplicitRings, follows_a_ring_at_the_start_that_lifts_the_part) {
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
TEST(ImplicitRings, follows_the_ring_after_a_jump_of_the_press) {
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

// A part that starts at rest on a stiff base whose static place moves rings with that speed. The ring is small, but
// once the part is released it flies with the ring's speed: the place at the end is that of `event`.
TEST(ImplicitRings, passes_over_no_ring_whose_speed_shows_after_a_release) {
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
  const TrialResult expected = test::run_to_limit_with(scene, "event", 1e-12);
  ASSERT_GT(expected.impacts[0] + expected.impacts[1], 0);
  for (const char* solver : {"implicit", "auto"})
    for (const double tolerance : {1e-6, 1e-7, 1e-8}) {
      const State end = test::run_to_limit_with(scene, solver, tolerance).final_state;
      EXPECT_LT(test::distance(end, expected.final_state), 100.0 * tolerance) << solver << " " << tolerance;
    }
}

// A slip or stick event makes a stiff base ring, hardly damped: implicit steps that follow the ring go no farther than
// half of what the series do, and cost as much.
TEST(ImplicitRings, rings_after_slip_events_are_left_to_the_series) {
  for (const double stiffness : {1e5, 1e6, 1e7}) {
    Scene scene = test::pressed(stiffness, 0.1);
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

/// A part that can only turn and move along the insertion, with its bottom on the edge a1: it sticks and slips eight
/// times, and where it begins to slide, at 0.01235, its speed jumps by a fiftieth.
constexpr char kLever[] = R"(
part: {half_width: 1.3, base_distance: 0.6, inertia: 0.002}
slot: {clearance: 0.02}
gripper: {stiffness: {phi: 7}, damping: {x: 0, y: 0.05, phi: 0.02}, anchor: {x: 0, phi: -0.025}, pressing_force: 6.4}
base: {stiffness: {x: 4.0e9, y: 8.0e9}, damping: {x: 3500, y: 5500}}
contacts: [edges]
friction: {coefficient: 0.62}
excitation: [{amplitude: 2.3, frequency: 48, phase: -4, direction: y}]
initial: {x: 0.35}
trial: {time_limit: 0.2, aligned_depth: 0}
)";

// What begins to slide goes on at once with the speed that a stiff base gives it. A step that passes over this jump
// leaves more of it than its tolerance; the series follow it all.
TEST(ImplicitRings, what_begins_to_slide_has_the_speed_that_the_base_gives_it) {
  constexpr double kTolerance = 1e-8, kSlides = 0.01235;
  Scene scene = test::scene_of(kLever);
  for (const double soon_after : {0.01245, 0.0125}) {
    const double omega = test::run_with(scene, "event", kTolerance, soon_after).final_state.omega;
    for (const char* solver : {"implicit", "auto"}) {
      scene.solver.name = solver;
      scene.solver.tolerance = kTolerance;
      double last_slip = 0.0;
      long coarse = 0;
      const auto watch = [&](const Segment& g) {
        coarse += g.coarse;
        for (int i = 0; i < g.event_count; ++i)
          if (g.events[static_cast<std::size_t>(i)].kind == EventKind::slip) last_slip = g.end_time();
      };
      const double found = test::run(scene, watch, soon_after).final_state.omega;
      EXPECT_NEAR(found / omega, 1.0, 100.0 * kTolerance) << solver << soon_after;
      EXPECT_NEAR(last_slip, kSlides, 1e-5) << solver;
      EXPECT_GT(coarse, 5) << solver;
    }
  }
}

// After a kink an implicit step would have to follow the ring, hardly farther than one of the series. Once the ring has
// decayed it passes over what hundreds of the others follow.
TEST(ImplicitRings, rings_after_kinks_are_left_to_the_series) {
  for (const double stiffness : {3e5, 3e6, 3e7})
    for (const char* solver : {"implicit", "auto"}) {
      Scene scene = test::pressed(stiffness, 1.0);
      scene.excitations[0].waveform = Waveform::square;
      scene.excitations[0].amplitude = 0.05;
      scene.excitations[0].frequency = 5.0;
      scene.friction = Friction{0.3, {}};
      scene.trial.time_limit = 20.0;
      const long series_steps = test::run_to_limit_with(scene, "event", 1e-6).counts.steps;
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
TEST(ImplicitRings, passes_over_a_ring_once_it_has_decayed_below_its_tolerance) {
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

// On an overdamped base the part creeps to its new place with k/c when the press is let go, after a ring of c/m that is
// over at once: steps that pass over that one still follow the creep, delta'' + c delta' + k delta = 0.
TEST(ImplicitRings, follows_a_slow_ring_under_a_fast_one) {
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

}  // namespace
}  // namespace vibratory_alignment
