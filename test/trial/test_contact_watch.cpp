// What is reported of the contacts: impacts, the first touch, peak forces, the mode of motion and when it changes;
// against closed forms, the events themselves and dense samples.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../support/random_scenes.h"
#include "../support/runs.h"
#include "../support/scenes.h"
#include "solver/solver.h"
#include "trial/contact_watch.h"

namespace vibratory_alignment {
namespace {

using test::run;
using test::scene_of;

TEST(Impacts, are_the_touches_out_of_flight) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const Scene scene = test::random_scene(seed);
    std::array<long, kSpotCount> touches{};
    const TrialResult result = run(scene, [&](const Segment& g) {
      for (int i = 0; i < g.event_count; ++i) {
        const Event& e = g.events[static_cast<std::size_t>(i)];
        if (e.kind != EventKind::touch) continue;
        // the floor's corners count with their corner
        const std::size_t spot = static_cast<std::size_t>(e.site) < 4 ? static_cast<std::size_t>(e.site)
                                                                      : static_cast<std::size_t>(e.site) - 2;
        ++touches[spot];
      }
    });
    EXPECT_EQ(result.impacts, touches) << "seed " << seed;
  }
}

TEST(Impacts, the_contact_that_a_trial_starts_in_is_none) {
  // resting on the base, pressed so hard that it stays
  const TrialResult rest =
      run(scene_of(test::ball, {"gripper={pressing_force: 2.0}", "initial.y=null", "excitation.amplitude=0.5"}));
  EXPECT_EQ(test::total_impacts(rest), 0);
  EXPECT_FALSE(rest.first_contact);
  EXPECT_GT(rest.peak_force[0], 2.0);
  // exactly at the height of touch, falling
  const TrialResult touching = run(scene_of(test::ball, {"initial={x: 0.2, y: 0.9}", "trial.time_limit=0.5"}));
  EXPECT_EQ(test::total_impacts(touching), 0);
}

// From rest at y0 the ball swings about y_a: v^2 = (y0 - y_a)^2 - (b - y_a)^2, at cos t = (b - y_a)/(y0 - y_a).
TEST(FirstContact, has_time_and_speed_of_the_closed_form) {
  const TrialResult result = run(scene_of(test::ball));
  ASSERT_TRUE(result.first_contact);
  EXPECT_NEAR(result.first_contact->time, std::acos(0.3 / 0.4), 1e-14);
  EXPECT_NEAR(result.first_contact->approach_speed, std::sqrt(0.16 - 0.09), 1e-14);
  EXPECT_EQ(result.first_contact->spot, Spot::a1);
  EXPECT_NEAR(result.first_contact->state.y, 0.9, 1e-15);
  EXPECT_EQ(result.first_contact->slip_velocity, 0.0);
}

// Without base damping the impact is a half wave: N = k d, largest k v/sqrt(k + 1) when the gripper's spring is at
// ease.
TEST(PeakForce, of_an_undamped_impact) {
  for (const double k : {1e2, 1e4, 1e8}) {
    Scene scene = scene_of(test::ball, {"gripper={anchor: {y: 0.9}}", "initial.y=1.2", "base={stiffness: {y: 1.0e4}}",
                                        "trial.time_limit=3"});
    scene.base.stiffness_x = scene.base.stiffness_y = k;
    scene.solver.tolerance = 1e-12;
    EXPECT_NEAR(run(scene).peak_force[0], k * 0.3 / std::sqrt(k + 1.0), 1e-9 * std::sqrt(k)) << k;
  }
}

// No sample is larger, and the largest of many samples is as large but for the curvature between two of them.
TEST(PeakForce, is_that_of_dense_samples) {
  for (unsigned seed = 1; seed <= 25; ++seed) {
    Scene scene = test::random_scene(seed);
    scene.trial.time_limit = 8.0;
    if (seed % 2 == 0) test::cross_layers(scene);
    std::array<double, kSpotCount> largest{};
    const TrialResult result = run(scene, [&](const Segment& g) {
      for (int i = 0; i < g.loaded_count; ++i) {
        double& spot = largest[static_cast<std::size_t>(spot_of(g.loaded[static_cast<std::size_t>(i)].site))];
        for (int k = 0; k <= 100; ++k) spot = std::max(spot, contact_at(g, i, g.duration * k / 100.0).normal_force);
      }
    });
    for (std::size_t i = 0; i < kSpotCount; ++i) {
      EXPECT_GE(result.peak_force[i], largest[i] * (1.0 - 1e-12)) << "seed " << seed;
      EXPECT_LE(result.peak_force[i], largest[i] * (1.0 + 1e-3) + 1e-12) << "seed " << seed;
    }
  }
}

// A segment that is barely above all before it: N = 1, then 0.9 + 4 s (1 - s) (n - 0.9) on [0, duration], largest n.
TEST(PeakForce, grows_by_as_little_as_the_force_does) {
  const System system = make_system(scene_of(test::ball));
  for (const double duration : {1e-3, 1.0, 7.0})
    for (const double largest : {1.0001, 1.05, 1.5}) {
      Segment segment;
      segment.order = 2;
      segment.duration = duration;
      segment.loaded_count = 1;
      segment.loaded[0].site = Site::a1;
      segment.contacts[0] = {Phase::loaded, Face::bottom, Slip::none};
      ContactWatch watch(system, 1.0);
      segment.loaded[0].normal_force[0] = 1.0;
      watch.book(segment);
      segment.loaded[0].normal_force = {0.9, 4.0 * (largest - 0.9) / duration,
                                        -4.0 * (largest - 0.9) / (duration * duration)};
      watch.book(segment);
      EXPECT_NEAR(watch.peak_force(Spot::a1), largest, 1e-14) << duration;
      segment.loaded[0].normal_force = {0.9 * largest, 0.09 * largest / duration};
      watch.book(segment);
      EXPECT_NEAR(watch.peak_force(Spot::a1), largest, 1e-14) << duration;
      segment.loaded[0].normal_force = {0.9 * largest, 0.11 * largest / duration};
      watch.book(segment);
      EXPECT_NEAR(watch.peak_force(Spot::a1), 1.01 * largest, 1e-14) << duration;
    }
}

// Terms that overflow make no peak: the trial must end with the place of it, not go on with the peak before.
TEST(PeakForce, that_overflows_is_a_failure_with_its_place) {
  const System system = make_system(scene_of(test::ball));
  Segment segment;
  segment.order = 2;
  segment.duration = 1e10;
  segment.loaded_count = 1;
  segment.loaded[0].site = Site::a1;
  segment.loaded[0].normal_force[1] = 1e300;
  segment.loaded[0].normal_force[2] = -1e300;
  segment.contacts[0] = {Phase::loaded, Face::bottom, Slip::none};
  ContactWatch watch(system, 1.0);
  try {
    watch.book(segment);
    ADD_FAILURE() << "no failure";
  } catch (const SolverFailure& failure) {
    EXPECT_NE(std::string(failure.what()).find(to_string(Spot::a1)), std::string::npos) << failure.what();
  }
}

TEST(Mode, bouncing_is_impact) {
  const TrialResult result =
      run(scene_of(test::ball, {"gripper={pressing_force: 0.3, damping: {y: 0.05}}", "initial.y=null",
                                "excitation={amplitude: 1.0, frequency: 10}", "trial.time_limit=30"}));
  EXPECT_EQ(result.mode, Mode::impact);
}

TEST(Mode, pressed_firmly_is_nonimpact) {
  const TrialResult result =
      run(scene_of(test::ball, {"gripper={pressing_force: 1.5, damping: {y: 0.05}}", "initial.y=null",
                                "excitation={amplitude: 1.0, frequency: 10}", "trial.time_limit=30"}));
  EXPECT_EQ(result.mode, Mode::nonimpact);
  EXPECT_EQ(test::total_impacts(result), 0);
}

// Contact that has been lost once is not kept, nor lost again and again yet.
TEST(Mode, a_first_flight_is_none) {
  const Scene scene = scene_of(test::ball, {"initial.y=0.899", "initial.vy=1", "excitation.amplitude=0"});
  bool in_flight = false;
  const TrialResult result = run(
      scene, [&](const Segment& g) { in_flight = g.loaded_count == 0; }, 0.2);
  EXPECT_TRUE(in_flight);
  EXPECT_EQ(test::total_impacts(result), 0);
  EXPECT_EQ(result.mode, Mode::none);
}

TEST(Mode, never_touching_is_none) {
  EXPECT_EQ(run(scene_of(test::ball, {"gripper={anchor: {y: 2.0}}", "initial.y=2.0"})).mode, Mode::none);
}

// Drops, bounces and stays: impact from its first loss of contact, nonimpact from its last touch, when it does stay for
// a period. The instants are those of the events.
TEST(Mode, a_ball_that_comes_to_rest_is_mixed) {
  const Scene scene = scene_of(test::ball, {"gripper={anchor: {y: 0.7}, damping: {y: 0.05}}", "initial.y=1.1",
                                            "trial.time_limit=60", "base={stiffness: {y: 1.0e4}, damping: {y: 60}}"});
  std::vector<double> touches;
  double first_loss = NAN;
  for (const test::TimedEvent& e : test::events_of(scene)) {
    if (e.event.kind == EventKind::touch) touches.push_back(e.time);
    // contact is over when the depth has closed
    if (e.event.kind == EventKind::close && std::isnan(first_loss)) first_loss = e.time;
  }
  const TrialResult result = run(scene);
  EXPECT_EQ(result.mode, Mode::mixed);
  ASSERT_EQ(result.mode_changes.size(), 2u);
  EXPECT_EQ(result.mode_changes[0].mode, Mode::impact);
  EXPECT_NEAR(result.mode_changes[0].time, first_loss, 1e-12);
  EXPECT_EQ(result.mode_changes[1].mode, Mode::nonimpact);
  EXPECT_NEAR(result.mode_changes[1].time, touches.back(), 1e-12);
}

// M1 of the paper's facts: well below f0 + w = A contact is lost again and again, well above it is kept.
TEST(Mode, bouncing_needs_more_force_than_the_press) {
  for (const double nu : {5.0, 10.0, 20.0})
    for (const double f0 : {0.2, 0.4, 0.6, 1.3, 3.0, 10.0}) {
      Scene scene = scene_of(test::ball, {"gripper={pressing_force: 1, damping: {y: 0.05}}", "initial.y=null",
                                          "excitation={amplitude: 1.0, frequency: 10}", "trial.time_limit=40"});
      scene.gripper.pressing_force = f0;
      scene.excitations[0].frequency = nu;
      const TrialResult result = run(scene);
      EXPECT_EQ(result.mode, f0 < 1.0 ? Mode::impact : Mode::nonimpact) << "f0 " << f0 << " nu " << nu;
    }
}

// Sliding to the right on a level face V is the velocity to the right: along the normal turned clockwise.
TEST(FirstContact, has_the_slip_velocity) {
  for (const double speed : {0.4, -0.4}) {
    Scene scene = scene_of(test::ball, {"gripper={stiffness: {x: 0}, anchor: {y: 0.6}}"});
    scene.initial.x = 0.6;
    scene.initial.vx = speed;
    const TrialResult result = run(scene);
    ASSERT_TRUE(result.first_contact);
    EXPECT_NEAR(result.first_contact->slip_velocity, speed, 1e-14);
  }
}

// Each contact of a ball on an undamped base takes pi/sqrt(k + 1), whatever the height: kept is what lasts longer than
// a period, be it by a tenth.
TEST(Mode, of_contacts_nearly_as_long_as_a_period) {
  constexpr double contact = 3.14159265358979323846 / 10.0;  // k = 99
  for (const double share : {0.9, 1.1}) {
    Scene scene = scene_of(test::ball, {"gripper={anchor: {y: 0.9}}", "initial.y=1.2", "trial.time_limit=20",
                                        "base={stiffness: {y: 99}}"});
    scene.excitations[0].amplitude = 1e-9;
    scene.excitations[0].frequency = 2.0 * 3.14159265358979323846 * share / contact;
    EXPECT_EQ(run(scene).mode, share < 1.0 ? Mode::impact : Mode::mixed) << share;
  }
}

}  // namespace
}  // namespace vibratory_alignment
