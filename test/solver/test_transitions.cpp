// What a stick that reaches the limit of friction becomes, of a block that lies on the base and is pulled along it.
#include "solver/transitions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../support/drive_forms.h"
#include "../support/scenes.h"
#include "solver/motion_series.h"

namespace vibratory_alignment {
namespace {

using test::ramp;
using test::sine;

constexpr auto kSite = static_cast<std::size_t>(Site::a1);

/// A pull in units of what friction holds.
DriveForms pull(DriveForm form, double limit) {
  form.constant *= limit;
  form.slope *= limit;
  form.amplitude *= limit;
  DriveForms drives;
  drives.count = 1;
  drives.direction[0] = Direction::x;
  drives.form[0] = form;
  return drives;
}

System block() {
  return make_system(test::scene_of(test::ball, {"gripper={stiffness: {x: 0.0}, anchor: {x: 0.2}, pressing_force: 2.0}",
                                                 "base={stiffness: {y: 100.0}, damping: {y: 2.0}}",
                                                 "friction={coefficient: 0.2}", "initial={x: 0.2}"}));
}

/// The law of friction and the pins after the block has stuck for `duration` under `before`, and a slip event.
ContactMode after_stick(const DriveForm& before, double duration, const DriveForm& after, bool kink) {
  const System system = block();
  Segment segment;
  segment.contacts[kSite] = {Phase::loaded, Face::bottom, Slip::stick};
  segment.begin = system.start;
  MotionSeries series(system);
  series.expand_contact(segment.begin, pull({}, 0.0), 14, segment);
  const double limit = system.friction * segment.loaded[0].normal_force[0];
  EXPECT_NEAR(segment.loaded[0].normal_force[1], 0.0, 1e-9);
  series.expand_contact(segment.begin, pull(before, limit), 14, segment);
  segment.duration = duration;
  segment.end = state_at(segment, duration);
  FoundEvents events;
  events.time = duration;
  events.count = 1;
  events.events[0] = {EventKind::slip, Site::a1};
  events.kink = kink;
  ContactMode mode;
  mode.contacts = segment.contacts;
  FrictionChoice friction(system, 1e-9);
  apply_events(system, segment, pull(after, limit), friction, events, mode);
  return mode;
}

// With the same pull after an instant at which an excitation has a kink the same is found by friction.
TEST(Transitions, a_pull_that_goes_on_rising_makes_it_slide) {
  for (const double sign : {1.0, -1.0})
    for (const bool kink : {false, true}) {
      const ContactMode mode = after_stick(ramp(0.75 * sign, 2.5 * sign), 0.1, ramp(sign, 2.5 * sign), kink);
      EXPECT_EQ(mode.contacts[kSite].slip, sign > 0.0 ? Slip::plus : Slip::minus) << sign << " " << kink;
      EXPECT_EQ(mode.pins[kSite].slip, 2) << sign << " " << kink;
      EXPECT_EQ(mode.pins[kSite].hold_plus, 0);
      EXPECT_EQ(mode.pins[kSite].hold_minus, 0);
    }
}

TEST(Transitions, a_pull_that_turns_at_the_limit_leaves_it_where_it_is) {
  for (const double sign : {1.0, -1.0}) {
    const double peak = 0.5 * M_PI;
    const ContactMode mode = after_stick(sine(sign, 3.0, peak - 0.6), 0.2, sine(sign, 3.0, peak), false);
    EXPECT_EQ(mode.contacts[kSite].slip, Slip::stick) << sign;
  }
}

TEST(Transitions, a_kink_at_the_limit_decides_by_what_comes_after_it) {
  for (const double sign : {1.0, -1.0}) {
    const ContactMode mode = after_stick(ramp(0.75 * sign, 2.5 * sign), 0.1, ramp(sign, -sign), true);
    EXPECT_EQ(mode.contacts[kSite].slip, Slip::stick) << sign;
  }
}

// Friction ends it at once, and the pull decides; a speed that takes a while to stop goes on.
TEST(Transitions, what_is_left_of_a_motion_that_has_died_out_has_no_direction) {
  const System system = block();
  const double limit = system.friction * 2.0;
  FrictionChoice friction(system, 1e-9);
  const auto slip_of_start = [&](double speed, double share) {
    State start = system.start;
    start.vx = speed;
    return start_mode(system, start, pull(ramp(share, 0.0), limit), friction).contacts[kSite].slip;
  };
  for (const double speed : {1e-40, -1e-40, 0.0}) {
    EXPECT_EQ(slip_of_start(speed, 0.5), Slip::stick) << speed;
    EXPECT_EQ(slip_of_start(speed, 2.0), Slip::plus) << speed;
    EXPECT_EQ(slip_of_start(speed, -2.0), Slip::minus) << speed;
  }
  EXPECT_EQ(slip_of_start(1e-12, -2.0), Slip::plus);
}

}  // namespace
}  // namespace vibratory_alignment
