// The fastest motion in a power series and the change of a normal force, from series that are known
// (docs/implicit_steps.md "Rings").
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "../support/scenes.h"
#include "solver/fast_motion.h"

namespace vibratory_alignment {
namespace {

using Complex = std::complex<double>;

/// Adds Re(c exp(lambda t)) to the series of a velocity.
void add_exponential(Complex c, Complex lambda, int order, Series& v) {
  for (int k = 0; k <= order; ++k) {
    v[static_cast<std::size_t>(k)] += c.real();
    c *= lambda / (k + 1.0);
  }
}

/// Of this order, with a slow swing in every velocity.
Segment slow_segment(int order) {
  Segment segment;
  segment.order = order;
  for (Series* v : {&segment.vx, &segment.vy, &segment.omega}) {
    v->fill(0.0);
    add_exponential({1.0, 0.5}, {0.0, 1.3}, order, *v);
  }
  return segment;
}

System plain_system() { return make_system(test::scene_of(test::plain)); }

// The larger one of two terms with the angle arg(lambda) between them, a right one or more, is at least |c| cos of half
// of it.
TEST(FastMotion, shows_in_the_last_terms_alone) {
  const System system = plain_system();
  for (const int order : {9, 14, 24})
    for (const Complex lambda : {Complex(0.0, 300.0), Complex(-3.0, 300.0), Complex(-150.0, 260.0), Complex(0.0, 1e9)})
      for (double phase = 0.1; phase < 3.1; phase += 0.2) {
        Segment segment = slow_segment(order);
        add_exponential(std::polar(1e-3, phase), lambda, order, segment.vy);
        const FastMotion motion = fast_motion(system, segment);
        EXPECT_NEAR(motion.rate, std::abs(lambda), 1e-2 * std::abs(lambda)) << order << lambda << phase;
        EXPECT_LT(motion.speed, 1.02e-3) << order << lambda << phase;
        EXPECT_GT(motion.speed, 0.98e-3 * std::cos(0.5 * std::arg(lambda))) << order << lambda << phase;
      }
}

TEST(FastMotion, may_be_what_a_damper_stops) {
  const System system = plain_system();
  for (const double rate : {300.0, 1e4, 1e9}) {
    Segment segment = slow_segment(12);
    add_exponential(1e-3, -rate, 12, segment.vx);
    const FastMotion motion = fast_motion(system, segment);
    EXPECT_NEAR(motion.rate, rate, 1e-2 * rate);
    EXPECT_NEAR(motion.speed, 1e-3, 1e-5);
  }
}

// Turning counts at the reach of the part's farthest point, and adds to what is straight.
TEST(FastMotion, is_that_of_all_axes) {
  const System system = plain_system();
  const double reach = system.half_width + system.base_distance;
  Segment segment = slow_segment(12);
  add_exponential(1e-3, -1e3, 12, segment.omega);
  EXPECT_NEAR(fast_motion(system, segment).speed, 1e-3 * reach, 1e-5);
  add_exponential(2e-3, -1e3, 12, segment.vx);
  EXPECT_NEAR(fast_motion(system, segment).speed, 1e-3 * (2.0 + reach), 1e-5);
}

TEST(FastMotion, is_none_where_nothing_moves) {
  Segment segment;
  segment.order = 12;
  const FastMotion motion = fast_motion(plain_system(), segment);
  EXPECT_EQ(motion.rate, 0.0);
  EXPECT_EQ(motion.speed, 0.0);
}

// N = 2 - 3 t + t^2 of one contact, 4 + t^2 of the other: after 0.5 by (1.5 + 0.25)/2, beyond what is linear 0.25/2.
TEST(FastMotion, normal_forces_change_by_the_sum_of_their_terms) {
  Segment segment;
  segment.order = 12;
  segment.loaded_count = 2;
  segment.loaded[0].normal_force = {2.0, -3.0, 1.0};
  segment.loaded[1].normal_force = {4.0, 0.0, 1.0};
  EXPECT_DOUBLE_EQ(normal_force_change(segment, 0.5), 0.875);
  EXPECT_DOUBLE_EQ(normal_force_change(segment, 0.5, 2), 0.125);
  segment.loaded_count = 0;
  EXPECT_EQ(normal_force_change(segment, 0.5), 0.0);
}

}  // namespace
}  // namespace vibratory_alignment
