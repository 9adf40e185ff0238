// Flight in closed form: the bounds on it hold, nothing is touched during a leap, and a landing is where the depth is
// zero. By dense sampling of motions with every kind of damping and drive.
#include "solver/flight_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "../support/lone_motion.h"
#include "../support/random_scenes.h"
#include "../support/scenes.h"
#include "mechanics/site_rules.h"
#include "solver/event_solver.h"

namespace vibratory_alignment {
namespace {

DriveForms random_drives(std::mt19937& random) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  DriveForms drives;
  drives.count = 1 + static_cast<int>(2.9 * std::abs(u(random)));
  for (std::size_t i = 0; i < static_cast<std::size_t>(drives.count); ++i) {
    drives.direction[i] = static_cast<Direction>(static_cast<int>(2.99 * std::abs(u(random))));
    DriveForm& form = drives.form[i] = {};
    if (u(random) > 0.6) {
      form.constant = u(random);
      form.slope = u(random);
    } else {
      const double phase = 3.2 * u(random);
      form.amplitude = u(random);
      form.frequency = std::pow(10.0, 0.5 + u(random));
      form.sin_phase = std::sin(phase);
      form.cos_phase = std::cos(phase);
    }
  }
  return drives;
}

// |q'|, |q''|, |q'''| stay below their bounds; the derivatives of q by differences.
TEST(FreeMotionBounds, hold_at_every_sampled_time) {
  std::mt19937 random(81);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  int tried = 0;
  for (int i = 0; i < 400; ++i) {
    Axis axis = test::axis_of(std::pow(10.0, u(random)), 0.0, 0.0, 0.0);
    axis.stiffness = i % 7 == 0 ? 0.0 : std::pow(10.0, 1.5 * u(random));
    axis.damping = i % 5 == 0 ? 0.0 : std::pow(10.0, 1.5 * u(random));
    // critical damping, and beside it: by half at most, down to rounding
    if (i % 11 < 6)
      axis.damping =
          2.0 * std::sqrt(axis.stiffness * axis.inertia) * (1.0 + std::pow(1e-4, i % 11 % 5) * 0.5 * u(random));
    const DriveForms drives = random_drives(random);
    test::LoneMotion motion(axis, static_cast<std::size_t>(drives.count));
    motion.begin(u(random), u(random), 0.3 * u(random));
    for (std::size_t k = 0; k < static_cast<std::size_t>(drives.count); ++k) motion.add(drives.form[k]);
    motion.settle();
    if (!motion.exact()) continue;
    ++tried;
    const double begin = 0.5 * (1.0 + u(random)), end = 5.0, h = 1e-4 / std::max(1.0, motion.rate(0.0));
    const test::LoneMotion::Outlook bounds = motion.outlook(begin, end);
    const auto velocity = [&](double t) {
      double q = 0.0, v = 0.0;
      motion.at(t, q, v);
      return v;
    };
    for (int k = 1; k < 300; ++k) {
      const double t = begin + (end - begin) * k / 300.0, v = velocity(t), after = velocity(t + h),
                   before = velocity(t - h);
      const double second = (after - before) / (2.0 * h), third = (after - 2.0 * v + before) / (h * h);
      ASSERT_LE(std::abs(v), bounds.rate * (1.0 + 1e-12)) << i;
      ASSERT_LE(std::abs(second), bounds.second * (1.0 + 1e-6) + 1e-9) << i;
      ASSERT_LE(std::abs(third), bounds.third * (1.0 + 1e-4) + 1e-6 * bounds.second / h) << i;
    }
  }
  EXPECT_GT(tried, 200);
}

// A fast mode that has decayed leaves the slow one, c exp(-r t) with m r^2 - h r + k = 0, and neither more nor less.
TEST(FreeMotionBounds, forget_what_has_decayed) {
  const Axis axis = test::axis_of(1e-8, 0.31, 11.0, 0.0);
  test::LoneMotion motion(axis, 0);
  motion.begin(0.02, -3.0, 0.0);
  motion.settle();
  const double slow = 2.0 * axis.stiffness / (axis.damping + std::sqrt(axis.damping * axis.damping - 4e-8 * 11.0));
  const double begin = 1e-5;
  double q = 0.0, v = 0.0;
  motion.at(begin, q, v);
  // the slow mode alone, from a state in which it is alone
  EXPECT_NEAR(v, -slow * q, 1e-9);
  const test::LoneMotion::Outlook bounds = motion.outlook(begin, 1.0);
  EXPECT_GE(bounds.third * (1.0 + 1e-9), std::abs(q) * slow * slow * slow);
  EXPECT_NEAR(bounds.third, std::abs(q) * slow * slow * slow, 1e-9 * bounds.third);
  EXPECT_NEAR(bounds.rate, std::abs(v), 1e-9);
  EXPECT_NEAR(motion.rate(begin), slow, 1e-9 * slow);
  EXPECT_EQ(motion.rate(5.0), 0.0);  // exp(-5 slow) = 1e-77
  EXPECT_GT(motion.outlook(0.0, 1.0).third, 1e12);
  EXPECT_GT(motion.rate(0.0), 1e7);
}

// A drive goes on; and where there is no closed form, nothing tells when the axis' own motion has decayed.
TEST(FreeMotionBounds, a_drive_keeps_its_rate) {
  const Axis axis = test::axis_of(1.0, 4.0, 100.0, 0.0);
  for (const double chirp : {0.0, 0.1}) {
    DriveForm form;
    form.amplitude = 0.3;
    form.frequency = 7.0;
    form.cos_phase = 1.0;
    form.rate = chirp;
    test::LoneMotion motion(axis, 1);
    motion.begin(0.1, 0.0, 0.0);
    motion.add(form);
    motion.settle();
    EXPECT_EQ(motion.exact(), chirp == 0.0);
    EXPECT_EQ(motion.rate(0.0), 10.0);
    EXPECT_EQ(motion.rate(1e3), chirp == 0.0 ? 7.0 : 10.0);
  }
}

// Whatever the damping, critical or beside it, bounds are not far from what comes: below 5 times the greatest value
// from then on.
TEST(FreeMotionBounds, are_close_on_what_decays) {
  for (const double ratio : {0.05, 0.3, 0.7, 0.85, 0.95, 0.999, 1.0, 1.001, 1.05, 1.1, 1.2, 2.0, 20.0})
    for (const double v : {-30.0, -3.0, 0.0, 1.0, 40.0})
      for (const double begin : {0.0, 0.05, 0.6}) {
        const Axis axis = test::axis_of(1.0, 2.0 * ratio * 9.0, 81.0, 0.0);
        test::LoneMotion motion(axis, 0);
        motion.begin(0.7, v, 0.0);
        motion.settle();
        const test::LoneMotion::Outlook bounds = motion.outlook(begin, 9.0);
        test::LoneMotion::Outlook most{};
        for (int k = 0; k < 4000; ++k) {
          double q = 0.0, rate = 0.0;
          const double t = begin + 3.0 * k / 4000.0;
          motion.at(t, q, rate);
          const double second = -81.0 * q - axis.damping * rate, third = -81.0 * rate - axis.damping * second;
          most.rate = std::max(most.rate, std::abs(rate));
          most.second = std::max(most.second, std::abs(second));
          most.third = std::max(most.third, std::abs(third));
        }
        EXPECT_LT(bounds.rate, 5.0 * most.rate) << ratio << ", " << v << ", " << begin;
        EXPECT_LT(bounds.second, 5.0 * most.second) << ratio << ", " << v << ", " << begin;
        EXPECT_LT(bounds.third, 5.0 * most.third) << ratio << ", " << v << ", " << begin;
      }
}

// What no longer moves has no rate, at whatever damping, the critical one too; until then it has that of the axis.
TEST(FreeMotionBounds, a_stiff_axis_at_rest_has_no_rate) {
  for (const double ratio : {0.1, 0.7, 0.9, 1.0 - 1e-9, 1.0, 1.0 + 1e-9, 1.0006, 1.5, 2.0}) {
    test::LoneMotion motion(test::axis_of(1.0, 2.0 * ratio * 1e6, 1e12, 0.0), 0);
    motion.begin(0.3, -2.0, 0.0);
    motion.settle();
    EXPECT_GE(motion.rate(1e-6), 1e6 * (1.0 - 1e-12)) << ratio;
    EXPECT_GE(motion.rate(5e-6), 2.6e5) << ratio;
    EXPECT_EQ(motion.rate(1e-2), 0.0) << ratio;
  }
}

/// The deepest any site of the system is inside the other body.
double deepest(const System& system, const State& state) {
  double depth = -INFINITY;
  for (int i = 0; i < kSiteCount; ++i) {
    const auto site = static_cast<Site>(i);
    if (!site_in_use(system, site)) continue;
    const Vec2 p = site_point(system, state, site);
    for (int half = 0; half < region_count(site); ++half) {
      const Region region = site_region(system, site, half);
      double least = INFINITY;
      for (int j = 0; j < region.count; ++j) least = std::min(least, region.conditions[j].value(p));
      depth = std::max(depth, least);
    }
  }
  return depth;
}

/// The largest value that is met in the flight between the times t and t + free. Of the state, only coordinates that do
/// not move are read.
template <class Value>
double largest_within(const Flight& flight, State state, double t, double free, const Value& value) {
  double largest = -INFINITY;
  for (int k = 0; k <= 200; ++k) {
    flight.at(t + free * k / 200.0, state);
    largest = std::max(largest, value(state));
  }
  return largest;
}

TEST(Flight, nothing_is_touched_before_what_look_ahead_tells) {
  int leaps = 0, long_ones = 0, landings = 0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    const Scene scene = test::random_scene(seed);
    const System system = make_system(scene);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    State state = system.start;
    state.vx = u(random);
    state.vy = u(random);
    state.omega = 3.0 * u(random);
    if (deepest(system, state) > 0.0) continue;
    const DriveForms drives = random_drives(random);
    Flight flight(system, static_cast<std::size_t>(drives.count));
    flight.begin(state, drives, {});
    if (!flight.exact()) continue;
    const double longest = 2.0;
    double t = 0.0;
    for (int leap = 0; leap < 30; ++leap) {
      flight.at(t, state);
      const FlightOutlook outlook = look_ahead(system, flight, t, state, {}, {}, {}, {}, longest);
      const double free = outlook.time;
      ASSERT_GE(free, 0.0);
      ASSERT_LE(free, longest);
      if (free == 0.0) break;
      ++leaps;
      long_ones += free > 0.02;
      const auto depth = [&](const State& s) { return deepest(system, s); };
      ASSERT_LE(largest_within(flight, state, t, free, depth), 1e-13)
          << "seed " << seed << ", leap " << leap << " of " << free << " at " << t;
      State end = state;
      flight.at(t + free, end);
      EXPECT_EQ(outlook.end.y, end.y);
      EXPECT_EQ(outlook.end.omega, end.omega);
      if (outlook.lands) {
        // the depth is zero and rises
        ++landings;
        EXPECT_EQ(outlook.event.kind, EventKind::touch);
        const ContactKinematics touch = contact_kinematics(system, end, outlook.event.site, outlook.event.face);
        EXPECT_NEAR(touch.depth, 0.0, 1e-14) << "seed " << seed;
        EXPECT_GT(touch.depth_rate, 0.0) << "seed " << seed;
        break;
      }
      t += free;
      if (t > 10.0) break;
    }
  }
  EXPECT_GT(leaps, 500);
  EXPECT_GT(long_ones, 200);
  EXPECT_GT(landings, 100);
}

/// How far the part is in the slot beyond `depth`, with both corners between its walls if asked; below zero: it is not.
double how_far_in(const System& system, const State& state, double depth, bool between_walls) {
  double least = INFINITY;
  for (const Site site : {Site::b1, Site::b2}) {
    const Vec2 p = site_point(system, state, site);
    least = std::min(least, -p.y - depth);
    if (between_walls) least = std::min(least, system.slot_half_width - std::abs(p.x));
  }
  return least;
}

TEST(Flight, nothing_is_aligned_before_what_look_ahead_tells) {
  int leaps = 0, long_ones = 0, in_the_end = 0;
  for (unsigned seed = 1; seed <= 1000; ++seed) {
    Scene scene = test::random_scene(seed);
    scene.contacts = {true, false, false};
    scene.trial.inserted_depth = scene.trial.aligned_depth + 0.1;
    const System system = make_system(scene);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    // above or in the slot, on its way down or to the middle
    State state = {1.5 * scene.slot.clearance * u(random),
                   system.base_distance + 0.2 * u(random),
                   0.1 * u(random),
                   u(random),
                   -1.0 + u(random),
                   u(random)};
    if (deepest(system, state) > 0.0 || how_far_in(system, state, system.aligned_depth, true) > 0.0) continue;
    const DriveForms drives = random_drives(random);
    Flight flight(system, static_cast<std::size_t>(drives.count));
    flight.begin(state, drives, {});
    if (!flight.exact()) continue;
    double t = 0.0;
    for (int leap = 0; leap < 30 && t < 2.0; ++leap) {
      flight.at(t, state);
      const double free = look_ahead(system, flight, t, state, {}, {}, {}, {true, true}, 2.0 - t).time;
      if (free == 0.0) break;
      ++leaps;
      long_ones += free > 0.02;
      const auto beyond = [&](const State& s) {
        return std::max(how_far_in(system, s, system.aligned_depth, true),
                        how_far_in(system, s, system.inserted_depth, false));
      };
      ASSERT_LE(largest_within(flight, state, t, free, beyond), 1e-13) << "seed " << seed << " at " << t;
      t += free;
      State soon = state;
      flight.at(t + 0.02, soon);
      in_the_end += how_far_in(system, soon, system.aligned_depth, true) > 0.0;
    }
  }
  EXPECT_GT(leaps, 500);
  EXPECT_GT(long_ones, 200);
  EXPECT_GT(in_the_end, 100);
}

// On its way out of a contact a site starts at depth 0 and must be seen as leaving, at any speed.
TEST(Flight, a_site_that_leaves_its_face_is_no_hindrance) {
  const System system = make_system(test::scene_of(test::plain, {"gripper.anchor.phi=0.0"}));
  for (const double speed : {1e-6, 1e-3, 1.0}) {
    State state{0.21, system.base_distance, 0.0, 0.0, speed, 0.0};
    Pins pins{};
    pins[0].face = Face::bottom;
    Flight flight(system, 0);
    flight.begin(state, {}, {});
    const double free = look_ahead(system, flight, 0.0, state, {}, pins, {}, {}, 1.0).time;
    // it turns no way, and is back on the base after 2 v/g
    const double back = 2.0 * speed / (system.base_distance - system.y.anchor);
    EXPECT_GT(free, 0.4 * std::min(back, 1.0)) << speed;
    EXPECT_LT(free, 1.05 * back) << speed;
  }
}

// Thrown up from the base, on a spring that pulls it back: y - 0.6 = 0.3 cos t + v sin t is 0.3 again at 2 atan(v/0.3).
TEST(Flight, one_look_finds_the_landing_of_a_whole_flight) {
  const System system = make_system(test::scene_of(test::ball, {"gripper.damping.y=0.0"}));
  for (const double speed : {1e-4, 0.1, 0.5, 3.0}) {
    const State state{0.2, system.base_distance, 0.0, 0.0, speed, 0.0};
    Pins pins{};
    pins[0].face = Face::bottom;
    Flight flight(system, 0);
    flight.begin(state, {}, {});
    const FlightOutlook outlook = look_ahead(system, flight, 0.0, state, {}, pins, {}, {}, 10.0);
    ASSERT_TRUE(outlook.lands) << speed;
    EXPECT_EQ(outlook.event.kind, EventKind::touch);
    EXPECT_EQ(outlook.event.site, Site::a1);
    EXPECT_EQ(outlook.event.face, Face::bottom);
    EXPECT_NEAR(outlook.time, 2.0 * std::atan(speed / 0.3), 1e-15 / speed + 1e-15);
  }
}

/// Just released: edge A1 is `depth` deep in the bottom face, k d + h d' = 0, and nothing but the gripper acts.
struct Released {
  System system;
  State state;

  Released(System released, double depth, double phi, double omega) : system(std::move(released)) {
    state = {0.21, 0.0, phi, 0.0, 0.0, omega};
    // depth and its rate grow by -cos phi with y and vy
    state.y = (kinematics(state).depth - depth) / std::cos(phi);
    state.vy = (kinematics(state).depth_rate + relaxation(state) * depth) / std::cos(phi);
  }
  ContactKinematics kinematics(const State& q) const { return contact_kinematics(system, q, Site::a1, Face::bottom); }
  /// k/h
  double relaxation(const State& q) const {
    const double c = std::cos(q.phi), s = std::sin(q.phi);
    return (system.stiffness_y * c * c + system.stiffness_x * s * s) /
           (system.damping_y * c * c + system.damping_x * s * s);
  }
  Flight flight() const {
    Flight flight(system, 0);
    flight.begin(state, {}, {});
    return flight;
  }
  FlightOutlook outlook(const Flight& flight) const {
    ContactStates contacts{};
    contacts[0] = {Phase::unloaded, Face::bottom};
    return look_ahead(system, flight, 0.0, state, contacts, {}, {}, {}, 10.0);
  }
  /// N/k at its largest up to `time`.
  double most_push(const Flight& flight, double time) const {
    return largest_within(flight, state, 0.0, time, [&](const State& q) {
      return kinematics(q).depth + kinematics(q).depth_rate / relaxation(q);
    });
  }
};

// Bases stiffer and more damped in one direction than in the other, whose k/h turns with the part: on the way to where
// it is told to close the base is never pressed again.
TEST(Flight, an_unloaded_contact_that_is_told_to_close_is_not_loaded_before) {
  int closings = 0, others = 0, turning = 0;
  for (unsigned seed = 1; seed <= 3000; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    const auto between = [&](double low, double high) { return low * std::pow(high / low, 0.5 + 0.5 * u(random)); };
    Scene scene = test::scene_of(test::plain, {});
    scene.base.stiffness_y = between(1.0, 1e4);
    scene.base.stiffness_x = scene.base.stiffness_y * between(0.1, 10.0);
    scene.base.damping_y = scene.base.stiffness_y / between(1.0, 1e3);
    scene.base.damping_x = scene.base.stiffness_x / between(1.0, 1e3);
    Released released(make_system(scene), between(1e-6, 1e-2), 0.4 * u(random), 2.0 * u(random));
    released.system.y.anchor = released.state.y + 0.5 + 2.0 * u(random);  // more often pulled off than pressed on
    const Flight flight = released.flight();
    const FlightOutlook outlook = released.outlook(flight);
    if (!outlook.lands) {
      ++others;
      continue;
    }
    ++closings;
    turning += std::abs(released.relaxation(outlook.end) / released.relaxation(released.state) - 1.0) > 1e-3;
    EXPECT_EQ(outlook.event.kind, EventKind::close);
    EXPECT_NEAR(released.kinematics(outlook.end).depth, 0.0, 1e-14) << seed;
    EXPECT_LE(released.most_push(flight, outlook.time), 1e-15) << seed;
  }
  EXPECT_GT(closings, 150);
  EXPECT_GT(turning, 50);
  EXPECT_GT(others, 100);
}

// Hardly damped upwards and much across: as the part turns upright the base answers faster than it is left, and is
// pressed again.
TEST(Flight, an_unloaded_contact_that_is_loaded_again_is_left_to_the_series) {
  constexpr double kTilt = 1e-3, kTurning = -1.0, kDepth = 1e-5;
  System system = make_system(test::scene_of(test::plain, {}));
  system.stiffness_x = system.stiffness_y = 1e3;
  system.damping_y = 1e-3;
  system.damping_x = 1.0 / (kTilt * kTilt);
  system.isotropic = false;
  Released released(system, kDepth, kTilt, kTurning);
  released.system.y.anchor = released.state.y + 0.5;  // pulled off, as alone the contact would close
  const Flight flight = released.flight();
  EXPECT_GT(released.most_push(flight, 5e-4), 0.1 * kDepth);
  EXPECT_FALSE(released.outlook(flight).lands);
}

// Shaken so that it nears the base and turns back: wherever a landing is told of, the depth is zero.
TEST(Flight, a_turning_point_is_no_landing) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  int landings = 0;
  for (int i = 0; i < 5000; ++i) {
    System system = make_system(test::scene_of(test::plain));
    system.y.stiffness = 0.1;
    DriveForms drives;
    drives.count = 1;
    drives.direction[0] = Direction::y;
    drives.form[0] = {};
    drives.form[0].amplitude = 20.0 * u(random);
    drives.form[0].frequency = 14.0;
    const double phase = 6.3 * u(random);
    drives.form[0].sin_phase = std::sin(phase);
    drives.form[0].cos_phase = std::cos(phase);
    const State state{0.21, system.base_distance + 0.3 * u(random), 0.0, 0.0, -u(random), 0.0};
    if (deepest(system, state) > 0.0) continue;
    Flight flight(system, 1);
    flight.begin(state, drives, {});
    const FlightOutlook outlook = look_ahead(system, flight, 0.0, state, {}, {}, {}, {}, 3.0);
    if (!outlook.lands) continue;
    ++landings;
    ASSERT_NEAR(deepest(system, outlook.end), 0.0, 1e-14) << i;
  }
  EXPECT_GT(landings, 250);
}

/// What is seen of a part without springs, thrown at the base and pulled back by a constant force: y - b = 0.1 - t +
/// t^2, which has no third derivative, dips below zero and comes back.
FlightOutlook look_at_dip(const Recoveries& recoveries) {
  System system = make_system(test::scene_of(test::plain));
  for (Axis* axis : {&system.x, &system.y, &system.phi}) axis->stiffness = axis->damping = 0.0;
  system.weight = 0.0;
  DriveForms drives;
  drives.count = 1;
  drives.direction[0] = Direction::y;
  drives.form[0] = {};
  drives.form[0].constant = 2.0 * system.y.inertia;
  const State state{-0.21, system.base_distance + 0.1, 0.0, 0.0, -1.0, 0.0};
  Flight flight(system, 1);
  flight.begin(state, drives, {});
  return look_ahead(system, flight, 0.0, state, {}, {}, recoveries, {}, 3.0);
}
const double kDip = 0.5 - std::sqrt(0.15);

TEST(Flight, a_dip_under_a_constant_force_is_a_landing) {
  const FlightOutlook outlook = look_at_dip({});
  EXPECT_TRUE(outlook.lands);
  EXPECT_NEAR(outlook.time, kDip, 1e-14);
}

// A point meets a base that has not recovered yet below its surface: later than the look knows. What another point has
// left behind is not in its way.
TEST(Flight, a_base_that_recovers_is_not_landed_on) {
  const auto site = static_cast<std::size_t>(look_at_dip({}).event.site);
  ASSERT_NE(site, 0u);
  Recoveries same{}, other{};
  same[site] = other[0] = {1e-3, Face::bottom};
  const FlightOutlook above = look_at_dip(same);
  EXPECT_FALSE(above.lands);
  EXPECT_LT(above.time, kDip);
  EXPECT_TRUE(look_at_dip(other).lands);
}

/// A part of next to no inertia about its mass centre, whose damper stops it in 1e-14: from then on it turns slowly.
System damped_at_once(double lift) {
  System system;
  system.half_width = system.base_distance = 1.0;
  system.slot_half_width = 0.05;
  system.x.moves = false;
  system.x.inverse_inertia = 0.0;
  system.y = {true, 1.0, 1.0, 1.0, 1.0, lift};
  system.phi = {true, 1e-8, 1e8, 1e4, 1e6, -0.8};
  system.contacts = {false, true, false};
  system.aligned_depth = 0.5;
  return system;
}

// The forces of its fast motion, long decayed, cancel: what rounding leaves of them must not look like an acceleration.
TEST(Flight, rounding_of_large_forces_hides_no_touch) {
  int landings = 0;
  for (int i = 0; i < 115; ++i) {
    const System system = damped_at_once(1.3 + 1e-3 * i);
    const double slow = 1e-2;
    const State start{0.2, system.y.anchor, 0.1 + 1e-4 * i, 0.0, 0.0, 0.0};
    Flight flight(system, 0);
    flight.begin(start, {}, {});
    const double t = 2e-12 + 1e-4 * i / slow;
    State state = start;
    flight.at(t, state);
    Flight::Motion motion;
    flight.motion_at(t, t, motion);
    EXPECT_NEAR(motion.outlook.acceleration[FreeAxes::kPhi],
                (start.phi - system.phi.anchor) * slow * slow * std::exp(-slow * t), 1e-14);
    const FlightOutlook outlook = look_ahead(system, flight, t, state, {}, {}, {}, {}, 3.0 / slow);
    landings += outlook.lands;
    for (int k = 0; k <= 3000; ++k) {
      State inside = state;
      flight.at(t + outlook.time * k / 3000.0, inside);
      ASSERT_LE(deepest(system, inside), 1e-13) << i;
    }
  }
  EXPECT_GT(landings, 50);
}

// Nor does the time that such a motion takes to decay limit the steps to what ends its flight: an outcome, or a touch
// of both corners, which one look ahead does not tell.
TEST(Flight, a_motion_that_has_decayed_does_not_shorten_the_steps) {
  for (const double inertia : {1e-6, 1e-8, 1e-9})
    for (const bool lands : {false, true}) {
      System system = damped_at_once(0.5);
      system.phi = {true, inertia, 1.0 / inertia, 11.0, 0.31, 1e-3};
      system.y.damping = 0.3;
      system.stiffness_x = system.stiffness_y = 1e3;
      system.damping_x = system.damping_y = 10.0;
      system.aligned_depth = 0.05;
      system.start = {0.0, 1.4, 1.1e-3, 0.0, 0.0, 0.0};
      if (lands) {
        system.phi.anchor = 1e-7;
        system.start.phi = 2e-7;
      } else {
        system.slot_half_width = 1.1;
        system.contacts = {true, true, true};
      }
      EventSolver solver(system, {}, 1e-6, 200);
      while (solver.advance(100.0).event_count == 0) {
      }
      EXPECT_EQ(solver.segment().events[0].kind, lands ? EventKind::touch : EventKind::aligned);
      EXPECT_LT(solver.counts().steps, 40) << "inertia " << inertia;
    }
}

// What touches at the same time has to be seen together, as the series see it; rounding may set one before the other.
TEST(Flight, points_that_touch_at_once_are_left_to_the_series) {
  const System system = make_system(test::scene_of(test::plain, {"contacts=[corners]", "gripper.anchor.phi=0.0"}));
  const auto lands = [&](double height, double phi) {
    const State state{3.0, system.base_distance + height, phi, 0.0, -1.0, 0.0};
    Flight flight(system, 0);
    flight.begin(state, {}, {});
    return look_ahead(system, flight, 0.0, state, {}, {}, {}, {}, 3.0).lands;
  };
  int alone = 0;
  for (int i = 1; i <= 300; ++i) {
    const double height = 1e-3 * i;
    ASSERT_FALSE(lands(height, 0.0)) << height;
    alone += lands(height, 0.01) && lands(height, -0.01);
  }
  EXPECT_GT(alone, 200);
}

// An edge that meets the part's very corner could be on either of two faces.
TEST(Flight, the_landing_on_a_corner_is_left_to_the_series) {
  const System system = make_system(test::scene_of(test::ball));
  const auto lands = [&](double inside) {
    const State state{
        system.slot_half_width - system.half_width + inside, system.base_distance + 0.1, 0.0, 0.0, -1.0, 0.0};
    Flight flight(system, 0);
    flight.begin(state, {}, {});
    return look_ahead(system, flight, 0.0, state, {}, {}, {}, {}, 3.0).lands;
  };
  EXPECT_TRUE(lands(1e-3));
  EXPECT_FALSE(lands(1e-9));
  EXPECT_FALSE(lands(-1e-9));
}

// Parts that turn fast: the point that seems nearest is not always the one that touches first.
TEST(Flight, no_other_point_touches_before_a_landing) {
  int landings = 0;
  for (unsigned seed = 1; seed <= 3000; ++seed) {
    const System system = make_system(test::random_scene(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    State state = system.start;
    state.y += 0.5 * std::abs(u(random));
    state.vx = u(random);
    state.vy = -std::abs(u(random));
    state.omega = 20.0 * u(random);
    if (deepest(system, state) > 0.0) continue;
    Flight flight(system, 0);
    flight.begin(state, {}, {});
    if (!flight.exact()) continue;
    const FlightOutlook outlook = look_ahead(system, flight, 0.0, state, {}, {}, {}, {}, 2.0);
    if (!outlook.lands) continue;
    ++landings;
    for (int k = 0; k < 300; ++k) {
      State inside;
      flight.at(outlook.time * k / 300.0, inside);
      ASSERT_LE(deepest(system, inside), 1e-13) << "seed " << seed;
    }
  }
  EXPECT_GT(landings, 1000);
}

}  // namespace
}  // namespace vibratory_alignment
