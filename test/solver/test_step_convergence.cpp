// The solvers with a fixed step converge to what the solver `event` and two independent methods give: each with its own
// order as long as the motion is smooth, and with order one over touches, releases and sticking, which none of them
// locates.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../support/fixed_step.h"
#include "../support/reference_scene.h"

namespace vibratory_alignment {
namespace {

using test::distance;
using test::Look;
using test::order_between;
using test::order_of;
using test::run;
using test::scene_of;
using test::with_event_solver;
using test::with_solver;

class StepConvergence : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(solver, StepConvergence, testing::ValuesIn(test::fixed_step_solvers()),
                         [](const auto& info) { return info.param; });

/// Pressed harder than it is shaken, and pushed along: one contact that slides one way, no event.
Scene sliding(const std::string& friction) {
  return scene_of(test::plain,
                  {"gripper.pressing_force=2", "initial={x: 0.21, phi: 0.02, vx: 0.5}", "excitation.frequency=9",
                   "gripper.stiffness.x=2", "gripper.damping.x=0.4", "base.stiffness={x: 300, y: 400}",
                   "base.damping={x: 2, y: 3}", "trial.time_limit=0.5", friction});
}

constexpr const char* kFrictions[] = {"friction.coefficient=0.24", "friction={coefficient: 0.24, regularization: 1.0}",
                                      "friction=null"};

/// Errors of state, N and T: the largest over the instants looked at.
struct Errors {
  double state = 0.0, normal = 0.0, tangential = 0.0;
};

Errors errors_of(const Scene& scene, const std::vector<Look>& expected, const std::vector<double>& times) {
  const std::vector<Look> found = test::looks_at(scene, times, Site::a1);
  Errors errors;
  for (std::size_t i = 0; i < times.size(); ++i) {
    errors.state = std::max(errors.state, distance(found[i].state, expected[i].state));
    errors.normal = std::max(errors.normal, std::abs(found[i].normal_force - expected[i].normal_force));
    errors.tangential = std::max(errors.tangential, std::abs(found[i].tangential_force - expected[i].tangential_force));
  }
  return errors;
}

TEST_P(StepConvergence, has_the_order_of_the_method_within_a_contact) {
  const double order = order_of(GetParam());
  for (const char* friction : kFrictions) {
    const Scene scene = sliding(friction);
    long events = 0;
    run(with_event_solver(scene), [&](const Segment& g) { events += g.event_count; });
    ASSERT_EQ(events, 0) << friction;
    // ends of steps, where the forces are those of the method and not interpolated
    const std::vector<double> times = {0.1, 0.2, 0.3, 0.4};
    const std::vector<Look> expected = test::looks_at(with_event_solver(scene), times, Site::a1);
    const double h = GetParam() == "rk4" ? 5e-3 : 2e-4;
    const Errors coarse = errors_of(with_solver(scene, GetParam(), h), expected, times);
    const Errors fine = errors_of(with_solver(scene, GetParam(), h / 4), expected, times);
    EXPECT_NEAR(order_between(4, coarse.state, 1, fine.state), order, 0.15) << friction;
    EXPECT_NEAR(order_between(4, coarse.normal, 1, fine.normal), order, 0.15) << friction;
    if (scene.friction) {
      EXPECT_NEAR(order_between(4, coarse.tangential, 1, fine.tangential), order, 0.15) << friction;
    }
  }
}

// Between the ends of steps motion and forces are interpolated: the motion as well as the method, the forces of rk4 by
// lines.
TEST_P(StepConvergence, holds_between_the_ends_of_steps) {
  const double order = order_of(GetParam()), force_order = std::min(order, 2.0);
  for (const char* friction : kFrictions) {
    const Scene scene = sliding(friction);
    const double h = GetParam() == "rk4" ? 5e-3 : 2e-4;
    // the same places within steps of h and h/4
    std::vector<double> times;
    for (const double start : {0.1, 0.2, 0.3, 0.4})
      for (const double share : {0.1, 0.3, 0.5, 0.7, 0.9}) times.push_back(start + share * h);
    std::vector<double> fine_times;
    for (const double start : {0.1, 0.2, 0.3, 0.4})
      for (const double share : {0.1, 0.3, 0.5, 0.7, 0.9}) fine_times.push_back(start + share * h / 4);
    const Errors coarse =
        errors_of(with_solver(scene, GetParam(), h), test::looks_at(with_event_solver(scene), times, Site::a1), times);
    const Errors fine = errors_of(with_solver(scene, GetParam(), h / 4),
                                  test::looks_at(with_event_solver(scene), fine_times, Site::a1), fine_times);
    EXPECT_NEAR(order_between(4, coarse.state, 1, fine.state), order, 0.3) << friction;
    EXPECT_NEAR(order_between(4, coarse.normal, 1, fine.normal), force_order, 0.3) << friction;
  }
}

// Loads of other waveforms, whose kinks fall inside steps: at least first order, whatever the phase of the kinks.
TEST_P(StepConvergence, passes_over_kinks_of_the_excitation) {
  for (const char* waveform :
       {"waveform: square", "waveform: triangle", "waveform: chirp, end_frequency: 7, sweep_time: 0.417"}) {
    const Scene scene =
        scene_of(test::plain, {"initial={x: 0.2, y: 3, phi: 0.3, vx: 0.5, vy: 0.2, omega: -1}",
                               std::string("excitation=[{amplitude: 1, frequency: 19, ") + waveform +
                                   "}, {amplitude: 0.3, frequency: 11, direction: phi, " + waveform + "}]"});
    const State expected = run(with_event_solver(scene), {}, 0.8).final_state;
    for (const double h : {1e-2, 7.3e-3, 1e-3, 7.3e-4, 1e-4})
      EXPECT_LT(distance(run(with_solver(scene, GetParam(), h), {}, 0.8).final_state, expected), 30.0 * h)
          << waveform << " step " << h;
  }
}

class StepReference : public testing::TestWithParam<std::tuple<std::string, reference::ReferenceCase>> {};
INSTANTIATE_TEST_SUITE_P(solver, StepReference,
                         testing::Combine(testing::ValuesIn(test::fixed_step_solvers()),
                                          testing::ValuesIn(reference::referenceCases())),
                         [](const auto& info) { return std::get<0>(info.param) + "_" + std::get<1>(info.param).name; });

TEST_P(StepReference, forces_and_energy_converge) {
  const auto& [solver, c] = GetParam();
  const Scene scene = test::scene_of_reference(c);
  const double h = 1e-4;
  const TrialResult event = run(with_event_solver(scene), {}, scene.trial.time_limit);
  const TrialResult result = run(with_solver(scene, solver, h), {}, scene.trial.time_limit);
  // N changes by (k d' + h d'') h in a step: k up to 7600, speeds up to 0.3
  for (std::size_t spot = 0; spot < kSpotCount; ++spot)
    EXPECT_NEAR(result.peak_force[spot], event.peak_force[spot], 2500.0 * h) << "spot " << spot;
  EXPECT_LT(result.energy->residual, 100.0 * h);
  EXPECT_NEAR(result.energy->friction_loss, event.energy->friction_loss, 100.0 * h * event.energy->exchanged);
}

}  // namespace
}  // namespace vibratory_alignment
