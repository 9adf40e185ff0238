// solver.accuracy: what it chooses, and that the choice depends on the scene as a physical system, not on its units.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "model/scene.h"
#include "model/solver_choice.h"
#include "scene_text.h"

namespace vibratory_alignment {
namespace {

using scene_text::least;
using scene_text::least_si;
using scene_text::load;

TEST(SolverChoice, AccuracyChoosesSolverAndTolerance) {
  for (const char* accuracy : {"0.1", "1e-3", "1e-6", "1e-9"}) {
    const Scene scene = load(least, {std::string("solver={accuracy: ") + accuracy + "}"});
    EXPECT_EQ(scene.solver.accuracy, std::stod(accuracy));
    EXPECT_EQ(scene.solver.tolerance, tolerance_for_accuracy(std::stod(accuracy)));
    EXPECT_LE(scene.solver.tolerance, 0.1 * std::stod(accuracy));
    EXPECT_FALSE(scene.solver.step);
  }
}

TEST(SolverChoice, ANamedSolverIsKept) {
  for (const char* name : {"event", "implicit", "auto"}) {
    const Scene scene = load(least, {std::string("solver={accuracy: 1e-6, name: ") + name + "}"});
    EXPECT_EQ(scene.solver.name, name);
    EXPECT_EQ(scene.solver.tolerance, tolerance_for_accuracy(1e-6));
  }
}

TEST(SolverChoice, WithoutAccuracyNothingIsChosen) {
  const Scene scene = load(least, {"base={stiffness: {y: 1e12}}"});
  EXPECT_EQ(scene.solver.name, "event");
  EXPECT_FALSE(scene.solver.accuracy);
}

TEST(SolverChoice, AStiffBaseCallsForAuto) {
  const auto choice = [](const std::string& base) {
    return load(least, {"base=" + base, "solver={accuracy: 1e-6}"}).solver.name;
  };
  EXPECT_EQ(choice("{stiffness: {y: 1e3}}"), "event");
  EXPECT_EQ(choice("{stiffness: {y: 1e12}}"), "auto");
  EXPECT_EQ(choice("{stiffness: {y: 1e3, x: 1e12}}"), "auto");
  // a strong damper is as stiff
  EXPECT_EQ(choice("{stiffness: {y: 1e3}, damping: {y: 1e6}}"), "auto");
}

// A layer in which V follows within 1/lambda, lambda = f N/(m eps), or a gripper that is damped far beyond what moves.
TEST(SolverChoice, SoDoANarrowLayerAndAFastGripper) {
  const auto choice = [](const std::vector<std::string>& settings) {
    std::vector<std::string> all = {"base={stiffness: {y: 1e3}}", "solver={accuracy: 1e-6}"};
    all.insert(all.end(), settings.begin(), settings.end());
    return std::string(load(least, all).solver.name);
  };
  EXPECT_EQ(choice({"friction={coefficient: 0.2}"}), "event");
  EXPECT_EQ(choice({"friction={coefficient: 0.2, regularization: 1e-2}"}), "event");
  EXPECT_EQ(choice({"friction={coefficient: 0.2, regularization: 1e-8}"}), "auto");
  EXPECT_EQ(choice({"gripper.damping.y=10"}), "event");
  EXPECT_EQ(choice({"gripper.damping.y=1e5"}), "auto");
}

// Without tilt G = 1 and N is what presses and shakes: lambda = f (f0 + A)/eps.
TEST(SolverChoice, RateOfTheLayerIsThatOfItsForces) {
  const Scene scene = load(least, {"friction={coefficient: 0.2, regularization: 1e-3}", "gripper.pressing_force=0.3",
                                   "excitation.amplitude=1.5"});
  EXPECT_NEAR(layer_rate(scene), 0.2 * 1.8 / 1e-3, 1e-9);
}

// sqrt(k/M) over 2 pi f for a part of mass M that does not tilt.
TEST(SolverChoice, RateIsThatOfTheFrequencies) {
  const double k = 4.0e6, mass = 0.25, frequency = 80.0;
  const Scene scene = load(least_si, {"part.mass=0.25", "base={stiffness: {y: 4.0e6}}", "excitation.frequency=80"});
  EXPECT_NEAR(contact_rate(scene) / scene.fastest_excitation() / (std::sqrt(k / mass) / (2.0 * M_PI * frequency)), 1.0,
              1e-12);
}

TEST(SolverChoice, AFixedStepThatIsNotGivenFollowsTheFastestMotion) {
  const auto step = [](const char* solver, const std::vector<std::string>& settings) {
    std::vector<std::string> all = {std::string("solver={name: ") + solver + "}"};
    all.insert(all.end(), settings.begin(), settings.end());
    return load(least, all).solver.step.value();
  };
  // no tilt: G = 1
  for (const char* solver : {"rk4", "semi_implicit", "ode"}) {
    EXPECT_DOUBLE_EQ(step(solver, {"excitation.frequency=40", "base={stiffness: {y: 100}}"}), 0.02 / 40.0);
    EXPECT_DOUBLE_EQ(step(solver, {"base={stiffness: {y: 1e6}}"}), 0.02 / 1e3);
    EXPECT_DOUBLE_EQ(step(solver, {"base={stiffness: {y: 100}, damping: {y: 1e5}}"}), 0.02 / 1e5);
    EXPECT_DOUBLE_EQ(step(solver, {"base={stiffness: {y: 100}}", "gripper.damping.y=250"}), 0.02 / 250.0);
    EXPECT_DOUBLE_EQ(step(solver, {"solver.step=0.25"}), 0.25);
  }
  EXPECT_FALSE(load(least, {}).solver.step);
}

// An edge that lies far up a side face has its height as lever: G = 1 + (a^2 + y^2)/mu.
TEST(SolverChoice, AFixedStepThatIsNotGivenHoldsForAStartDeepInTheSlot) {
  const auto step = [](const char* y) {
    return load(least, {"solver={name: rk4}", "part.inertia=0.25", "gripper.stiffness.phi=1",
                        "base={stiffness: {y: 1e6}}", std::string("initial={x: 0, y: ") + y + "}"})
        .solver.step.value();
  };
  const Scene scene = load(least);
  const double a = scene.part.half_width, b = scene.part.base_distance;
  const auto expected = [a](double lever) { return 0.02 / std::sqrt(1e6 * (1.0 + (a * a + lever * lever) / 0.25)); };
  EXPECT_NEAR(step("-20") / expected(20.0), 1.0, 1e-12);
  EXPECT_NEAR(step("1.5") / expected(b), 1.0, 1e-12);
}

// In seconds it is the same share of the period.
TEST(SolverChoice, AFixedStepThatIsNotGivenHasTheUnitOfTheScene) {
  const Scene scene = load(least_si, {"solver={name: rk4}", "base={stiffness: {y: 1.0}}", "gripper.stiffness.y=1.0",
                                      "excitation.frequency=80"});
  EXPECT_NEAR(scene.solver.step.value() * scene.fastest_excitation(), 0.02, 1e-15);
}

}  // namespace
}  // namespace vibratory_alignment
