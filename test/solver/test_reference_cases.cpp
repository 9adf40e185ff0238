// The solver against end states that other methods agree on to 1e-16 (test/reference), and against the reference
// integrator itself on cases that nobody has looked at before.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "../support/reference_scene.h"
#include "trial/simulation.h"

namespace vibratory_alignment {
namespace {

using reference::Real;
using reference::ReferenceCase;
using test::distance;
using test::scene_of_reference;

TrialResult run(Scene scene, double tolerance) {
  scene.solver.tolerance = tolerance;
  SimulationOptions options;
  options.until = scene.trial.time_limit;
  Simulation simulation(scene, options);
  while (simulation.advance()) {
  }
  return simulation.result();
}

class ReferenceCases : public testing::TestWithParam<ReferenceCase> {};
INSTANTIATE_TEST_SUITE_P(known, ReferenceCases, testing::ValuesIn(reference::referenceCases()),
                         [](const auto& info) { return info.param.name; });

TEST_P(ReferenceCases, end_state_at_the_usual_tolerance) {
  const ReferenceCase& c = GetParam();
  EXPECT_LT(distance(run(scene_of_reference(c), 1e-8).final_state, c.end), 1e-9);
}

// What remains is that the scene's numbers are rounded: 1e-16 in each of some twenty, times the amplification.
TEST_P(ReferenceCases, end_state_to_roundoff) {
  const ReferenceCase& c = GetParam();
  const double roundoff =
      20.0 * 2.2e-16 * std::max(1.0, static_cast<double>(c.amplification)) + static_cast<double>(c.agreement);
  EXPECT_LT(distance(run(scene_of_reference(c), 1e-13).final_state, c.end), 4.0 * roundoff);
}

TEST_P(ReferenceCases, touches_and_peak_forces) {
  const ReferenceCase& c = GetParam();
  const TrialResult result = run(scene_of_reference(c), 1e-8);
  for (std::size_t i = 0; i < kSpotCount; ++i) {
    EXPECT_EQ(result.impacts[i], c.touches[i]) << "spot " << i;
    EXPECT_NEAR(result.peak_force[i], static_cast<double>(c.peak_force[i]), 1e-7) << "spot " << i;
  }
}

// Error control: six decades and more between the loosest and the tightest setting, never far off the tolerance.
TEST_P(ReferenceCases, error_follows_the_tolerance) {
  const ReferenceCase& c = GetParam();
  const Scene scene = scene_of_reference(c);
  const double growth = std::max(1.0, static_cast<double>(c.amplification));
  double loosest = 0.0, tightest = 0.0;
  for (const double tolerance : {1e-1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    tightest = distance(run(scene, tolerance).final_state, c.end);
    loosest = std::max(loosest, tightest);
    EXPECT_LT(tightest, tolerance * growth + 1e-12) << "tolerance " << tolerance;
  }
  EXPECT_GT(loosest / tightest, 1e6);
}

/// A random case in the reach of the reference integrator: sines, edges and corners, dry friction.
ReferenceCase random_case(unsigned seed) {
  std::mt19937 random(seed);
  const auto u = [&](double low, double high) {
    return static_cast<Real>(std::uniform_real_distribution<double>(low, high)(random));
  };
  ReferenceCase c;
  reference::ReferenceParameters& p = c.parameters;
  p.corners = seed % 2 == 0;
  p.a = u(0.5, 0.8);
  p.l = p.a + u(0.03, 0.12);
  p.b = u(0.7, 1.0);
  p.mu = u(0.1, 0.4);
  p.k_x = u(0.02, 0.5);
  p.k_phi = u(3.0, 40.0);
  p.h_x = u(0.01, 0.1);
  p.h_y = u(0.01, 0.1);
  p.h_phi = u(0.01, 0.5);
  p.c1 = u(1500.0, 6000.0);
  p.c2 = p.c1 * u(0.4, 1.2);
  p.h1 = u(10.0, 30.0);
  p.h2 = p.h1 * (p.c2 / p.c1);
  p.f = u(0.1, 0.5);
  p.excitation_y = {1.0L, u(8.0, 25.0), u(0.0, 6.0)};
  if (seed % 3 == 0) p.excitation_x = {u(0.1, 0.5), u(5.0, 12.0), u(0.0, 6.0)};
  if (seed % 3 == 1) p.excitation_phi = {u(0.1, 0.3), u(5.0, 12.0), u(0.0, 6.0)};
  p.weight = u(0.0, 0.2);
  c.start.x = u(0.1, 0.3);
  c.start.phi = u(-0.08, 0.12);
  c.start.y = p.b * std::cos(c.start.phi) + u(0.02, 0.08);
  c.start.vx = u(-0.2, 0.2);
  c.start.omega = u(-0.3, 0.3);
  p.x_a = u(-0.1, 0.3);
  p.y_a = p.b - u(0.2, 0.5);
  p.phi_a = u(-0.03, 0.03);
  c.end_time = 1.5L;
  return c;
}

class FreshCases : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(seed, FreshCases, testing::Range(101u, 113u));

// Errors of the start (the scene's rounded numbers) grow by the impacts; 1e4 is more than any known case has.
TEST_P(FreshCases, agree_with_the_reference_integrator) {
  ReferenceCase c = random_case(GetParam());
  const auto expected = reference::integrate(c.parameters, c.start, c.end_time, 4e-3L);
  const TrialResult result = run(scene_of_reference(c), 1e-13);
  EXPECT_LT(distance(result.final_state, expected.state), 1e4 * 2.2e-16);
  for (std::size_t i = 0; i < kSpotCount; ++i) EXPECT_EQ(result.impacts[i], expected.touches[i]) << "spot " << i;
}

}  // namespace
}  // namespace vibratory_alignment
