// The loop that the solvers with a fixed step share: where steps end, what a segment holds, cuts and changes, refusals.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "../support/fixed_step.h"
#include "../support/random_scenes.h"
#include "mechanics/contact_frame.h"
#include "mechanics/system.h"
#include "trial/contact_impulse.h"
#include "trial/make_solver.h"
#include "trial/sampler.h"

namespace vibratory_alignment {
namespace {

using test::distance;
using test::run;
using test::scene_of;
using test::with_event_solver;
using test::with_solver;

class FixedStep : public testing::TestWithParam<std::string> {
 protected:
  Scene scene(double step, const std::vector<std::string>& settings = {}) const {
    return with_solver(scene_of(test::plain, settings), GetParam(), step);
  }
};
INSTANTIATE_TEST_SUITE_P(solver, FixedStep, testing::ValuesIn(test::fixed_step_solvers()),
                         [](const auto& info) { return info.param; });

TEST_P(FixedStep, steps_end_on_multiples_of_the_step) {
  long n = 0;
  run(scene(1e-3), [&](const Segment& g) {
    ++n;
    EXPECT_EQ(g.duration, n < 3000 ? 1e-3 : g.duration);
    EXPECT_NEAR(g.end_time(), static_cast<double>(n) * 1e-3, 1e-15 * static_cast<double>(n));
  });
  EXPECT_EQ(n, 3000);
}

TEST_P(FixedStep, ends_exactly_at_the_limit) {
  for (const double until : {1.0, 0.7, 0.12345, 1e-3, 1e-5}) {
    const TrialResult result = run(scene(1e-3), {}, until);
    EXPECT_EQ(result.final_time, until);
    EXPECT_LE(result.counts.steps, static_cast<long>(until / 1e-3) + 1);
  }
}

TEST_P(FixedStep, segments_join) {
  for (const unsigned seed : {3u, 14u, 27u, 58u}) {
    Scene s = with_solver(test::random_scene(seed), GetParam(), 1e-3);
    s.trial.time_limit = 2.0;
    State before = make_system(s).start;
    double time = 0.0;
    run(s, [&](const Segment& g) {
      EXPECT_EQ(distance(g.begin, before), 0.0);
      EXPECT_EQ(g.start.value(), time);
      EXPECT_EQ(distance(state_at(g, 0.0), g.begin), 0.0);
      EXPECT_LT(distance(state_at(g, g.duration), g.end), 1e-13 * (1.0 + std::abs(g.end.omega)));
      // the direction in which forces act: of first order that of the start, throughout
      const double phi = GetParam() == "rk4" ? g.end.phi : g.begin.phi;
      EXPECT_NEAR(value_at(g.cos_phi, g.order, g.duration), std::cos(phi), 1e-14);
      EXPECT_NEAR(value_at(g.sin_phi, g.order, g.duration), std::sin(phi), 1e-14);
      before = g.end;
      time = g.end_time();
    });
  }
}

TEST_P(FixedStep, a_contact_series_starts_and_ends_where_the_states_say) {
  const Scene s = scene(1e-3);
  const System system = make_system(s);
  long seen = 0;
  run(s, [&](const Segment& g) {
    for (int i = 0; i < g.loaded_count; ++i) {
      const ContactSeries& contact = g.loaded[static_cast<std::size_t>(i)];
      const ContactState& state = g.contacts[static_cast<std::size_t>(contact.site)];
      ASSERT_EQ(state.phase, Phase::loaded);
      for (const bool end : {false, true}) {
        const double t = end ? g.duration : 0.0;
        const ContactKinematics k = contact_kinematics(system, end ? g.end : g.begin, contact.site, state.face);
        EXPECT_NEAR(value_at(contact.depth, g.order, t), k.depth, 1e-15);
        EXPECT_NEAR(value_at(contact.slip_velocity, g.order, t), k.slip_velocity, 1e-14);
      }
      ++seen;
    }
  });
  EXPECT_GT(seen, 200);
}

// The forces that are reported are those that move the part: momentum, step by step. They are constant in a step of the
// methods of first order, with the dampers at its end, the gripper's springs at its start (ode: at its end).
TEST_P(FixedStep, reported_forces_move_the_part) {
  if (GetParam() == "rk4") return;
  const bool implicit = GetParam() == "ode";
  for (const char* law : {"friction.coefficient=0.24", "friction.coefficient=0.9",
                          "friction={coefficient: 0.24, regularization: 2.0e-3}"}) {
    const Scene s =
        scene(1e-3, {law, "contacts=[edges, corners]", "weight=0.1", "initial.phi=-0.03", "initial.vx=0.1"});
    const System system = make_system(s);
    long loaded = 0;
    run(s, [&](const Segment& g) {
      const double h = g.duration;
      const auto gripper = [&](const Axis& axis, double begin, double end, double v) {
        return -axis.stiffness * ((implicit ? end : begin) - axis.anchor) - axis.damping * v;
      };
      double fx = gripper(system.x, g.begin.x, g.end.x, g.end.vx) + g.drive_x[0];
      double fy = gripper(system.y, g.begin.y, g.end.y, g.end.vy) + g.drive_y[0] - system.weight;
      double m = gripper(system.phi, g.begin.phi, g.end.phi, g.end.omega) + g.drive_phi[0];
      for (int i = 0; i < g.loaded_count; ++i) {
        const ContactSeries& contact = g.loaded[static_cast<std::size_t>(i)];
        const ContactKinematics k =
            contact_kinematics(system, g.begin, contact.site, g.contacts[static_cast<std::size_t>(contact.site)].face);
        const double n = contact.normal_force[0], t = contact.tangential_force[0];
        const double px = n * k.normal.x + t * k.tangent.x, py = n * k.normal.y + t * k.tangent.y;
        fx += px;
        fy += py;
        m += k.lever.x * py - k.lever.y * px;
        ++loaded;
      }
      EXPECT_NEAR(g.end.vx - g.begin.vx, h * fx / system.x.inertia, 1e-12);
      EXPECT_NEAR(g.end.vy - g.begin.vy, h * fy / system.y.inertia, 1e-12);
      EXPECT_NEAR(g.end.omega - g.begin.omega, h * m / system.phi.inertia, 1e-12);
    });
    EXPECT_GT(loaded, 100);
  }
}

// What the base gives the part along x, where nothing else acts, is what it has then: an edge on a part that turns.
TEST_P(FixedStep, impulses_add_up_to_the_change_of_momentum) {
  if (GetParam() == "rk4") return;
  const Scene s =
      scene(1e-3, {"gripper={stiffness: {x: 0, phi: 1}, damping: {x: 0}, pressing_force: 0.5}",
                   "initial={x: 0.2, y: 0.8, phi: 0.1, vy: -0.3, omega: 1}", "trial.time_limit=0.2"});
  const System system = make_system(s);
  double sum = 0.0, most_turn = 0.0, vx = 0.0;
  run(s, [&](const Segment& g) {
    for (int i = 0; i < g.loaded_count; ++i) sum += contact_impulse(system, g, i, 0.0, g.duration).x;
    most_turn = std::max(most_turn, std::abs(g.end.phi - g.begin.phi));
    vx = g.end.vx;
  });
  EXPECT_GT(std::abs(vx), 0.1);
  EXPECT_GT(most_turn, 1e-3);
  EXPECT_NEAR(sum, vx * system.x.inertia, 1e-13);
}

// A part at rest on the base stays there, whatever the step: what the base and the gripper carry depends on stiffness
// alone. Tilted on an anisotropic base, or flat on an edge and a corner at once.
TEST_P(FixedStep, rest_does_not_depend_on_the_step) {
  const std::vector<std::vector<std::string>> rests = {
      {"gripper.anchor.phi=0.3"}, {"contacts=[edges, corners]"}, {"contacts=[corners]", "gripper.anchor.phi=-0.03"}};
  for (std::vector<std::string> settings : rests) {
    settings.insert(settings.end(),
                    {"excitation.amplitude=0", "friction=null", "gripper.pressing_force=0.7", "gripper.stiffness.x=50",
                     "gripper.damping={x: 14, y: 1.5, phi: 3}", "initial={x: 0.21}", "trial.time_limit=1"});
    // where it comes to rest, by the exact solver
    Scene s = with_event_solver(scene_of(test::plain, settings));
    const State rest = run(s, {}, 60.0).final_state;
    ASSERT_LT(std::abs(rest.vx) + std::abs(rest.vy) + std::abs(rest.omega), 1e-12);
    s.gripper.anchor_y = make_system(s).y.anchor;
    s.gripper.pressing_force.reset();
    s.initial = {rest.x, rest.y, rest.phi, 0.0, 0.0, 0.0};
    for (const double h : {5e-3, 1e-3, 1e-4}) {
      const State end = run(with_solver(s, GetParam(), h), {}, 0.5).final_state;
      EXPECT_LT(distance(end, rest), 1e-11) << settings[0] << " step " << h;
    }
  }
}

TEST_P(FixedStep, impulses_of_samples_add_up_to_those_of_the_run) {
  const Scene s = scene(1e-3);
  double impulse = 0.0;
  run(s, [&](const Segment& g) {
    for (int i = 0; i < g.loaded_count; ++i)
      impulse += integral(g.loaded[static_cast<std::size_t>(i)].normal_force, g.order, 0.0, g.duration);
  });
  Simulation simulation(s);
  Sampler sampler(simulation, 0.0137, true);
  Sample sample;
  double sampled = 0.0;
  while (sampler.next(sample))
    for (const ContactSample& contact : sample.contacts) sampled += contact.normal_impulse;
  EXPECT_NEAR(sampled, impulse, 1e-12 * impulse);
}

// A cut ends the segment where it is, as it has been seen; the steps go on to their grid.
TEST_P(FixedStep, a_cut_keeps_what_has_been_seen_and_the_grid) {
  const Scene s = scene(1e-3);
  const System system = make_system(s);
  const std::unique_ptr<Solver> solver = make_solver(system, s.excitations, s.solver);
  for (int i = 0; i < 3; ++i) solver->advance(3.0);
  const Segment seen = solver->segment();
  const State state = state_at(seen, 4e-4);
  solver->cut(4e-4);
  EXPECT_EQ(solver->segment().duration, 4e-4);
  EXPECT_EQ(distance(solver->segment().end, state), 0.0);
  EXPECT_EQ(solver->advance(3.0).start.value(), 2e-3 + 4e-4);
  EXPECT_EQ(distance(solver->segment().begin, state), 0.0);
  EXPECT_NEAR(solver->segment().duration, 6e-4, 1e-18);
  EXPECT_NEAR(solver->segment().end_time(), 3e-3, 1e-17);
  EXPECT_EQ(solver->advance(3.0).duration, 1e-3);
  // nothing left of a step
  solver->cut(0.0);
  EXPECT_EQ(solver->segment().event_count, 0);
  EXPECT_EQ(distance(solver->segment().end, solver->segment().begin), 0.0);
  EXPECT_NEAR(solver->advance(3.0).end_time(), 4e-3, 1e-17);
  // a rest of rounding is joined to the next step
  solver->cut(solver->segment().duration * (1.0 - 1e-9));
  EXPECT_NEAR(solver->advance(3.0).end_time(), 5e-3, 1e-17);
  EXPECT_GE(solver->segment().duration, 1e-3);
}

// A run that is cut again and again differs from one that is not by as much as the steps are inexact.
TEST_P(FixedStep, cuts_cost_no_more_than_the_steps) {
  for (const double h : {1e-3, 1e-4}) {
    const Scene s = scene(h);
    const TrialResult plain = run(s);
    SimulationOptions options;
    options.until = s.trial.time_limit;
    Simulation simulation(s, options);
    double next = 0.0137;
    while (simulation.advance())
      if (next < simulation.segment().end_time()) {
        simulation.cut(next);
        next += 0.0137;
      }
    EXPECT_LT(distance(simulation.result().final_state, plain.final_state), 30.0 * h);
    EXPECT_LT(simulation.result().energy->residual, 100.0 * h);
  }
}

// Changes enter where the segment has been cut, with the phase going on: as a new trial from there with that phase.
TEST_P(FixedStep, changes_enter_where_the_segment_ends) {
  Scene s = scene(1e-3, {"initial.y=3"});
  const double when = 0.25;  // in the air, where the state alone says how it goes on
  std::vector<Excitation> faster = s.excitations;
  faster[0].frequency = 31.0;
  faster[0].amplitude = 1.4;
  SimulationOptions options;
  options.until = 0.75;
  Simulation simulation(s, options);
  State at_change;
  bool changed = false;
  while (simulation.advance()) {
    if (changed || simulation.segment().end_time() < when - 1e-9) continue;
    at_change = simulation.segment().end;
    simulation.set_excitations(faster);
    changed = true;
  }
  Scene rest = s;
  rest.initial = {at_change.x, at_change.y, at_change.phi, at_change.vx, at_change.vy, at_change.omega};
  rest.excitations = faster;
  rest.excitations[0].phase = s.excitations[0].phase + s.excitations[0].frequency * when;
  rest.gripper.anchor_y = make_system(s).y.anchor;
  rest.gripper.pressing_force.reset();
  EXPECT_LT(distance(simulation.result().final_state, run(rest, {}, 0.5).final_state), 1e-12);
}

TEST_P(FixedStep, the_anchor_can_be_moved) {
  const Scene s = scene(1e-3, {"initial.y=3"});
  SimulationOptions options;
  options.until = 0.5;
  Simulation low(s, options), high(s, options);
  low.advance();
  high.advance();
  low.set_pressing_force(0.9);
  high.set_pressing_force(0.1);
  while (low.advance()) {
  }
  while (high.advance()) {
  }
  EXPECT_LT(low.result().final_state.y, high.result().final_state.y - 0.05);
  EXPECT_LT(low.result().energy->residual, 0.05);
}

// An undamped oscillation of the part in its gripper: what each method makes of its amplitude is known.
TEST_P(FixedStep, a_free_oscillation_keeps_or_loses_what_theory_says) {
  const double h = 0.05, amplitude = 0.3;
  const long steps = 20000;
  Scene s = scene(h, {"excitation.amplitude=0", "gripper={anchor: {y: 5}}", "initial={x: 0, y: 5.3, phi: 0}",
                      "part.inertia=null", "trial.time_limit=1000"});
  double factor = 1.0;  // of the amplitude, in a step
  if (GetParam() == "rk4") factor = std::sqrt(1.0 - std::pow(h, 6) / 72.0 + std::pow(h, 8) / 576.0);
  if (GetParam() == "ode") factor = 1.0 / std::sqrt(1.0 + h * h);
  const double expected = amplitude * std::pow(factor, steps);
  const State end = run(s, {}, static_cast<double>(steps) * h).final_state;
  // of the symplectic method what is conserved is q^2 + v^2 - h q v
  const double q = end.y - 5.0, v = end.vy;
  const double squared = q * q + v * v - (GetParam() == "semi_implicit" ? h * q * v : 0.0);
  EXPECT_NEAR(std::sqrt(squared), expected, 1e-9 * amplitude);
}

// A part that starts exactly on its base and moves into it is pushed by the damper from the start on: smooth motion,
// in which each method has its order.
TEST_P(FixedStep, a_start_exactly_on_a_face_costs_no_order) {
  const Scene ball = scene_of(test::ball, {"base={stiffness: {y: 400}, damping: {y: 8}}", "friction=null",
                                           "initial={x: 0.2, y: 0.9, vy: -1}"});
  const double until = 0.02;
  const double exact = run(with_event_solver(ball), {}, until).final_state.y;
  const auto error = [&](double h) {
    return std::abs(run(with_solver(ball, GetParam(), h), {}, until).final_state.y - exact);
  };
  const double order = test::order_between(2e-3, error(2e-3), 1e-3, error(1e-3));
  EXPECT_NEAR(order, test::order_of(GetParam()), 0.3);
}

// ... and the force that is reported at the start is that of the base.
TEST_P(FixedStep, a_start_exactly_on_a_face_is_pushed_at_once) {
  if (GetParam() != "rk4") return;
  const Scene ball = with_solver(scene_of(test::ball, {"base={stiffness: {y: 400}, damping: {y: 8}}", "friction=null",
                                                       "initial={x: 0.2, y: 0.9, vy: -1}"}),
                                 GetParam(), 1e-3);
  double first = -1.0;
  run(
      ball,
      [&](const Segment& g) {
        if (first < 0.0 && g.loaded_count > 0) first = g.loaded[0].normal_force[0];
      },
      0.01);
  EXPECT_NEAR(first, 8.0, 1e-12);
}

// At rest exactly on its base, with a force that begins at zero: it has touched at the start, whichever step moves it.
TEST_P(FixedStep, a_start_on_a_face_without_force_is_no_impact) {
  const Scene ball = with_solver(scene_of(test::ball, {"gripper.anchor.y=0.9", "excitation.amplitude=-1",
                                                       "initial={x: 0.2, y: 0.9}", "trial.time_limit=0.2"}),
                                 GetParam(), 1e-4);
  const TrialResult result = run(ball);
  EXPECT_EQ(result.impacts[0], 0);
  EXPECT_FALSE(result.first_contact);
}

// Steps far too long for the scene: an outcome in finite numbers or a failure with a reason, never for ever.
TEST_P(FixedStep, steps_that_are_too_long_come_to_an_end) {
  for (const double h : {0.02, 0.3, 5.0, 1e6})
    for (unsigned seed = 1; seed <= 20; ++seed) {
      Scene s = with_solver(test::random_scene(seed), GetParam(), h);
      const TrialResult result = run(s);
      EXPECT_NE(result.outcome, Outcome::running);
      EXPECT_EQ(result.outcome == Outcome::failed, !result.failure.empty());
      const State& e = result.final_state;
      EXPECT_TRUE(std::isfinite(e.x + e.y + e.phi + e.vx + e.vy + e.omega));
    }
}

TEST_P(FixedStep, the_step_limit_ends_the_trial) {
  Scene s = scene(1e-3);
  s.solver.step_limit = 50;
  const TrialResult result = run(s);
  EXPECT_EQ(result.outcome, Outcome::failed);
  EXPECT_NE(result.failure.find("step limit of 50"), std::string::npos) << result.failure;
}

TEST_P(FixedStep, a_missing_step_is_refused) {
  Scene s = scene(1e-3);
  s.solver.step.reset();
  try {
    Simulation simulation(s);
    ADD_FAILURE() << "ran without a step";
  } catch (const std::invalid_argument& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("solver.step: missing"), std::string::npos) << refusal.what();
    EXPECT_NE(std::string(refusal.what()).find(GetParam()), std::string::npos) << refusal.what();
  }
}

TEST_P(FixedStep, more_excitations_than_any_solver_simulates_are_refused) {
  Scene s = scene(1e-3);
  s.excitations.resize(17, s.excitations[0]);
  EXPECT_THROW(Simulation simulation(s), std::invalid_argument);
}

TEST(FixedStepNames, a_solver_that_is_not_there_is_refused_with_those_that_are) {
  Scene s = scene_of(test::plain);
  s.solver.name = "magic";
  try {
    Simulation simulation(s);
    ADD_FAILURE() << "ran";
  } catch (const std::invalid_argument& refusal) {
    for (const char* name : {"magic", "event", "rk4", "semi_implicit", "ode"})
      EXPECT_NE(std::string(refusal.what()).find(name), std::string::npos) << refusal.what();
  }
}

}  // namespace
}  // namespace vibratory_alignment
