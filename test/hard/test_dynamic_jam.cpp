// Dynamic jam (hard/dynamic_jam): friction drives the contact point into the base. The growth is followed, it ends, and
// the reference integrator, which shares nothing with the solvers, says the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "../reference/reference_integrator.h"
#include "../support/hard_scene.h"
#include "../support/known_answers.h"
#include "../support/reference_scene.h"
#include "../support/runs.h"

namespace vibratory_alignment {
namespace {

using reference::Real;

constexpr Real kEnd = 0.5L;

/// The numbers of the scene once more, for the reference integrator.
reference::ReferenceParameters parameters(Real friction) {
  reference::ReferenceParameters p;
  p.a = 0.3L;
  p.b = 1.5L;
  p.l = 0.4L;
  p.mu = 0.05L;
  p.k_x = 0.5L;
  p.k_phi = 3.0L;
  p.h_x = p.h_y = p.h_phi = 0.02L;
  p.c1 = p.c2 = 3000.0L;
  p.h1 = p.h2 = 20.0L;
  p.excitation_y = {1.0L, 15.0L, 0.0L};
  p.x_a = 0.2L;
  p.y_a = 1.2L;
  p.f = friction;
  return p;
}

State in_double(const reference::ReferenceState& s) {
  const auto d = [](Real value) { return static_cast<double>(value); };
  return {d(s.x), d(s.y), d(s.phi), d(s.vx), d(s.vy), d(s.omega)};
}

class DynamicJam : public testing::TestWithParam<int> {
 protected:
  int friction() const { return GetParam(); }
  Scene scene() const {
    return test::hard_scene("dynamic_jam", {"friction.coefficient=" + std::to_string(friction())});
  }
  reference::ReferenceResult expected() const {
    const reference::ReferenceState start = {0.13L, 1.5005L, 0.0L, 1.0L, -0.02L, 0.0L};
    return reference::integrate(parameters(friction()), start, kEnd, 2e-3L);
  }
};
INSTANTIATE_TEST_SUITE_P(f, DynamicJam, testing::Values(1, 2, 4));

TEST_P(DynamicJam, ends_where_the_reference_integrator_ends) {
  const auto reference = expected();
  const TrialResult result = test::run(scene());
  EXPECT_NE(result.outcome, Outcome::failed) << result.failure;
  EXPECT_LT(test::distance(result.final_state, reference.state), 1e-10);
  EXPECT_EQ(result.impacts[0], reference.touches[0]);
  EXPECT_NEAR(result.peak_force[0], static_cast<double>(reference.peak_force[0]), 1e-8);
}

TEST_P(DynamicJam, closes_the_ledger) {
  const TrialResult result = test::run(scene());
  EXPECT_LT(result.energy->residual, 1e-11);
  EXPECT_GT(result.energy->friction_loss, 0.0);
}

// Upright, with the edge at r = l - x to the right of C and b below it: N moves the point out by N (1 + r^2/mu), f N
// moves it in by f N b r/mu while it slides to the right.
TEST_P(DynamicJam, friction_drives_the_edge_into_the_base) {
  const Scene s = scene();
  const TrialResult result = test::run(s);
  ASSERT_TRUE(result.first_contact);
  EXPECT_GT(result.first_contact->slip_velocity, 0.9);
  const double r = s.slot_half_width() - result.first_contact->state.x, mu = s.gripper.phi.inertia;
  const double out = 1.0 + r * r / mu;
  EXPECT_GT(friction() * s.part.base_distance * r / mu, 2.0 * out);
  // an impact without friction: v sqrt(k m) with m = 1/out, and damping takes from that
  const double smooth = result.first_contact->approach_speed * std::sqrt(s.base.stiffness_y / out);
  EXPECT_GT(result.peak_force[0], 5.0 * smooth);
}

TEST_P(DynamicJam, known_answer_is_that_of_the_reference_integrator) {
  const YAML::Node known = test::known_answers("dynamic_jam")[std::to_string(friction())];
  const State k = {known[0].as<double>(), known[1].as<double>(), known[2].as<double>(),
                   known[3].as<double>(), known[4].as<double>(), known[5].as<double>()};
  EXPECT_LT(test::distance(in_double(expected().state), k), 1e-13);
}

}  // namespace
}  // namespace vibratory_alignment
