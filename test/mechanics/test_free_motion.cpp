// The closed forms of flight against the matrix exponential. Position, velocity, a constant, the time and the sine and
// cosine of every drive make one linear system z' = A z, whatever the damping; exp(A t) in 113 bits is its solution.
#include "mechanics/free_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "../support/drive_forms.h"
#include "../support/lone_motion.h"
#include "../support/quad.h"

namespace vibratory_alignment {
namespace {

using test::Float128;
using test::Float128Matrix;
using test::ramp;
using test::sine;

struct Motion {
  double q, v, a;
};

/// m v' = constant + slope t + sum of sines - h v - k (q - anchor), solved as z' = A z.
Motion exponential_solution(const Axis& axis, double q, double v, double force, const std::vector<DriveForm>& forms,
                            double t) {
  // z = (q, v, 1, t, s_1, c_1, s_2, c_2, ...), s = A sin(nu t + phase), c = A cos(nu t + phase)
  const std::size_t n = 4 + 2 * forms.size();
  Float128Matrix a(n, std::vector<Float128>(n, 0));
  std::vector<Float128> z(n, 0);
  const Float128 m = axis.inertia;
  a[0][1] = 1;
  a[1][0] = -Float128(axis.stiffness) / m;
  a[1][1] = -Float128(axis.damping) / m;
  a[1][2] = (Float128(axis.stiffness) * Float128(axis.anchor) + Float128(force)) / m;
  a[3][2] = 1;
  z[0] = q;
  z[1] = v;
  z[2] = 1;
  for (std::size_t i = 0; i < forms.size(); ++i) {
    const DriveForm& form = forms[i];
    const std::size_t s = 4 + 2 * i, c = s + 1;
    a[1][2] += Float128(form.constant) / m;
    a[1][3] += Float128(form.slope) / m;
    a[1][s] = 1 / m;
    a[s][c] = form.frequency;
    a[c][s] = -Float128(form.frequency);
    z[s] = Float128(form.amplitude) * Float128(form.sin_phase);
    z[c] = Float128(form.amplitude) * Float128(form.cos_phase);
  }
  Float128Matrix scaled = a;
  for (auto& row : scaled)
    for (Float128& entry : row) entry *= t;
  const Float128Matrix e = test::exponential(scaled);
  std::vector<Float128> end(n, 0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) end[i] += e[i][j] * z[j];
  Float128 acceleration = 0;
  for (std::size_t j = 0; j < n; ++j) acceleration += a[1][j] * end[j];
  return {static_cast<double>(end[0]), static_cast<double>(end[1]), static_cast<double>(acceleration)};
}

struct Load {
  std::string name;
  std::vector<DriveForm> forms;
  double force;
};

const std::vector<Load>& loads() {
  static const std::vector<Load> all = {
      {"free", {}, 0.0},
      {"constant force", {ramp(0.7)}, -0.3},
      {"growing force", {ramp(-0.4, 1.3)}, 0.0},
      {"one sine", {sine(1.0, 20.0, 0.4)}, 0.0},
      {"sines, slope and weight",
       {sine(1.0, 20.0, 0.4), sine(-0.3, 7.7, 2.0), sine(0.2, 0.31, -1.0), ramp(0.2, -0.6)},
       -0.5},
  };
  return all;
}

/// Compares at time t. The digits that may be lost: `gain` of them to cancelling terms, and those of the phase w t,
/// since the axis' own frequency w is a rounded number.
void expect_motion(const test::LoneMotion& motion, const Motion& expected, const Axis& axis, double t, double gain) {
  double q = 0.0, v = 0.0;
  motion.at(t, q, v);
  const double w = std::sqrt(axis.stiffness / axis.inertia);
  const double size = 1.0 + std::abs(expected.q) + std::abs(expected.v);
  const double error = 2.2e-16 * (gain + 2.0 * w * t) * size;
  EXPECT_NEAR(q, expected.q, error) << "t = " << t;
  EXPECT_NEAR(v, expected.v, error * (1.0 + w)) << "t = " << t;
  // the equation of motion passes on the errors of q and v
  const double stiffness = axis.stiffness / axis.inertia, damping = axis.damping / axis.inertia;
  const double forces = 2.2e-16 * (1.0 + std::abs(expected.a));
  EXPECT_NEAR(motion.outlook(t, t).acceleration, expected.a, error * (stiffness + damping * (1.0 + w)) + gain * forces)
      << "t = " << t;
}

enum class Slopes { with, without };

/// A fast start, long ago: what is left of it keeps its own digits, but for those of the phase and the exponent.
void expect_digits_of_what_is_left(const Axis& axis) {
  test::LoneMotion motion(axis, 0);
  motion.begin(0.0, 3e3, 0.0);
  motion.settle();
  ASSERT_TRUE(motion.exact());
  for (const double t : {5.0, 10.0, 20.0}) {
    double q = 0.0, v = 0.0;
    motion.at(t, q, v);
    const Motion expected = exponential_solution(axis, 0.0, 3e3, 0.0, {}, t);
    EXPECT_NEAR(q, expected.q, 1e-13 * std::abs(expected.q)) << "t = " << t;
    EXPECT_NEAR(motion.outlook(t, t).acceleration, expected.a, 1e-13 * std::abs(expected.a)) << "t = " << t;
  }
}

/// All loads and many times on one axis.
void expect_solution(const Axis& axis, double longest, Slopes slopes = Slopes::with) {
  const double q0 = 0.83, v0 = -0.37;
  for (const Load& load : loads()) {
    SCOPED_TRACE(load.name);
    if (slopes == Slopes::without && !load.forms.empty() && load.forms.back().slope != 0.0) continue;
    test::LoneMotion motion(axis, load.forms.size());
    motion.begin(q0, v0, load.force);
    for (const DriveForm& form : load.forms) motion.add(form);
    motion.settle();
    ASSERT_TRUE(motion.exact());
    for (const double share : {0.0, 1e-9, 1e-4, 0.013, 0.21, 0.5, 1.0}) {
      const double t = share * longest;
      const Motion expected = exponential_solution(axis, q0, v0, load.force, load.forms, t);
      expect_motion(motion, expected, axis, t, 1e2);
    }
  }
}

TEST(FreeMotion, underdamped) { expect_solution(test::axis_of(1.0, 0.05, 1.0, 0.6), 30.0); }
TEST(FreeMotion, undamped) { expect_solution(test::axis_of(0.3, 0.0, 60.0, -0.1), 30.0); }
TEST(FreeMotion, overdamped) { expect_solution(test::axis_of(0.149, 9.0, 7.3, 0.02), 30.0); }
TEST(FreeMotion, critically_damped) { expect_solution(test::axis_of(1.0, 4.0, 4.0, 0.6), 20.0); }
TEST(FreeMotion, without_stiffness) { expect_solution(test::axis_of(1.0, 0.8, 0.0, 0.0), 20.0); }
TEST(FreeMotion, without_damping_and_stiffness) { expect_solution(test::axis_of(0.7, 0.0, 0.0, 0.0), 20.0); }
TEST(FreeMotion, light_inertia) { expect_solution(test::axis_of(1e-6, 0.05, 60.0, 0.1), 1.0); }
TEST(FreeMotion, heavy_inertia) { expect_solution(test::axis_of(1e3, 0.05, 60.0, 0.1), 30.0); }

TEST(FreeMotion, keeps_the_digits_of_what_is_left) {
  expect_digits_of_what_is_left(test::axis_of(1.0, 2.0, 1.0, 0.0));
  expect_digits_of_what_is_left(test::axis_of(1.0, 1.9, 1.0, 0.0));
  expect_digits_of_what_is_left(test::axis_of(1.0, 2.2, 1.0, 0.0));
}

TEST(FreeMotion, near_critical_damping_from_both_sides) {
  for (const double off : {1e-3, 1e-6, 1e-9, 1e-12, 3e-16})
    for (const double sign : {1.0, -1.0}) {
      SCOPED_TRACE(sign * off);
      expect_solution(test::axis_of(1.0, 4.0 * (1.0 + sign * off), 4.0, 0.6), 20.0);
    }
}

// The fast rate is h/m, the slow one k/h: twelve decades apart. (A growing force is followed h/k behind: too far.)
TEST(FreeMotion, hugely_overdamped) { expect_solution(test::axis_of(1.0, 1e6, 1.0, 0.6), 30.0, Slopes::without); }

// A soft spring is no case of its own as long as its equilibrium is not far away.
TEST(FreeMotion, nearly_vanishing_stiffness) {
  for (const double k : {1e-3, 1e-8, 1e-14, 1e-30}) {
    const Axis axis = test::axis_of(1.0, 0.05, k, 0.2);
    test::LoneMotion motion(axis, 1);
    motion.begin(0.83, -0.37, 0.0);
    motion.add(sine(1.0, 20.0, 0.4));
    motion.settle();
    ASSERT_TRUE(motion.exact());
    for (const double t : {1e-6, 0.3, 5.0, 30.0}) {
      const Motion expected = exponential_solution(axis, 0.83, -0.37, 0.0, {sine(1.0, 20.0, 0.4)}, t);
      expect_motion(motion, expected, axis, t, 1e2);
    }
  }
}

/// exact() of an axis under one drive; when it is claimed, the claim is checked.
bool claims_exact(const Axis& axis, const DriveForm& form, double force = 0.0) {
  test::LoneMotion motion(axis, 1);
  motion.begin(0.2, 0.1, force);
  motion.add(form);
  motion.settle();
  if (!motion.exact()) return false;
  for (const double t : {0.01, 1.0, 10.0}) {
    const Motion expected = exponential_solution(axis, 0.2, 0.1, force, {form}, t);
    expect_motion(motion, expected, axis, t, 1e4);
  }
  return true;
}

// At resonance without damping there is no steady response: the closed form must step back, at it and close to it.
TEST(FreeMotion, steps_back_at_undamped_resonance) {
  EXPECT_FALSE(claims_exact(test::axis_of(1.0, 0.0, 4.0, 0.0), sine(1.0, 2.0, 0.3)));
  for (const double off : {1e-15, 1e-12, 1e-9, 1e-6, 1e-4})
    for (const double sign : {1.0, -1.0}) {
      EXPECT_FALSE(claims_exact(test::axis_of(1.0, 0.0, 4.0, 0.0), sine(1.0, 2.0 * (1.0 + sign * off), 0.3)))
          << sign * off;
    }
}

TEST(FreeMotion, stays_exact_where_no_digits_are_lost) {
  // damped resonance, and beside an undamped one
  EXPECT_TRUE(claims_exact(test::axis_of(1.0, 0.05, 4.0, 0.0), sine(1.0, 2.0, 0.3)));
  EXPECT_TRUE(claims_exact(test::axis_of(1.0, 0.0, 4.0, 0.0), sine(1.0, 2.02, 0.3)));
  EXPECT_TRUE(claims_exact(test::axis_of(0.149, 1.33, 7.3, 0.0), sine(1.0, 20.0, 0.0)));
  EXPECT_TRUE(claims_exact(test::axis_of(1.0, 0.05, 0.05, 0.2), ramp(1.0)));
}

TEST(FreeMotion, steps_back_where_the_equilibrium_is_far_away) {
  EXPECT_FALSE(claims_exact(test::axis_of(1.0, 0.0, 1e-9, 0.0), ramp(1.0)));
  EXPECT_FALSE(claims_exact(test::axis_of(1.0, 1e-9, 0.0, 0.0), ramp(1.0)));
  EXPECT_FALSE(claims_exact(test::axis_of(1.0, 0.0, 1e-9, 0.0), ramp(0.0), -0.3));
}

TEST(FreeMotion, steps_back_during_a_chirp) {
  DriveForm chirp = sine(1.0, 20.0, 0.3);
  chirp.rate = 0.5;
  EXPECT_FALSE(claims_exact(test::axis_of(1.0, 0.05, 1.0, 0.0), chirp));
}

TEST(FreeMotion, is_claimed_only_where_it_holds_on_random_axes) {
  std::mt19937 random(20240501);
  std::uniform_real_distribution<double> decade(-4.0, 4.0), phase(0.0, 6.28);
  int claimed = 0;
  for (int i = 0; i < 150; ++i) {
    const double m = std::pow(10.0, 0.25 * decade(random)), h = std::pow(10.0, decade(random)) * (i % 5 != 0);
    const double k = std::pow(10.0, decade(random)) * (i % 7 != 0);
    const double nu = std::pow(10.0, 0.5 * decade(random));
    claimed += claims_exact(test::axis_of(m, h, k, 0.4), sine(1.0, nu, phase(random)), 0.2);
  }
  EXPECT_GT(claimed, 75);  // stepping back always would be right, and useless
}

TEST(FreeMotion, a_locked_axis_stands_still) {
  Axis axis = test::axis_of(1.0, 0.1, 1.0, 0.6);
  axis.moves = false;
  axis.inverse_inertia = 0.0;
  test::LoneMotion motion(axis, 1);
  motion.begin(0.3, 0.0, -1.0);
  motion.add(sine(1.0, 20.0, 0.4));
  motion.settle();
  double q = 1.0, v = 1.0;
  motion.at(3.0, q, v);
  EXPECT_EQ(q, 0.3);
  EXPECT_EQ(v, 0.0);
}

// At t = 0 the motion is its start, bit for bit, however large the response is that cancels against it: no face that a
// flight starts on may be left or entered by rounding.
TEST(FreeMotion, starts_where_it_starts) {
  std::mt19937 random(20240502);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  int exact = 0;
  for (const Axis& axis :
       {test::axis_of(1.0, 0.05, 4.0, 0.6), test::axis_of(0.3, 0.0, 60.0, -0.1), test::axis_of(0.149, 9.0, 7.3, 0.02),
        test::axis_of(1.0, 4.0, 4.0, 0.6), test::axis_of(1.0, 0.8, 0.0, 0.0), test::axis_of(0.7, 0.0, 0.0, 0.0)})
    for (const double off : {0.3, 0.03, 0.003, 0.0})
      for (int i = 0; i < 20; ++i) {
        const double q0 = u(random), v0 = u(random),
                     nu = (1.0 + off) * std::sqrt(axis.stiffness / axis.inertia) + (axis.stiffness == 0.0);
        test::LoneMotion motion(axis, 2);
        motion.begin(q0, v0, u(random));
        motion.add(sine(10.0 * u(random), nu, 3.0 * u(random)));
        motion.add(ramp(u(random), u(random)));
        motion.settle();
        if (!motion.exact()) continue;
        ++exact;
        double q = 0.0, v = 0.0;
        motion.at(0.0, q, v);
        EXPECT_EQ(q, q0) << axis.damping << " " << axis.stiffness << " " << off;
        EXPECT_EQ(v, v0) << axis.damping << " " << axis.stiffness << " " << off;
      }
  EXPECT_GT(exact, 240);
}

// A new flight knows nothing of the one before it.
TEST(FreeMotion, begins_anew) {
  const Axis axis = test::axis_of(1.0, 0.05, 1.0, 0.6);
  test::LoneMotion used(axis, 3), fresh(axis, 1);
  used.begin(5.0, 1.0, 2.0);
  used.add(sine(1.0, 3.0, 1.0));
  used.add(sine(0.4, 9.0, 0.0));
  used.add(ramp(0.3, 0.4));
  used.settle();
  for (test::LoneMotion* motion : {&used, &fresh}) {
    motion->begin(0.83, -0.37, -0.2);
    motion->add(sine(1.0, 20.0, 0.4));
    motion->settle();
  }
  double q1 = 0.0, v1 = 0.0, q2 = 0.0, v2 = 0.0;
  used.at(1.7, q1, v1);
  fresh.at(1.7, q2, v2);
  EXPECT_EQ(q1, q2);
  EXPECT_EQ(v1, v2);
}

/// An axis of any damping with its drives, from anywhere.
struct AxisAlone {
  Axis axis;
  std::vector<DriveForm> forms;
  double q, v;
};

AxisAlone random_axis(std::mt19937& random) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const double m = std::pow(10.0, u(random)), k = u(random) > 0.8 ? 0.0 : std::pow(10.0, 1.5 * u(random));
  const double critical = 2.0 * std::sqrt(k * m), ratio = u(random);
  const double h = ratio > 0.6 ? critical : critical * std::pow(10.0, 2.0 * u(random));
  AxisAlone alone{test::axis_of(m, h, k, 0.4 * u(random)), {}, u(random), u(random)};
  for (int n = 0; n < 2; ++n)
    if (u(random) > 0.0) alone.forms.push_back(sine(u(random), std::pow(10.0, u(random)), 3.0 * u(random)));
  if (u(random) > 0.5) alone.forms.push_back(ramp(u(random), u(random)));
  return alone;
}

// Three axes at once move as each of them does alone, to the last digit: their lanes know nothing of each other.
TEST(FreeMotion, axes_do_not_know_each_other) {
  constexpr double kUntouched = -77.0;
  std::mt19937 random(20240503);
  int exact = 0;
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE(i);
    const AxisAlone alone[] = {random_axis(random), random_axis(random), random_axis(random)};
    System system;
    system.x = alone[0].axis;
    system.y = alone[1].axis;
    system.phi = alone[2].axis;
    FreeMotion together(system, 9);
    together.begin({alone[0].q, alone[1].q, alone[2].q, alone[0].v, alone[1].v, alone[2].v});
    for (int j = 0; j < 3; ++j)
      for (const DriveForm& form : alone[j].forms) together.add(static_cast<Direction>(j), form);
    together.settle();
    exact += together.exact();
    const double t = 0.01 * i;
    State state{kUntouched, kUntouched, kUntouched, kUntouched, kUntouched, kUntouched};
    together.at(t, state);
    State ahead;
    FreeMotion::Outlook outlook;
    if (together.exact()) together.at(t, t + 1.0, ahead, outlook);
    const double q[] = {state.x, state.y, state.phi}, v[] = {state.vx, state.vy, state.omega};
    double rate = 0.0;
    bool all_exact = true;
    for (int j = 0; j < 3; ++j) {
      test::LoneMotion motion(alone[j].axis, 3);
      motion.begin(alone[j].q, alone[j].v, 0.0);
      for (const DriveForm& form : alone[j].forms) motion.add(form);
      motion.settle();
      rate = std::max(rate, motion.rate(t));
      all_exact = all_exact && motion.exact();
      double expected_q = kUntouched, expected_v = kUntouched;
      motion.at(t, expected_q, expected_v);
      EXPECT_EQ(q[j], expected_q) << j;
      EXPECT_EQ(v[j], expected_v) << j;
      EXPECT_EQ(q[j] == kUntouched, !motion.exact()) << j;
      if (!together.exact()) continue;
      const test::LoneMotion::Outlook expected = motion.outlook(t, t + 1.0);
      EXPECT_EQ(outlook.acceleration[j], expected.acceleration) << j;
      EXPECT_EQ(outlook.rate[j], expected.rate) << j;
      EXPECT_EQ(outlook.second[j], expected.second) << j;
      EXPECT_EQ(outlook.third[j], expected.third) << j;
    }
    EXPECT_EQ(together.exact(), all_exact);
    EXPECT_EQ(together.rate(t), rate);
    if (together.exact()) {
      EXPECT_EQ(ahead.x, state.x);
      EXPECT_EQ(ahead.vy, state.vy);
      EXPECT_EQ(ahead.omega, state.omega);
    }
  }
  EXPECT_GT(exact, 500);
}

}  // namespace
}  // namespace vibratory_alignment
