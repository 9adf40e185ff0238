// The solver `auto` in whole trials: implicit steps where they pay, the series where they do not. (Its rules one by
// one: test_method_choice.cpp.)
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "../support/hard_scene.h"
#include "../support/pressed_part.h"
#include "../support/random_scenes.h"
#include "../support/reference_scene.h"
#include "../support/runs.h"
#include "../support/scenes.h"
#include "model/scene_loader.h"
#include "solver/event_solver.h"

namespace vibratory_alignment {
namespace {

// Events of a long step that a short one does not have (test_implicit.cpp) cost `auto` no more steps than `implicit`.
TEST(AutomaticChoice, finds_no_events_that_are_none_again_and_again) {
  for (const auto& [stiffness, damping_ratio] : {std::pair{1e7, 0.01}, {1e7, 0.1}, {1e8, 1.0}}) {
    const Scene scene = test::pressed(stiffness, damping_ratio);
    const long implicit = test::run_to_limit_with(scene, "implicit", 1e-4).counts.steps;
    EXPECT_LT(test::run_to_limit_with(scene, "auto", 1e-4).counts.steps, 1.2 * static_cast<double>(implicit))
        << stiffness;
  }
}

TEST(AutomaticChoice, takes_few_steps_where_either_does) {
  for (const double tolerance : {1e-6, 1e-8})
    for (const double stiffness : {1e6, 1e7, 1e8, 1e9, 1e10}) {
      const Scene scene = test::pressed(stiffness, 10.0);
      const auto implicit = static_cast<double>(test::run_to_limit_with(scene, "implicit", tolerance).counts.steps);
      EXPECT_LT(test::run_to_limit_with(scene, "auto", tolerance).counts.steps, 1.4 * implicit) << stiffness;
    }
  // a start at rest, whose ring is passed over: its speed is the rate of the force, 7, over the stiffness
  for (const double stiffness : {1e7, 1e8})
    for (const double damping_ratio : {0.01, 0.1, 1.0, 10.0}) {
      Scene scene = test::hard_scene("lasting_contact");
      test::set_base(scene, stiffness, damping_ratio);
      EXPECT_EQ(test::run_to_limit_with(scene, "auto", 1e-6).counts.steps,
                test::run_to_limit_with(scene, "implicit", 1e-6).counts.steps)
          << stiffness << " " << damping_ratio;
    }
  // impacts are over before an implicit step is thought of: the answer is that of the series to the bit
  Scene bouncing = test::scene_of_reference(reference::referenceCases()[0]);
  bouncing.friction->regularization.reset();
  const State a = test::run_to_limit_with(bouncing, "event", 1e-8).final_state,
              b = test::run_to_limit_with(bouncing, "auto", 1e-8).final_state;
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.omega, b.omega);
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

TEST(AutomaticChoice, goes_on_after_a_ring_however_short_the_last_implicit_steps_were) {
  const Scene scene = load_scene(YAML::Load(kKicked), "kicked");
  const long implicit = test::run_to_limit_with(scene, "implicit", 1e-6).counts.steps;
  ASSERT_GT(test::run_to_limit_with(scene, "event", 1e-6).counts.steps, 10 * implicit);
  EXPECT_LT(test::run_to_limit_with(scene, "auto", 1e-6).counts.steps, 1.4 * static_cast<double>(implicit));
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

TEST(AutomaticChoice, knows_that_what_is_held_stage_by_stage_is_dear) {
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
TEST(AutomaticChoice, first_waits_for_contact_to_settle) {
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
TEST(AutomaticChoice, asks_no_implicit_step_where_the_trial_ends_at_once) {
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

// While the base rings, for 1/(zeta sqrt(k)), the series go a fraction of a radian of it; after that farther than
// implicit steps for their cost.
TEST(AutomaticChoice, goes_back_to_the_series_once_a_ring_has_decayed) {
  Scene scene = test::hard_scene("lasting_contact");
  test::set_base(scene, 1e3, 0.1);
  scene.solver.name = "auto";
  double implicit_time = 0.0;
  test::run(scene, [&](const Segment& g) { implicit_time += g.coarse ? g.duration : 0.0; });
  EXPECT_GT(implicit_time, 0.0);
  EXPECT_LT(implicit_time, 0.3 * scene.trial.time_limit);
}

// In the tanh layer a series step on a stiff base goes a small part of the way to the next kink.
TEST(AutomaticChoice, tries_soon_in_the_tanh_layer_where_the_way_to_a_kink_is_long) {
  Scene scene = test::pressed(3e6, 1.0);
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
TEST(AutomaticChoice, knows_steps_after_a_rest) {
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
