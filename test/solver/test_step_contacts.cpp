// What a fixed step makes of impacts, of friction and of a base that recovers, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../support/fixed_step.h"
#include "../support/random_scenes.h"
#include "../support/reference_scene.h"

namespace vibratory_alignment {
namespace {

using test::distance;
using test::run;
using test::scene_of;
using test::with_event_solver;
using test::with_solver;

class StepContacts : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(solver, StepContacts, testing::ValuesIn(test::fixed_step_solvers()),
                         [](const auto& info) { return info.param; });

/// A ball that falls on a base with k = 1e4 and the damping ratio zeta.
Scene ball(double zeta) {
  Scene scene = scene_of(test::ball, {"gripper.anchor.y=0.9", "initial.y=1.2"});
  scene.base.damping_x = scene.base.damping_y = 2.0 * zeta * 100.0;
  return scene;
}

/// Speed before and after the first impact, and the depth that was noticed first.
struct Impact {
  double before = 0.0, first_depth = 0.0, after = 0.0;
};

Impact first_impact(const Scene& scene) {
  Impact impact;
  for (const test::TimedEvent& e : test::events_of(scene, 3.0)) {
    if (e.event.kind == EventKind::touch && impact.before == 0.0) {
      impact.before = -e.state.vy;
      impact.first_depth = 0.9 - e.state.y;
    }
    if (e.event.kind == EventKind::release && impact.after == 0.0) impact.after = e.state.vy;
  }
  return impact;
}

/// Push only: the ball leaves when k d + h d' = 0.
double restitution(double zeta) {
  const double beta = std::sqrt(1.0 - zeta * zeta);
  return std::exp(-zeta / beta * std::atan2(2.0 * zeta * beta, 2.0 * zeta * zeta - 1.0));
}

TEST_P(StepContacts, restitution_tends_to_that_of_the_base) {
  for (const double zeta : {0.1, 0.3, 0.6})
    for (const double h : {1e-3, 3e-4, 1e-4, 1e-5}) {
      const Impact impact = first_impact(with_solver(ball(zeta), GetParam(), h));
      // h omega = 100 h; the touch is noticed up to h late
      EXPECT_NEAR(impact.after / impact.before, restitution(zeta), 1.5 * 100.0 * h) << zeta << " step " << h;
    }
}

// The impact of the methods of first order is a recurrence of one line. `ode`: spring, damper and gripper at the end of
// the step, so that a step acts as an additional damping ratio of about h omega/2; `semi_implicit`: the springs at the
// start, the damper at the end.
TEST_P(StepContacts, an_impact_is_the_recurrence_of_the_method) {
  if (GetParam() == "rk4") return;
  const bool implicit = GetParam() == "ode";
  for (const double zeta : {0.0, 0.1, 0.6, 3.0})
    for (const double h : {3e-3, 1e-3, 1e-4}) {
      const Impact impact = first_impact(with_solver(ball(zeta), GetParam(), h));
      const double k = 1e4, c = 2.0 * zeta * 100.0;
      double depth = impact.first_depth, rate = impact.before;
      // the gripper's spring, of stiffness 1, pulls back to depth 0
      for (int i = 0; i < 100000 && depth > 0.0 && k * depth + c * rate > 0.0; ++i) {
        const double spring = implicit ? h * (k + 1.0) : 0.0, free_spring = implicit ? h : 0.0;
        const double pressed = (rate - h * (k + 1.0) * depth) / (1.0 + h * (c + spring));
        const double push = k * (depth + (implicit ? h * pressed : 0.0)) + c * pressed;
        rate = push > 0.0 ? pressed : (rate - h * depth) / (1.0 + h * free_spring);
        depth += h * rate;
      }
      EXPECT_NEAR(impact.after, -rate, 1e-9) << zeta << " step " << h;
    }
}

TEST_P(StepContacts, ode_damps_an_impact_by_half_h_omega) {
  if (GetParam() != "ode") return;
  for (const double zeta : {0.05, 0.2})
    for (const double h : {5e-4, 1e-4}) {
      const Impact impact = first_impact(with_solver(ball(zeta), "ode", h));
      const double more = zeta + 0.5 * 100.0 * h;
      EXPECT_NEAR(impact.after / impact.before, restitution(more), 0.5 * 100.0 * h);
      EXPECT_LT(impact.after / impact.before, restitution(zeta));
    }
}

/// A block pressed on the edge, free to slide along x, that is shaken with a share of f N.
Scene block(double share) {
  Scene scene = scene_of(R"(
part: {half_width: 0.7, base_distance: 0.9}
slot: {clearance: 0.09}
gripper: {stiffness: {x: 0.0}, anchor: {x: 0.3}, pressing_force: 0.5}
base: {stiffness: {y: 1.0e4}, damping: {y: 20.0}}
contacts: [edges]
friction: {coefficient: 0.4}
excitation: {amplitude: 0.1, frequency: 3.0, direction: x}
initial: {x: 0.3}
trial: {time_limit: 6.0}
)");
  scene.excitations[0].amplitude = share * 0.4 * 0.5 / (1.0 + 1e-4);
  return scene;
}

// Below f N the block does not move at all; with ode it creeps with its softness, 1e-10 per force.
TEST_P(StepContacts, a_block_that_sticks_stays) {
  if (GetParam() == "rk4") return;
  const double creep = GetParam() == "ode" ? 1e-10 : 1e-16;
  for (const double share : {0.3, 0.999}) {
    const Scene scene = with_solver(block(share), GetParam(), 1e-3);
    const TrialResult result = run(scene, [&](const Segment& g) {
      ASSERT_EQ(g.contacts[0].slip, Slip::stick);
      ASSERT_LE(std::abs(g.end.vx), creep);
      // the friction is what it takes
      ASSERT_EQ(g.loaded_count, 1);
      ASSERT_NEAR(g.loaded[0].tangential_force[0], -g.drive_x[0], creep / 1e-3);
    });
    EXPECT_NEAR(result.final_state.x, 0.3, 6.0 * creep) << share;
    EXPECT_LE(result.counts.events, 1) << share;
  }
}

// rk4 has no sticking: the block creeps through the layer, V = eps atanh(|T|/f N), eps = h f N for a mass of 1.
TEST_P(StepContacts, rk4_creeps_where_it_should_stick) {
  if (GetParam() != "rk4") return;
  const double limit = 0.4 * 0.5 / (1.0 + 1e-4);
  for (const double h : {1e-3, 1e-4}) {
    double moved = 0.0, most = 0.0, way = 0.0;
    const double share = 0.6;
    // the way in the first half turn of the excitation
    for (int i = 0; i < 1000; ++i)
      way += h * limit * std::atanh(share * std::sin(M_PI * (i + 0.5) / 1000)) * M_PI / 3000;
    run(with_solver(block(share), "rk4", h), [&](const Segment& g) {
      const double v = h * limit * std::atanh(share * std::sin(3.0 * g.end_time()));
      most = std::max(most, std::abs(g.end.vx - v));
      moved = std::max(moved, std::abs(g.end.x - 0.3));
    });
    EXPECT_LT(most, 5.0 * h * h);
    EXPECT_NEAR(moved, way, 0.02 * way);
  }
}

// Shaken harder, it slips and sticks by turns, and loses what the exact solver says.
TEST_P(StepContacts, a_block_that_slips_and_sticks_converges) {
  const Scene scene = block(1.5);
  const TrialResult event = run(with_event_solver(scene));
  for (const double h : {1e-3, 1e-4}) {
    const TrialResult result = run(with_solver(scene, GetParam(), h));
    EXPECT_LT(distance(result.final_state, event.final_state), 2.0 * h);
    EXPECT_NEAR(result.energy->friction_loss, event.energy->friction_loss, 50.0 * h * event.energy->friction_loss);
  }
}

// |T| <= f N, and V = 0 unless |T| = f N against it: at the end of every step, in whatever scene; in the last one two
// contacts stick together now and then.
TEST_P(StepContacts, semi_implicit_obeys_the_set_valued_law) {
  if (GetParam() != "semi_implicit") return;
  std::vector<Scene> scenes;
  for (unsigned seed = 1; seed <= 60; ++seed) scenes.push_back(test::random_scene(seed));
  scenes.push_back(test::scene_of_reference(reference::caseWedge()));
  long sticking = 0, sliding = 0, together = 0;
  for (Scene& s : scenes) {
    if (!s.friction || s.friction->regularization) continue;
    s.trial.time_limit = std::min(3.0, s.trial.time_limit);
    const double f = s.friction->coefficient;
    run(with_solver(s, GetParam(), 1e-3), [&](const Segment& g) {
      const double speed = std::abs(g.end.vx) + std::abs(g.end.vy) + 3.0 * std::abs(g.end.omega);
      int still = 0;
      for (int i = 0; i < g.loaded_count; ++i) {
        const ContactSeries& contact = g.loaded[static_cast<std::size_t>(i)];
        const double n = contact.normal_force[0], t = contact.tangential_force[0];
        const double v = value_at(contact.slip_velocity, 1, g.duration);
        if (std::abs(t) < f * n) {
          EXPECT_LT(std::abs(v), 1e-13 * (1e-2 + speed));
          ++sticking;
          ++still;
        } else if (n > 0.0) {
          EXPECT_LE(v * t, 1e-13 * speed * n);
          ++sliding;
        }
      }
      if (still > 1) ++together;
    });
  }
  EXPECT_GT(sticking, 1000);
  EXPECT_GT(sliding, 1000);
  EXPECT_GT(together, 100);
}

TEST_P(StepContacts, semi_implicit_obeys_the_regularised_law_at_the_end_of_steps) {
  if (GetParam() != "semi_implicit") return;
  for (const double eps : {1e-2, 1e-4, 1e-6}) {
    Scene s = with_solver(scene_of(test::plain), GetParam(), 1e-3);
    s.friction->regularization = eps;
    run(s, [&](const Segment& g) {
      for (int i = 0; i < g.loaded_count; ++i) {
        const ContactSeries& contact = g.loaded[static_cast<std::size_t>(i)];
        const double v = value_at(contact.slip_velocity, 1, g.duration);
        const double limit = 0.24 * contact.normal_force[0];
        EXPECT_NEAR(contact.tangential_force[0], -limit * std::tanh(v / eps), limit * (1e-14 + 1e-15 / eps));
      }
    });
  }
}

// Two corners that stand flat on the floor, shaken along it: they share the friction alike.
TEST_P(StepContacts, contacts_that_hold_the_same_motion_share_the_friction) {
  Scene s = scene_of(R"(
part: {half_width: 0.67, base_distance: 0.93}
slot: {clearance: 0.05, depth: 0.3}
gripper: {stiffness: {x: 0.07}, anchor: {y: -0.2}}
base: {stiffness: {y: 4100.0}, damping: {y: 17.0}}
contacts: [edges, corners, walls]
friction: {coefficient: 0.4}
excitation: {amplitude: 0.1, frequency: 3.0, direction: x}
initial: {x: 0.0, y: 0.63}
trial: {time_limit: 3.0, aligned_depth: 0.29}
)");
  long looked = 0;
  run(
      with_solver(s, GetParam(), 1e-3),
      [&](const Segment& g) {
        if (g.loaded_count != 2 || g.loaded[0].normal_force[0] < 0.01) return;
        EXPECT_NEAR(g.loaded[0].normal_force[0], g.loaded[1].normal_force[0], 1e-9);
        EXPECT_NEAR(g.loaded[0].tangential_force[0], g.loaded[1].tangential_force[0], 1e-9);
        ++looked;
      },
      s.trial.time_limit);
  EXPECT_GT(looked, 1000);
}

// The contact that a trial starts in is no impact, also where its depth is zero; and an outcome that holds at the start
// is of the start.
TEST_P(StepContacts, what_holds_at_the_start_happens_there) {
  for (const double h : {1e-3, 1e-4}) {
    const Scene on_face = with_solver(scene_of(test::ball, {"initial.y=0.9"}), GetParam(), h);
    const TrialResult result = run(on_face, {}, 0.1);
    EXPECT_EQ(result.impacts[0], 0);
    EXPECT_GT(result.peak_force[0], 0.2);
    EXPECT_FALSE(result.first_contact);
    // it is deep enough in the slot for less than a step
    const Scene aligned = with_solver(scene_of(test::ball, {"initial={x: 0, y: 0.799995, vy: 1}",
                                                            "trial.aligned_depth=0.1", "gripper.anchor.y=0.95"}),
                                      GetParam(), h);
    const TrialResult at_once = run(aligned);
    EXPECT_EQ(at_once.outcome, Outcome::aligned);
    EXPECT_EQ(at_once.aligned_time, 0.0);
  }
}

// An edge and a corner under a base whose damper stops the part within a two hundredth of a step: both have the same d'
// and k, so that N differs by k times the difference of the depths, at every instant.
TEST_P(StepContacts, strong_dampers_leave_the_difference_of_two_forces_to_the_springs) {
  if (GetParam() == "rk4") return;  // such dampers bound its steps
  const double k = 1e6;
  const std::vector<std::string> settings = {
      "part={half_width: 0.6, base_distance: 0.9}", "base={stiffness: {x: 1e6, y: 1e6}, damping: {x: 2e5, y: 2e5}}",
      "gripper.anchor.y=-2.1", "contacts=[edges, corners]", "initial={x: 0.2, y: 0.899985, phi: 1e-5}"};
  for (const double h : {1e-3, 2e-5}) {
    double looked = 0.0;
    run(
        with_solver(scene_of(test::ball, settings), GetParam(), h),
        [&](const Segment& g) {
          if (g.loaded_count != 2) return;
          const ContactSeries &a = g.loaded[0], &b = g.loaded[1];
          const double apart = k * (a.depth[0] - b.depth[0]);
          EXPECT_NEAR(a.normal_force[0] - b.normal_force[0], apart, 1e-6 * std::abs(apart));
          looked += g.duration;
        },
        0.02);
    EXPECT_GT(looked, 0.015);
  }
}

// A ball that is shaken on a base with k/h = 2.7 or 29, slow beside its flights.
TEST_P(StepContacts, a_base_that_recovers_converges) {
  for (const std::vector<std::string>& base :
       {std::vector<std::string>{"base.stiffness.y=30", "base.damping.y=11",
                                 "excitation={amplitude: 3, frequency: 15}"},
        {"base.stiffness.y=300", "base.damping.y=10.4", "excitation={amplitude: 6, frequency: 40}"}}) {
    std::vector<std::string> settings = {"gripper={damping: {y: 0.05}, anchor: {y: 0.6}}", "initial.y=0.95",
                                         "base.recovery=true"};
    settings.insert(settings.end(), base.begin(), base.end());
    const Scene scene = scene_of(test::ball, settings);
    const TrialResult event = run(with_event_solver(scene), {}, 3.0);
    Scene plain = scene;
    plain.base.recovery = false;
    // it matters
    EXPECT_GT(distance(run(with_event_solver(plain), {}, 3.0).final_state, event.final_state), 0.02);
    for (const double h : {1e-3, 1e-4}) {
      const TrialResult result = run(with_solver(scene, GetParam(), h), {}, 3.0);
      EXPECT_LT(distance(result.final_state, event.final_state), 5.0 * h) << "step " << h;
      EXPECT_LT(result.energy->residual, 100.0 * h) << "step " << h;
    }
  }
}

}  // namespace
}  // namespace vibratory_alignment
