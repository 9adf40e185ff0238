// The solver `implicit` on stiff bases: the same answers and events as `event`, at a cost that does not depend on the
// stiffness of a base that the part stays in contact with.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "../support/hard_scene.h"
#include "../support/pressed_part.h"
#include "../support/runs.h"
#include "../support/scenes.h"
#include "mechanics/contact_frame.h"
#include "model/scene_loader.h"
#include "trial/make_solver.h"
#include "trial/simulation.h"

namespace vibratory_alignment {
namespace {

// Bounded whatever k: what is left is a rigid base. A base whose answer to a slip is below the tolerance costs less.
TEST(Implicit, cost_of_lasting_contact_does_not_depend_on_the_stiffness) {
  for (const double damping_ratio : {1.0, 10.0, 100.0}) {
    long least = 0, most = 0;
    for (const double stiffness : {1e4, 1e6, 1e8, 1e10}) {
      const TrialResult result = test::run_to_limit_with(test::pressed(stiffness, damping_ratio), "implicit", 1e-6);
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
  const TrialResult expected = test::run_to_limit_with(scene, "event", tolerance),
                    result = test::run_to_limit_with(scene, solver, tolerance);
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
  ASSERT_GT(test::run_to_limit_with(scene, "event", 1e-6).impacts[static_cast<std::size_t>(Spot::b1)], 10);
  for (const char* solver : {"implicit", "auto"}) expect_as_event(scene, solver, 1e-6);
}

// An excitation without amplitude asks for no steps.
TEST(Implicit, steps_do_not_follow_what_has_no_amplitude) {
  Scene scene = test::pressed(1e8, 1.0);
  const long alone = test::run_to_limit_with(scene, "implicit", 1e-6).counts.steps;
  scene.excitations.push_back({});
  scene.excitations.back().amplitude = 0.0;
  scene.excitations.back().frequency = 1e4;
  EXPECT_EQ(test::run_to_limit_with(scene, "implicit", 1e-6).counts.steps, alone);
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
    EXPECT_LT(test::run_to_limit_with(scene, solver, 1e-6).counts.steps, 1000) << solver;
  }
}

// After a thousand turns phi is known to fewer digits, and so is what they make of the forces.
TEST(Implicit, steps_are_as_long_after_a_thousand_turns) {
  const auto steps = [](double turns) {
    Scene scene = test::pressed(1e8, 1.0);
    scene.initial.phi = scene.gripper.anchor_phi = 2.0 * 3.14159265358979323846 * turns;
    return test::run_to_limit_with(scene, "implicit", 1e-6).counts.steps;
  };
  EXPECT_LT(steps(1000.0), 2 * steps(0.0));
}

// On the stiffest bases rounding moves an event whatever the length of its step, which is not taken again for that.
TEST(Implicit, events_that_only_rounding_moves_are_not_sought_again) {
  const auto cost = [](double stiffness) {
    Scene scene = test::hard_scene("lasting_contact");
    test::set_base(scene, stiffness, 1.0);
    return static_cast<double>(
        test::run_to_limit_with(scene, "implicit", scene.solver.tolerance).counts.rhs_evaluations);
  };
  EXPECT_LE(cost(1e10), 1.05 * cost(1e8));
}

// The stiffer the base, the nearer to a rigid one: differences fall as 1/k.
TEST(Implicit, a_stiff_base_tends_to_a_rigid_one) {
  const State rigid = test::run_to_limit_with(test::pressed(1e10, 1.0), "implicit", 1e-6).final_state;
  const double at_1e6 =
      std::abs(test::run_to_limit_with(test::pressed(1e6, 1.0), "implicit", 1e-8).final_state.x - rigid.x);
  const double at_1e8 =
      std::abs(test::run_to_limit_with(test::pressed(1e8, 1.0), "implicit", 1e-8).final_state.x - rigid.x);
  EXPECT_NEAR(at_1e6 / at_1e8, 100.0, 30.0);
}

TEST(Implicit, agrees_with_the_series_on_a_stiff_base) {
  for (const double damping_ratio : {0.3, 1.0, 3.0}) {
    const Scene scene = test::pressed(1e6, damping_ratio);
    const State series = test::run_to_limit_with(scene, "event", 1e-10).final_state;
    EXPECT_LT(test::distance(test::run_to_limit_with(scene, "implicit", 1e-8).final_state, series), 1e-7)
        << damping_ratio;
    EXPECT_LT(test::distance(test::run_to_limit_with(scene, "auto", 1e-8).final_state, series), 1e-7) << damping_ratio;
  }
}

// In the thin layer of regularised friction the part creeps: a stiff damper.
TEST(Implicit, follows_the_creep_in_a_thin_layer_of_friction) {
  Scene scene = test::pressed(1e4, 1.0);
  long steps = 0;
  for (const double eps : {1e-3, 1e-4}) {
    scene.friction->regularization = eps;
    const State series = test::run_to_limit_with(scene, "event", 1e-10).final_state;
    const TrialResult implicit = test::run_to_limit_with(scene, "implicit", 1e-8);
    EXPECT_LT(test::distance(implicit.final_state, series), 1e-6) << eps;
    if (steps > 0) {
      EXPECT_LT(implicit.counts.steps, 2 * steps) << eps;
    }
    steps = implicit.counts.steps;
  }
}

// Beyond what rounding leaves of the velocities there is nothing to converge to.
TEST(Implicit, smallest_tolerances_cost_no_more_than_their_digits) {
  for (const char* name : {"shaken_table", "chatter", "lasting_contact"}) {
    Scene scene = test::hard_scene(name);
    const auto evaluations = [&](double tolerance) {
      const TrialResult result = test::run_to_limit_with(scene, "implicit", tolerance);
      EXPECT_NE(result.outcome, Outcome::failed) << name << ": " << result.failure;
      return result.counts.rhs_evaluations;
    };
    const long usual = evaluations(1e-11);
    for (const double tolerance : {1e-12, 1e-13, 1e-14})
      EXPECT_LT(evaluations(tolerance), 2 * usual) << name << tolerance;
  }
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
    const State expected = test::run_to_limit_with(scene, "event", 1e-8).final_state;
    for (const char* solver : {"implicit", "auto"})
      for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-8}) {
        const TrialResult result = test::run_to_limit_with(scene, solver, tolerance);
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
  const State expected = test::run_to_limit_with(scene, "event", 1e-10).final_state;
  for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
    const TrialResult result = test::run_to_limit_with(scene, "implicit", tolerance);
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

// In the tanh layer a contact is stiff as long as N is large: a step up to its release sees at its start nothing of the
// slip in which it ends.
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
  const State expected = test::run_to_limit_with(scene, "event", 1e-10).final_state;
  for (const double tolerance : {4e-7, 2e-7, 1e-7})
    EXPECT_LT(test::distance(test::run_to_limit_with(scene, "implicit", tolerance).final_state, expected), tolerance)
        << tolerance;
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
          const TrialResult result = test::run_to_limit_with(scene, "implicit", 1e-8);
          EXPECT_NE(result.outcome, Outcome::failed)
              << (waveform == Waveform::square ? "square" : "triangle") << ", friction " << friction << ", "
              << stiffness << ", " << frequency << ": " << result.failure;
        }
}

/// Falls between the edges, wedges and creeps there, with k(n)/h(n) = 2e3, while what else was deformed recovers.
constexpr char kWedge[] = R"(
part: {half_width: 0.2, base_distance: 1, inertia: 1}
slot: {clearance: 0.0002}
gripper: {stiffness: {x: 0}, damping: {x: 0, y: 0, phi: 0}, anchor: {x: 0, phi: 0}, pressing_force: 1}
base: {stiffness: {x: 1, y: 1.0e+11}, damping: {x: 1.0e+07, y: 1.0e+07}, recovery: true}
contacts: [edges, corners]
friction: {coefficient: 1}
excitation: [{amplitude: 0, frequency: 1}]
initial: {x: 0, y: 0.0006, phi: -1.6, vx: 0, vy: 0, omega: 0}
trial: {time_limit: 0.012, aligned_depth: 0}
solver: {step_limit: 1000000}
)";

// The recovery of the base bounds a step beside its own error. Where it ends then it is taken to, and the next one goes
// on from there: a creep that is over at the end of a longer one is not at that of the shorter.
TEST(Implicit, a_step_that_a_recovering_base_cuts_short_follows_the_creep) {
  const Scene scene = test::scene_of(kWedge);
  const State exact = test::run_with(scene, "event", 1e-8).final_state;
  for (const char* solver : {"implicit", "auto"})
    for (const double tolerance : {1e-6, 1e-8}) {
      const State found = test::run_with(scene, solver, tolerance).final_state;
      EXPECT_NEAR(found.x, exact.x, 1e-11) << solver << tolerance;
      EXPECT_NEAR(found.y, exact.y, 1e-11) << solver << tolerance;
    }
}

}  // namespace
}  // namespace vibratory_alignment
