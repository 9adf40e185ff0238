// How a base recovers under a normal that turns evenly: u = u(0) exp(-integral of k/h), which has a closed form there.
#include "solver/base_recovery.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

constexpr double kPhi = 0.2, kOmega = 1.3, kLeft = 1e-3;

/// C1 = 400, C2 = 1200, H1 = 80, H2 = 100.
System turning_system(const char* setting = "name=none") {
  return make_system(
      test::scene_of(test::plain, {"base={stiffness: {x: 1200, y: 400}, damping: {x: 100, y: 80}, recovery: true}",
                                   "gripper.stiffness.phi=0", setting}));
}

/// The integral of k/h = (400 c^2 + 1200 s^2)/(80 c^2 + 100 s^2) under the bottom, with c and s of kPhi + kOmega t, by
/// partial fractions in tan phi.
double relaxed(double t) {
  const auto primitive = [](double phi) {
    const double root = std::sqrt(1.25);
    return 12.0 * phi - 28.0 * (root * std::atan(root * std::tan(phi)) - phi);
  };
  return (primitive(kPhi + kOmega * t) - primitive(kPhi)) / kOmega;
}

PlacedState placed(double t) { return PlacedState({0.2, 0.9, kPhi + kOmega * t, 0.0, 0.0, kOmega}); }

double after_steps(const System& system, double end, int count) {
  Recovery left{kLeft, Face::bottom};
  for (int i = 0; i < count; ++i)
    left.deformation =
        deformation_between(system, left, placed(end * i / count), placed(end * (i + 1) / count), end / count);
  return left.deformation;
}

TEST(BaseRecovery, between_states_is_of_order_four) {
  const System system = turning_system();
  const double exact = kLeft * std::exp(-relaxed(0.5));
  double before = std::abs(after_steps(system, 0.5, 16) - exact);
  for (const int count : {32, 64, 128}) {
    const double error = std::abs(after_steps(system, 0.5, count) - exact);
    EXPECT_GT(before / error, 14.0) << count;
    before = error;
  }
  EXPECT_LT(before, 1e-9 * kLeft);
}

/// A segment in which the part turns evenly, with its cos and sin of phi as series.
Segment turning_segment(int order) {
  Segment segment;
  segment.order = order;
  segment.begin = placed(0.0).state;
  double power = 1.0;
  for (int k = 0; k <= order; ++k, power *= kOmega / k) {
    segment.cos_phi[k] = power * std::cos(kPhi + 0.5 * M_PI * k);
    segment.sin_phi[k] = power * std::sin(kPhi + 0.5 * M_PI * k);
  }
  return segment;
}

TEST(BaseRecovery, of_a_segment_is_that_of_the_closed_form) {
  const System system = turning_system();
  const Segment segment = turning_segment(20);
  const Recovery left{kLeft, Face::bottom};
  const double step = recovery_step(system, segment, left, 1e-15);
  EXPECT_GT(step, 0.01);
  EXPECT_LE(step, 1.0 / 5.0);
  const Series u = deformation_series(system, segment, left);
  const Relaxation relaxation(system, segment, left);
  for (const double share : {0.0, 0.3, 0.7, 1.0}) {
    const double t = share * step, exact = kLeft * std::exp(-relaxed(t));
    EXPECT_NEAR(relaxation.deformation_at(t), exact, 1e-14 * kLeft) << share;
    EXPECT_NEAR(value_at(u, segment.order, t), exact, 1e-13 * kLeft) << share;
  }
}

// A damper of h gives way at k/h: at once where there is none, or where that is beyond anything to be seen.
TEST(BaseRecovery, leaves_nothing_where_it_is_at_once) {
  const auto left = [](const char* damping, double deformation = kLeft) {
    const System system = make_system(test::scene_of(test::plain, {"base.stiffness.y=4e3", damping}));
    return left_behind(system, deformation, Face::bottom, 1.0, 0.0).deformation;
  };
  EXPECT_EQ(left("base.damping.y=0"), 0.0);
  EXPECT_EQ(left("base.damping.y=3e-9"), 0.0);
  EXPECT_EQ(left("base.damping.y=5e-9"), kLeft);
  EXPECT_EQ(left("base.damping.y=20"), kLeft);
  EXPECT_EQ(left("base.damping.y=20", 1e-19), 0.0) << "less than the last digit of any place";
}

TEST(BaseRecovery, is_even_where_nothing_turns_or_all_directions_are_alike) {
  const System system = turning_system();
  EXPECT_FALSE(recovers_evenly(system, Face::bottom));
  EXPECT_FALSE(recovers_evenly(system, Face::left_side));
  EXPECT_TRUE(recovers_evenly(system, Face::top));
  EXPECT_TRUE(recovers_evenly(turning_system("part.inertia=null"), Face::bottom));
  // k/h = 5 in all directions
  const System even = turning_system("base.stiffness.x=500");
  EXPECT_TRUE(recovers_evenly(even, Face::bottom));
  const Recovery left{kLeft, Face::bottom};
  EXPECT_NEAR(Relaxation(even, turning_segment(20), left).deformation_at(0.1), kLeft * std::exp(-0.5), 1e-17);
  EXPECT_NEAR(deformation_between(even, left, placed(0.0), placed(0.1), 0.1), kLeft * std::exp(-0.5), 1e-17);
}

}  // namespace
}  // namespace vibratory_alignment
