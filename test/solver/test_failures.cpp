// A run that cannot go on ends as failed, with a reason and the last good state: never silent, never for ever.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "../support/runs.h"
#include "../support/scenes.h"
#include "trial/sampler.h"

namespace vibratory_alignment {
namespace {

using test::run;
using test::scene_of;

TEST(Failures, the_step_limit_ends_the_trial) {
  for (const long limit : {1L, 2L, 10L, 50L}) {
    Scene scene = scene_of(test::plain);
    scene.solver.step_limit = limit;
    const TrialResult result = run(scene);
    EXPECT_EQ(result.outcome, Outcome::failed);
    EXPECT_NE(result.failure.find("step limit"), std::string::npos) << result.failure;
    EXPECT_NE(result.failure.find(std::to_string(limit)), std::string::npos) << result.failure;
    EXPECT_LE(result.counts.steps, limit + 1);
    EXPECT_TRUE(is_finite(result.final_state));
  }
}

// In SI units 1 is 4 ms and 3 mm here: M = 0.064 kg, K_Y = 4000 N/m, F1 = 12 N.
TEST(Failures, say_where_in_the_units_of_the_scene) {
  Scene scene = scene_of(test::plain);
  scene.solver.step_limit = 20;
  const TrialResult plain = run(scene);
  const auto place = [&](double time, const char* second, double length, const char* metre, const char* radian) {
    std::ostringstream text;
    text << "step limit of 20 reached at time " << plain.final_time * time << second
         << ", x = " << plain.final_state.x * length << metre << ", y = " << plain.final_state.y * length << metre
         << ", phi = " << plain.final_state.phi << radian;
    return text.str();
  };
  EXPECT_GT(plain.final_time, 0.0);
  EXPECT_EQ(plain.failure, place(1.0, " (dimensionless)", 1.0, "", ""));
  scene.units = Units::si;
  scene.scales = Scales{0.064, 4000.0, 12.0};
  EXPECT_EQ(run(scene).failure, place(4e-3, " s", 3e-3, " m", " rad"));
}

TEST(Failures, an_ended_trial_stays_ended) {
  Scene scene = scene_of(test::plain);
  scene.solver.step_limit = 5;
  Simulation simulation(scene);
  while (simulation.advance()) {
  }
  EXPECT_TRUE(simulation.ended());
  EXPECT_FALSE(simulation.advance());
  EXPECT_FALSE(simulation.advance());
  EXPECT_EQ(simulation.result().outcome, Outcome::failed);
}

bool is_finite(const Sample& sample) {
  double sum = 0.0;
  for (const ContactSample& contact : sample.contacts) sum += contact.peak_normal_force + contact.normal_force;
  return std::isfinite(sum) && is_finite(sample.state);
}

/// Runs a scene, also sampled, with numbers that no loader would pass in a process of its own, which the system ends if
/// it hangs.
/// Exit status: 0 an outcome in finite numbers, 1 failed with a reason, else a fault.
int in_own_process(Scene scene) {
  const rlimit seconds{20, 20};  // of processor time: the machine may have other work
  setrlimit(RLIMIT_CPU, &seconds);
  scene.solver.step_limit = 5000;
  const TrialResult result = run(scene);
  Simulation simulation(scene);
  Sampler sampler(simulation, 0.01 * scene.trial.time_limit, true);
  Sample sample;
  while (sampler.next(sample))
    if (!is_finite(sample)) return 5;
  if (simulation.result().outcome != result.outcome) return 6;
  if (result.outcome == Outcome::failed) return result.failure.find(" at time ") == std::string::npos ? 2 : 1;
  if (result.outcome == Outcome::running) return 3;
  return is_finite(result.final_state) ? 0 : 4;
}

bool ended(int status) { return WIFEXITED(status) && WEXITSTATUS(status) <= 1; }
bool failed(int status) { return WIFEXITED(status) && WEXITSTATUS(status) == 1; }

struct Absurdity {
  std::string name;
  std::function<void(Scene&, double)> make;
};

TEST(FailuresDeathTest, absurd_numbers_end_the_trial) {
  const std::vector<Absurdity> absurdities = {
      {"stiffness", [](Scene& s, double huge) { s.base.stiffness_x = s.base.stiffness_y = huge; }},
      {"damping", [](Scene& s, double huge) { s.base.damping_x = s.base.damping_y = huge; }},
      {"inertia", [](Scene& s, double huge) { s.gripper.phi.inertia = 1.0 / huge; }},
      {"amplitude", [](Scene& s, double huge) { s.excitations[0].amplitude = huge; }},
      {"frequency", [](Scene& s, double huge) { s.excitations[0].frequency = huge; }},
      {"square",
       [](Scene& s, double huge) { s.excitations[0].waveform = Waveform::square, s.excitations[0].frequency = huge; }},
      {"velocity", [](Scene& s, double huge) { s.initial.vx = huge; }},
      {"turn", [](Scene& s, double huge) { s.initial.omega = huge; }},
      {"gripper stiffness", [](Scene& s, double huge) { s.gripper.x.stiffness = huge; }},
      {"gripper damping", [](Scene& s, double huge) { s.gripper.phi.damping = huge; }},
      {"weight", [](Scene& s, double huge) { s.weight = huge; }},
      {"friction", [](Scene& s, double huge) { s.friction->coefficient = huge; }},
      {"regularization", [](Scene& s, double huge) { s.friction->regularization = 1.0 / huge; }},
      {"time limit", [](Scene& s, double huge) { s.trial.time_limit = huge; }},
  };
  for (const double huge : {1e9, 1e20, 1e100, 1e300})
    for (const Absurdity& absurdity : absurdities) {
      Scene scene = scene_of(test::plain);
      absurdity.make(scene, huge);
      EXPECT_EXIT(std::_Exit(in_own_process(scene)), ended, "") << absurdity.name << " " << huge;
      if (HasFailure()) return;  // a hang takes its time
    }
}

TEST(FailuresDeathTest, what_is_not_a_number_fails) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity}) {
    Scene s = scene_of(test::plain);
    s.excitations[0].amplitude = bad;
    EXPECT_EXIT(std::_Exit(in_own_process(s)), failed, "") << "amplitude " << bad;
    s = scene_of(test::plain);
    s.initial.vx = bad;
    EXPECT_EXIT(std::_Exit(in_own_process(s)), failed, "") << "velocity " << bad;
    if (HasFailure()) return;
  }
}

// The tanh law changes at a rate of 1e21 here: powers of it overflow in T, one order before they do in the velocities.
TEST(Failures, a_friction_layer_too_narrow_for_the_numbers_gives_no_wrong_force) {
  const Scene scene = scene_of(R"(
part: {half_width: 1, base_distance: 800, inertia: 1000}
slot: {clearance: 1, depth: 1}
gripper: {anchor: {x: 0, y: 1, phi: 0}}
base: {stiffness: {x: 1.0e+8, y: 1}}
contacts: [walls]
friction: {coefficient: 1, regularization: 1.0e-5}
excitation: {amplitude: 0, frequency: 1}
initial: {x: 0, y: 1, phi: 0.7}
trial: {time_limit: 0.04}
solver: {tolerance: 1.0e-11, step_limit: 4000}
)");
  const TrialResult result = run(scene, [](const Segment& g) {
    for (int i = 0; i < g.loaded_count; ++i) {
      const ContactValues contact = contact_at(g, i, g.duration);
      ASSERT_TRUE(std::isfinite(contact.tangential_force));
      ASSERT_TRUE(std::isfinite(contact.normal_force));
    }
  });
  EXPECT_TRUE(std::isfinite(result.energy->residual));
}

TEST(Failures, unknown_solvers_and_too_many_excitations_are_refused) {
  Scene s = scene_of(test::plain);
  s.solver.name = "crystal_ball";
  EXPECT_THROW(Simulation{s}, std::invalid_argument);
  s = scene_of(test::plain);
  s.excitations.assign(100, s.excitations[0]);
  EXPECT_THROW(Simulation{s}, std::invalid_argument);
}

// Many drives of many waveforms at once are no failure.
TEST(Failures, sixteen_excitations_are_none) {
  Scene s = scene_of(test::plain, {"trial.time_limit=1"});
  s.excitations.assign(16, s.excitations[0]);
  for (std::size_t i = 0; i < 16; ++i) {
    s.excitations[i].amplitude = 0.1;
    s.excitations[i].waveform = i % 3 == 0 ? Waveform::sine : i % 3 == 1 ? Waveform::square : Waveform::triangle;
    s.excitations[i].frequency = 5.0 + static_cast<double>(i);
    s.excitations[i].direction = i % 4 == 0 ? Direction::x : Direction::y;
  }
  EXPECT_EQ(run(s).outcome, Outcome::time_limit) << run(s).failure;
  // all kinks in one instant
  for (Excitation& e : s.excitations) {
    e.waveform = Waveform::square;
    e.frequency = 10.0;
  }
  EXPECT_EQ(run(s).outcome, Outcome::time_limit) << run(s).failure;
}

}  // namespace
}  // namespace vibratory_alignment
