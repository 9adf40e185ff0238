// Changes while a trial runs: they enter at a defined instant, keep the phase, and the motion goes on as a new trial
// that starts there would.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "../support/runs.h"
#include "../support/scenes.h"
#include "trial/sampler.h"

namespace vibratory_alignment {
namespace {

using test::scene_of;

const std::string bouncing = R"(
part: {half_width: 0.673, base_distance: 0.9015, inertia: 0.149}
slot: {clearance: 0.09}
gripper: {stiffness: {x: 0.5, phi: 30.0}, damping: {x: 0.1, y: 0.1, phi: 1.33}, anchor: {x: 0.2, y: 0.65}}
base: {stiffness: {x: 3648.0, y: 7600.0}, damping: {x: 9.96, y: 20.75}}
contacts: [edges]
friction: {coefficient: 0.319}
excitation: {amplitude: 1.0, frequency: 20.0, phase: 0.3}
initial: {x: 0.2, y: 0.895, phi: 0.025}
trial: {time_limit: 4.0, aligned_depth: 5.0}
solver: {tolerance: 1.0e-12}
)";

/// Runs to `when`, makes the changes there and goes on to the end.
TrialResult changed_run(const Scene& scene, double when, const std::vector<Excitation>& excitations, State& at_change) {
  SimulationOptions options;
  options.until = scene.trial.time_limit;
  Simulation simulation(scene, options);
  bool changed = false;
  while (simulation.advance()) {
    const Segment& g = simulation.segment();
    if (changed || when >= g.end_time()) continue;
    simulation.cut(when);
    at_change = g.end;
    EXPECT_EQ(g.end_time(), when);
    simulation.set_excitations(excitations);
    changed = true;
  }
  return simulation.result();
}

/// A part in the air at `when`: there the state alone says how it goes on.
TrialResult as_new_trial(Scene scene, double when, const State& state, const std::vector<Excitation>& excitations,
                         double phase) {
  scene.initial = {state.x, state.y, state.phi, state.vx, state.vy, state.omega};
  scene.excitations = excitations;
  scene.excitations[0].phase = phase;
  scene.trial.time_limit -= when;
  return test::run(scene, {}, scene.trial.time_limit);
}

TEST(Changes, of_the_frequency_keep_the_phase) {
  for (const Waveform waveform : {Waveform::sine, Waveform::square, Waveform::triangle})
    for (const double when : {0.5, 1.0, 1.37}) {
      Scene scene = scene_of(bouncing);
      scene.excitations[0].waveform = waveform;
      std::vector<Excitation> faster = scene.excitations;
      faster[0].frequency = 31.0;
      faster[0].amplitude = 1.2;
      State state;
      const TrialResult result = changed_run(scene, when, faster, state);
      const TrialResult expected = as_new_trial(scene, when, state, faster, 20.0 * when + 0.3);
      // what rounding of the phase, and of the cut, makes of some ten impacts
      EXPECT_LT(test::distance(result.final_state, expected.final_state), 1e-9) << when;
    }
}

// A jump of the phase itself would show: the same change with the phase counted from zero gives another motion.
TEST(Changes, would_show_a_jump_of_the_phase) {
  const Scene scene = scene_of(bouncing);
  std::vector<Excitation> faster = scene.excitations;
  faster[0].frequency = 31.0;
  State state;
  const TrialResult result = changed_run(scene, 1.37, faster, state);
  EXPECT_GT(test::distance(result.final_state, as_new_trial(scene, 1.37, state, faster, 0.3).final_state), 1e-3);
}

TEST(Changes, of_the_amplitude_to_zero_end_the_excitation) {
  const Scene scene = scene_of(bouncing);
  std::vector<Excitation> off = scene.excitations;
  off[0].amplitude = 0.0;
  State state;
  const TrialResult result = changed_run(scene, 1.0, off, state);
  EXPECT_LT(test::distance(result.final_state, as_new_trial(scene, 1.0, state, off, 0.0).final_state), 1e-9);
}

// The same settings again, at any instant, are no change.
TEST(Changes, to_what_it_is_change_nothing) {
  const Scene scene = scene_of(bouncing);
  const TrialResult plain = test::run(scene, {}, 4.0);
  for (const double when : {0.1, 0.777, 2.0}) {
    State state;
    const TrialResult again = changed_run(scene, when, scene.excitations, state);
    EXPECT_LT(test::distance(again.final_state, plain.final_state), 1e-9);
    EXPECT_EQ(again.impacts, plain.impacts);
  }
}

// ... also at the very instants of the events, where forces, depths and slip are exactly zero and must stay so.
TEST(Changes, at_events_keep_what_is_known_to_be_zero) {
  for (const char* friction : {"friction={coefficient: 0.319}", "friction={coefficient: 0.9}", "friction=null",
                               "friction={coefficient: 0.3, regularization: 2.0e-3}"})
    for (const char* base : {"base.recovery=false", "base.recovery=true", "base.damping=null"}) {
      const Scene scene = scene_of(bouncing, {friction, base});
      const TrialResult plain = test::run(scene, {}, 4.0);
      SimulationOptions options;
      options.until = 4.0;
      Simulation simulation(scene, options);
      double last = -1.0;
      while (simulation.advance()) {
        const Segment& g = simulation.segment();
        if (g.event_count == 0 || g.end_time() <= last || g.end_time() >= 4.0) continue;
        last = g.end_time();
        simulation.set_excitations(scene.excitations);
      }
      const TrialResult result = simulation.result();
      EXPECT_EQ(result.impacts, plain.impacts) << friction << " " << base;
      EXPECT_LT(test::distance(result.final_state, plain.final_state), 1e-8) << friction << " " << base;
      EXPECT_NE(result.outcome, Outcome::failed) << result.failure;
      EXPECT_LT(result.energy->residual, 1e-9);
    }
}

// A cut where an event has just been, given as a double: it leaves nothing of the segment, and what is zero stays zero.
TEST(Changes, cuts_at_events_keep_what_is_known_to_be_zero) {
  for (const char* friction : {"friction={coefficient: 0.319}", "friction={coefficient: 0.9}", "friction=null",
                               "friction={coefficient: 0.3, regularization: 2.0e-3}"})
    for (const char* base : {"base.recovery=false", "base.recovery=true", "base.damping=null"}) {
      const Scene scene = scene_of(bouncing, {friction, base});
      const TrialResult plain = test::run(scene, {}, 4.0);
      SimulationOptions options;
      options.until = 4.0;
      Simulation simulation(scene, options);
      double event = -1.0;
      while (simulation.advance()) {
        const Segment& g = simulation.segment();
        if (g.start.value() == event) simulation.cut(event);
        event = g.event_count > 0 ? g.end_time() : -1.0;
      }
      const TrialResult result = simulation.result();
      EXPECT_EQ(result.impacts, plain.impacts) << friction << " " << base;
      EXPECT_LT(test::distance(result.final_state, plain.final_state), 1e-8) << friction << " " << base;
    }
}

// What slides since an event knew V and V' by the old forces; under the new ones it goes whichever way they push it.
TEST(Changes, at_slip_events_make_a_contact_slide_the_way_it_is_pushed) {
  const Scene scene = scene_of(R"(
part: {half_width: 0.673, base_distance: 0.9, inertia: 0.15}
slot: {clearance: 0.09}
gripper: {stiffness: {x: 0.5, phi: 30.0}, damping: {x: 0.1, y: 0.1, phi: 1.3}, anchor: {x: 0.2, y: 0.65}}
base: {stiffness: {y: 4000.0}, damping: {y: 20.0}}
contacts: [edges]
friction: {coefficient: 0.4}
excitation: {amplitude: 1.0, frequency: 20.0}
initial: {x: 0.2, y: 0.895, phi: 0.025}
trial: {time_limit: 4.0, aligned_depth: 5.0}
)");
  int tried = 0;
  for (const test::TimedEvent& e : test::events_of(scene, 4.0)) {
    if (e.event.kind != EventKind::slip) continue;
    for (const double amplitude : {20.0, -20.0}) {
      Simulation simulation(scene);
      while (simulation.advance() && simulation.segment().end_time() != e.time) {
      }
      std::vector<Excitation> along = scene.excitations;
      along[0].direction = Direction::x;
      along[0].amplitude = amplitude;
      along[0].frequency = 1.0;
      along[0].phase = 1.5;
      simulation.set_excitations(along);
      ASSERT_TRUE(simulation.advance());
      const Segment& g = simulation.segment();
      for (int i = 0; i < g.loaded_count; ++i)
        for (const double share : {0.25, 0.5, 1.0}) {
          const ContactValues c = contact_at(g, i, share * g.duration);
          EXPECT_LE(c.tangential_force * c.slip_velocity, 1e-9) << e.time << ", " << amplitude;
        }
      ++tried;
    }
  }
  EXPECT_GT(tried, 2);
}

// The release is known to the truncation of the series; a point that is inside by that goes on out.
TEST(Changes, cuts_after_a_release_make_no_touch) {
  const Scene scene = scene_of(bouncing, {"friction=null", "base={stiffness: {y: 4000}}", "initial.y=0.95",
                                          "excitation.phase=0", "solver.tolerance=1e-4"});
  const TrialResult plain = test::run(scene, {}, 4.0);
  for (const double after : {3e-16, 1e-15, 3e-15, 1e-14, 1e-13, 1e-12}) {
    SimulationOptions options;
    options.until = 4.0;
    Simulation simulation(scene, options);
    bool released = false;
    while (simulation.advance()) {
      const Segment& g = simulation.segment();
      if (released) simulation.cut(g.start.value() + after);
      released = g.event_count > 0 && g.events[0].kind == EventKind::release;
    }
    const TrialResult result = simulation.result();
    EXPECT_EQ(result.impacts, plain.impacts) << after;
    EXPECT_LT(result.peak_force[0], 1.01 * plain.peak_force[0]) << after;
  }
}

// What was to change where the segment ended does so where it is cut after that.
TEST(Changes, enter_where_the_segment_is_cut_at_last) {
  for (const double first : {0.7, 0.5}) {
    Scene scene = scene_of(bouncing, {"initial.y=5.0", "gripper.anchor.y=5.0", "trial.time_limit=3.0"});
    std::vector<Excitation> none = scene.excitations;
    none[0].amplitude = 0.0;
    Simulation simulation(scene);
    ASSERT_TRUE(simulation.advance());
    simulation.cut(first);
    simulation.set_excitations(none);
    simulation.cut(0.5);
    const State state = simulation.segment().end;
    while (simulation.advance()) {
    }
    scene.initial = {state.x, state.y, state.phi, state.vx, state.vy, state.omega};
    scene.excitations = none;
    scene.trial.time_limit = 2.5;
    EXPECT_LT(test::distance(simulation.result().final_state, test::run(scene).final_state), 1e-12) << first;
  }
}

/// Two drives in the air: what they do shows in x and y.
const std::string shaken_twice = R"(
part: {half_width: 0.6, base_distance: 0.9, inertia: 0.2}
slot: {clearance: 0.09}
gripper: {stiffness: {x: 0.08, phi: 60.0}, damping: {x: 0.02, y: 0.05, phi: 0.03}, anchor: {x: 0.2, y: 5.0}}
base: {stiffness: {y: 1.0e4}, damping: {y: 20.0}}
contacts: [edges]
excitation:
  - {amplitude: 1.0, frequency: 20.0}
  - {amplitude: 0.5, frequency: 13.0, direction: x}
initial: {x: 0.2, y: 5.0}
trial: {time_limit: 1.5}
)";

// Changes of the frequency, all made at one instant, of which the last leaves the second excitation to the first one:
// where the segment is cut once more, before that, all of them enter as if they had been made there.
TEST(Changes, enter_one_after_the_other_where_the_segment_is_cut_at_last) {
  for (const auto& [solver, step] :
       {std::pair{"event", 0.0}, {"implicit", 0.0}, {"auto", 0.0}, {"rk4", 0.05}, {"semi_implicit", 0.05}}) {
    Scene scene = scene_of(shaken_twice);
    scene.solver.name = solver;
    if (step > 0.0) scene.solver.step = step;
    std::vector<Excitation> both = scene.excitations;
    both[0].frequency = 9.0;
    both[1].frequency = 5.0;
    std::vector<Excitation> first = {both[0]};
    first[0].frequency = 11.0;
    const auto changed_at = [&](double late, double when) {
      Simulation simulation(scene);
      while (simulation.advance() && simulation.segment().end_time() <= late) {
      }
      simulation.cut(late);
      simulation.set_excitations(both);
      simulation.set_excitations(first);
      simulation.cut(when);
      while (simulation.advance()) {
      }
      return simulation.result().final_state;
    };
    EXPECT_LT(test::distance(changed_at(0.04, 0.02), changed_at(0.02, 0.02)), 1e-13) << solver;
    EXPECT_GT(test::distance(changed_at(0.04, 0.04), changed_at(0.02, 0.02)), 1e-4) << solver;
  }
}

// A ball at rest in the air has settled at the 24th sixteenth of 2 pi, which is where its first segment ends. Cut
// before that it goes on until then; changed where it is cut, even to what it is, for as long from there.
TEST(Changes, before_a_trial_has_settled_let_it_go_on) {
  const Scene scene = scene_of(
      test::ball, {"gripper.anchor.y=5.0", "initial.y=5.0", "excitation.amplitude=0", "trial.time_limit=1000"});
  const double settles = 23.0 * 2.0 * 3.14159265358979323846 / 16.0;
  for (const bool is_changed : {false, true}) {
    Simulation simulation(scene);
    ASSERT_TRUE(simulation.advance());
    EXPECT_NEAR(simulation.segment().end_time(), settles, 1e-12);
    if (is_changed) simulation.set_excitations(scene.excitations);
    simulation.cut(1.0);
    while (simulation.advance()) {
    }
    EXPECT_EQ(simulation.result().outcome, Outcome::stalled);
    EXPECT_NEAR(simulation.result().final_time, settles + (is_changed ? 1.0 : 0.0), 1e-12);
  }
}

// What has stalled, and is watched for longer, goes on with a change: it aligns as if it had never rested.
TEST(Changes, after_a_rest_go_on_to_other_outcomes) {
  const Scene scene = scene_of(
      test::ball, {"gripper={anchor: {y: 0.5}, damping: {y: 1.0}}", "excitation={amplitude: 0.0, frequency: 6.0}",
                   "base={stiffness: {y: 1.0e3}, damping: {y: 60}}", "trial.time_limit=1000"});
  SimulationOptions options;
  options.until = 200.0;
  Simulation simulation(scene, options);
  while (simulation.advance() && simulation.result().outcome != Outcome::stalled) {
  }
  ASSERT_EQ(simulation.result().outcome, Outcome::stalled);
  std::vector<Excitation> shaken = scene.excitations;
  shaken[0].amplitude = 1.0;
  simulation.set_excitations(shaken);
  EXPECT_EQ(simulation.result().outcome, Outcome::running);
  ASSERT_TRUE(simulation.advance());
  EXPECT_EQ(simulation.result().outcome, Outcome::running);
}

TEST(Changes, however_many_at_one_instant_end_nothing) {
  const Scene scene = scene_of(bouncing);
  for (const char* solver : {"event", "implicit", "auto"}) {
    Scene s = scene;
    s.solver.name = solver;
    Simulation simulation(s);
    std::vector<Excitation> other = scene.excitations;
    ASSERT_TRUE(simulation.advance());
    const double when = 0.5 * simulation.segment().end_time();
    for (int i = 0; i < 300; ++i) {
      simulation.cut(when);
      other[0].amplitude = 1.0 + 1e-3 * i;
      simulation.set_excitations(other);
      ASSERT_TRUE(simulation.advance()) << simulation.result().failure;
    }
    while (simulation.advance()) {
    }
    EXPECT_NE(simulation.result().outcome, Outcome::failed) << solver << ": " << simulation.result().failure;
  }
}

TEST(Changes, cuts_at_no_instant_cut_nothing) {
  const Scene scene = scene_of(bouncing);
  Simulation simulation(scene);
  ASSERT_TRUE(simulation.advance());
  const double duration = simulation.segment().duration;
  ASSERT_GT(duration, 0.0);
  for (const double when : {HUGE_VAL, -HUGE_VAL, std::nan(""), -1.0, 1e300}) {
    simulation.cut(when);
    EXPECT_EQ(simulation.segment().duration, duration) << when;
  }
}

// Asked for at a double that an event's instant rounds to, a change enters there and not a segment later.
TEST(Changes, at_an_event_enter_at_the_event) {
  const Scene scene = scene_of(bouncing);
  int tried = 0;
  for (const test::TimedEvent& e : test::events_of(scene, 4.0)) {
    Simulation simulation(scene);
    while (simulation.advance() && simulation.segment().start.value() != e.time) {
    }
    if (simulation.ended() || simulation.segment().duration == 0.0) continue;
    simulation.cut(e.time);
    EXPECT_LE(std::abs(simulation.segment().end_time() - e.time), 1e-15 * e.time) << e.time;
    ++tried;
  }
  EXPECT_GT(tried, 20);
}

TEST(Changes, before_the_start_enter_at_the_start) {
  const Scene scene = scene_of(bouncing);
  std::vector<Excitation> other = scene.excitations;
  other[0].frequency = 13.0;
  other[0].amplitude = 0.8;
  Scene expected = scene;
  expected.excitations = other;
  Simulation simulation(scene);
  simulation.set_excitations(other);
  while (simulation.advance()) {
  }
  EXPECT_EQ(test::distance(simulation.result().final_state, test::run(expected).final_state), 0.0);
}

const std::vector<std::string> pressed = {
    "gripper={stiffness: {x: 0.5, phi: 30.0}, damping: {x: 0.1, y: 0.1, phi: 1.33}, pressing_force: 0.2}"};

// f0 = y_touch - y_a, y_touch that of the start: the anchor moves by the difference.
TEST(Changes, of_the_press_move_the_anchor) {
  for (const double when : {0.0, 0.6, 1.3}) {
    const Scene scene = scene_of(bouncing, pressed);
    SimulationOptions options;
    options.until = 4.0;
    Simulation simulation(scene, options);
    State state = make_system(scene).start;
    bool changed = when == 0.0;
    if (changed) simulation.set_pressing_force(0.35);
    while (simulation.advance()) {
      if (changed || when >= simulation.segment().end_time()) continue;
      simulation.cut(when);
      state = simulation.segment().end;
      simulation.set_pressing_force(0.35);
      changed = true;
    }
    Scene rest = scene;
    rest.gripper.pressing_force.reset();
    rest.gripper.anchor_y = make_system(scene).y.anchor - 0.15;
    rest.initial = {state.x, state.y, state.phi, state.vx, state.vy, state.omega};
    rest.excitations[0].phase = 20.0 * when + 0.3;
    rest.trial.time_limit = 4.0 - when;
    const TrialResult expected = test::run(rest, {}, rest.trial.time_limit), result = simulation.result();
    EXPECT_LT(test::distance(result.final_state, expected.final_state), 1e-9) << when;
    // what the anchor's jump puts into the spring is work from outside: the ledger knows
    EXPECT_LT(result.energy->residual, 1e-9) << when;
  }
}

// ... at once, and where nothing comes after it.
TEST(Changes, of_the_press_are_in_the_ledger_from_then_on) {
  for (const char* solver : {"event", "rk4"}) {
    Scene scene = scene_of(bouncing, pressed);
    scene.trial.time_limit = 1.0;
    scene.solver.name = solver;
    if (scene.solver.name == "rk4") scene.solver.step = 1e-4;
    Simulation simulation(scene);
    while (simulation.advance())
      if (simulation.segment().end_time() >= 1.0) simulation.set_pressing_force(1.0);
    EXPECT_LT(simulation.result().energy->residual, 1e-3) << solver;
  }
}

TEST(Changes, of_the_press_need_a_height_of_touch) {
  Simulation simulation(scene_of(bouncing, {"initial={x: 0.0, y: 0.95, phi: 0.0}"}));
  EXPECT_THROW(simulation.set_pressing_force(0.3), std::invalid_argument);
}

// Cuts alone, wherever they are, only shorten steps.
TEST(Changes, cuts_do_not_change_the_motion) {
  const Scene scene = scene_of(bouncing);
  const TrialResult plain = test::run(scene, {}, 4.0);
  for (const double interval : {0.5, 0.03, 0.0017}) {
    SimulationOptions options;
    options.until = 4.0;
    Simulation simulation(scene, options);
    Sampler sampler(simulation, interval);
    Sample sample;
    while (sampler.next(sample)) simulation.cut(sampler.time());
    EXPECT_LT(test::distance(simulation.result().final_state, plain.final_state), 1e-10) << interval;
    EXPECT_EQ(simulation.result().impacts, plain.impacts);
    EXPECT_LT(simulation.result().energy->residual, 1e-10);
  }
}

// Two excitations, of which the first is set to what it is: the second goes on for all that watches the trial. A
// contact on a soft base lasts pi/sqrt(k + 1) = 0.95 of the second one's period of 6.3, and would be none of an impact
// beside the first one's alone.
TEST(Changes, of_the_first_excitation_leave_the_others_to_all_that_watch) {
  const Scene scene = scene_of(test::ball, {"base={stiffness: {y: 10.0}}",
                                            "excitation=[{amplitude: 0.01, frequency: 25}, "
                                            "{amplitude: 0.01, frequency: 1}]"});
  Simulation simulation(scene);
  simulation.set_excitations({scene.excitations[0]});
  while (simulation.advance()) {
  }
  const TrialResult changed = simulation.result(), alone = test::run(scene);
  ASSERT_GT(test::total_impacts(alone), 1);
  EXPECT_EQ(changed.mode, Mode::impact);
  EXPECT_EQ(alone.mode, Mode::impact);
  EXPECT_EQ(changed.final_time, alone.final_time);
}

// A change is judged anew: what had nearly settled goes on.
TEST(Changes, restart_the_watch_for_settling) {
  const Scene scene = scene_of(
      test::ball, {"gripper={anchor: {y: 0.5}, damping: {y: 1.0}}", "excitation={amplitude: 0.2, frequency: 6.0}",
                   "base={stiffness: {y: 1.0e3}, damping: {y: 60}}", "trial.time_limit=1000"});
  const double alone = test::run(scene).final_time;
  Simulation simulation(scene);
  bool changed = false;
  std::vector<Excitation> faster = scene.excitations;
  faster[0].frequency = 9.0;
  while (simulation.advance()) {
    if (changed || simulation.segment().end_time() < 0.9 * alone) continue;
    simulation.set_excitations(faster);
    changed = true;
  }
  EXPECT_EQ(simulation.result().outcome, Outcome::stalled);
  // at least the 16 periods that a judgement looks back
  EXPECT_GT(simulation.result().final_time, 0.9 * alone + 16.0 * 2.0 * 3.14159265358979323846 / 9.0);
}

// Jammed above the floor for want of force: pressed harder it goes on, and is inserted.
TEST(Changes, of_the_press_free_what_has_jammed) {
  const Scene scene = scene_of(R"(
part: {half_width: 0.673, base_distance: 0.9015, inertia: 0.149}
slot: {clearance: 0.09, depth: 0.5}
gripper: {stiffness: {x: 0.0147, phi: 7.3}, damping: {x: 0.5, y: 0.5, phi: 1.3}, pressing_force: 0.1}
base: {stiffness: {x: 3648.0, y: 7600.0}, damping: {x: 9.96, y: 20.75}}
contacts: [edges, corners, walls]
friction: {coefficient: 0.319}
excitation: {amplitude: 1.0, frequency: 20.0}
initial: {x: 0.2, y: 0.895, phi: 0.025}
trial: {time_limit: 400.0, aligned_depth: 0.02}
)");
  SimulationOptions options;
  options.until = 400.0;
  Simulation simulation(scene, options);
  while (simulation.advance() && simulation.result().outcome == Outcome::running) {
  }
  ASSERT_EQ(simulation.result().outcome, Outcome::jammed);
  simulation.set_pressing_force(0.8);
  EXPECT_EQ(simulation.result().outcome, Outcome::running);
  while (simulation.advance() && simulation.result().outcome == Outcome::running) {
  }
  EXPECT_EQ(simulation.result().outcome, Outcome::inserted);
}

// A contact of a ball on its base lasts pi/sqrt(k + 1): longer than a period of the excitation that the scene has,
// shorter than one of that which it gets.
TEST(Changes, of_the_frequency_change_what_is_kept_contact) {
  const double contact = 3.14159265358979323846 / 10.0;
  for (const bool is_changed : {false, true}) {
    Scene scene = scene_of(test::ball, {"gripper={anchor: {y: 0.9}}", "initial.y=1.2", "trial.time_limit=20",
                                        "base={stiffness: {y: 99}}"});
    scene.excitations[0].amplitude = 1e-9;
    scene.excitations[0].frequency = 2.0 * 3.14159265358979323846 * 1.1 / contact;
    Simulation simulation(scene);
    std::vector<Excitation> slower = scene.excitations;
    slower[0].frequency *= 0.9 / 1.1;
    if (is_changed) simulation.set_excitations(slower);
    while (simulation.advance()) {
    }
    EXPECT_EQ(simulation.result().mode, is_changed ? Mode::impact : Mode::mixed);
  }
}

}  // namespace
}  // namespace vibratory_alignment
