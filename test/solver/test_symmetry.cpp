// Left and right are alike: a mirrored scene moves as the mirror image, and a symmetric one stays symmetric.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "../support/mirror.h"
#include "../support/random_scenes.h"
#include "../support/runs.h"
#include "../support/scenes.h"
#include "mechanics/site_rules.h"
#include "solver/contact_events.h"
#include "solver/step_size.h"

namespace vibratory_alignment {
namespace {

using test::events_of;
using test::mirrored;
using test::run;
using test::TimedEvent;
using test::twin;

// One contact at a time: the same sums in the same order, so the same bits.
TEST(Symmetry, a_mirrored_scene_gives_the_mirrored_motion_bit_for_bit) {
  for (const char* law :
       {"friction={coefficient: 0.3}", "friction={coefficient: 0.3, regularization: 2.0e-3}", "friction=null"}) {
    const Scene scene = test::scene_of(test::plain, {law});
    const std::vector<TimedEvent> right = events_of(scene), left = events_of(mirrored(scene));
    ASSERT_EQ(right.size(), left.size());
    for (std::size_t i = 0; i < right.size(); ++i) {
      EXPECT_EQ(right[i].time, left[i].time);
      EXPECT_EQ(right[i].event.site, twin(left[i].event.site));
      EXPECT_EQ(test::distance(right[i].state, mirrored(left[i].state)), 0.0) << "event " << i;
    }
    EXPECT_EQ(test::distance(run(scene).final_state, mirrored(run(mirrored(scene)).final_state)), 0.0);
  }
}

// Several contacts are summed in another order: the last digit, grown by the impacts.
TEST(Symmetry, a_mirrored_random_scene_gives_the_mirrored_motion) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    Scene scene = test::random_scene(seed);
    scene.trial.time_limit = 3.0;
    const TrialResult right = run(scene), left = run(mirrored(scene));
    EXPECT_EQ(right.outcome, left.outcome) << "seed " << seed;
    EXPECT_NEAR(right.final_time, left.final_time, 1e-9) << "seed " << seed;
    EXPECT_LT(test::distance(right.final_state, mirrored(left.final_state)), 1e-8) << "seed " << seed;
    EXPECT_EQ(right.impacts[0], left.impacts[1]) << "seed " << seed;
    EXPECT_EQ(right.impacts[2], left.impacts[3]) << "seed " << seed;
  }
}

/// Falls straight into the slot and bounces flat on the floor, on both corners at once.
const std::string straight = R"(
part: {half_width: 0.67, base_distance: 0.93, inertia: 0.17}
slot: {clearance: 0.05, depth: 0.3}
gripper: {stiffness: {x: 0.07, phi: 11.0}, damping: {x: 0.01, y: 0.03, phi: 0.3}, anchor: {y: 0.3}}
base: {stiffness: {x: 2900.0, y: 4100.0}, damping: {x: 11.0, y: 17.0}}
contacts: [edges, corners, walls]
friction: {coefficient: 0.24}
excitation: {amplitude: 1.0, frequency: 19.0}
initial: {x: 0.0, y: 1.1, phi: 0.0}
trial: {time_limit: 20.0, inserted_depth: 0.3}
)";

/// Contacts of a state, of which those that are loaded slide.
ContactStates contacts_of(const System& system, const State& state) {
  ContactStates contacts;
  place_contacts(system, state, contacts);
  for (std::size_t i = 0; i < kSiteCount; ++i) {
    if (contacts[i].phase != Phase::loaded) continue;
    const ContactKinematics k = contact_kinematics(system, state, static_cast<Site>(i), contacts[i].face);
    contacts[i].slip = k.slip_velocity > 0.0 ? Slip::plus : Slip::minus;
  }
  return contacts;
}

long count_of(const ContactStates& contacts, Phase phase) {
  return std::count_if(contacts.begin(), contacts.end(), [&](const ContactState& c) { return c.phase == phase; });
}

// Of one contact that is loaded and others that are no longer: whichever site is met first, the first event has the
// same digits.
TEST(Symmetry, events_beside_a_loaded_contact_are_alike_bit_for_bit) {
  const System system = make_system(test::scene_of(straight, {"slot.clearance=0.004", "slot.depth=3.0"}));
  MotionSeries series(system);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  int seen = 0, closed = 0;
  for (int i = 0; i < 2'000'000 && seen < 8000; ++i) {
    const State right{0.006 * u(random), 0.5 + 0.1 * u(random), 0.006 * u(random),
                      0.3 * u(random),   0.3 * u(random),       0.3 * u(random)};
    const ContactStates contacts = contacts_of(system, right);
    if (count_of(contacts, Phase::loaded) != 1 || count_of(contacts, Phase::unloaded) == 0) continue;
    ++seen;
    FoundEvents found[2];
    for (const bool left : {false, true}) {
      Segment segment;
      segment.begin = left ? mirrored(right) : right;
      segment.contacts = contacts_of(system, segment.begin);
      const DriveForms none;
      series.expand_contact(segment.begin, none, 18, segment);
      segment.duration = series_step(system, segment, 1e-11);
      find_events(system, series, segment, {}, {}, {}, none, 1e-11, found[left ? 1 : 0]);
    }
    ASSERT_EQ(found[0].count, found[1].count) << i;
    ASSERT_EQ(found[0].time, found[1].time) << i;
    if (found[0].count == 0) continue;
    EXPECT_EQ(found[0].events[0].site, twin(found[1].events[0].site)) << i;
    closed += found[0].events[0].kind == EventKind::close;
  }
  EXPECT_GT(closed, 100);
}

// Two corners of an almost level part touch the floor at times that count as one: which comes first must not matter.
TEST(Symmetry, a_touch_of_two_corners_and_its_mirror_image_are_alike_bit_for_bit) {
  for (int i = 0; i < 1000; ++i) {
    Scene scene = test::scene_of(straight, {"trial.aligned_depth=0.29"});
    scene.initial.phi = 1e-16 * (1.0 + 0.03 * i);
    scene.initial.x = 0.01 + 3e-5 * i;
    scene.initial.y = 1.0 + 9e-5 * i;
    const auto first_touch = [](const Scene& s) {
      const std::vector<TimedEvent> events = events_of(s, 1.5);
      return *std::find_if(events.begin(), events.end(),
                           [](const TimedEvent& e) { return e.event.kind == EventKind::touch; });
    };
    const TimedEvent right = first_touch(scene), left = first_touch(mirrored(scene));
    ASSERT_EQ(right.time, left.time) << i;
    ASSERT_EQ(test::distance(right.state, mirrored(left.state)), 0.0) << i;
  }
}

/// Far below rounding of what the motion is made of: that of the forces of a contact which ends with N = 1e-14.
constexpr double kNothing = 1e-28;

TEST(Symmetry, a_symmetric_scene_stays_symmetric) {
  for (const char* law : {"friction={coefficient: 0.3}", "friction={coefficient: 0.3, regularization: 2.0e-3}",
                          "friction=null", "base.recovery=true"}) {
    const Scene scene = test::scene_of(straight, {law});
    long flat = 0;
    const TrialResult result = run(
        scene,
        [&](const Segment& g) {
          ASSERT_LT(std::abs(g.end.x), kNothing);
          ASSERT_LT(std::abs(g.end.phi), kNothing);
          ASSERT_LT(std::abs(g.end.vx), kNothing);
          ASSERT_LT(std::abs(g.end.omega), kNothing);
          const bool one = g.contacts[static_cast<std::size_t>(Site::b1_floor)].touching();
          const bool other = g.contacts[static_cast<std::size_t>(Site::b2_floor)].touching();
          ASSERT_EQ(one, other);
          flat += one;
        },
        20.0);
    EXPECT_GT(flat, 100) << law;
    EXPECT_EQ(result.impacts[2], result.impacts[3]);
    EXPECT_GT(result.impacts[2], 3);
    EXPECT_EQ(result.peak_force[2], result.peak_force[3]);
  }
}

// Shaken along x while it stands flat on the floor with both corners: they share the load and slip together.
TEST(Symmetry, two_corners_on_the_floor_share_the_friction) {
  // the tilt is held, so that both corners carry the same
  const Scene scene =
      test::scene_of(straight, {"part.inertia=null", "initial.y=0.63", "gripper.anchor.y=-0.2", "initial.x=0",
                                "excitation={amplitude: 0.1, frequency: 3, direction: x}", "friction.coefficient=0.4",
                                "trial.aligned_depth=0.29"});
  run(
      scene,
      [&](const Segment& g) {
        if (HasFailure() || g.loaded_count != 2 || g.loaded[0].normal_force[0] < 0.01) return;
        ASSERT_NEAR(g.loaded[0].normal_force[0], g.loaded[1].normal_force[0], 1e-9);
        ASSERT_EQ(g.contacts[static_cast<std::size_t>(Site::b1_floor)].slip,
                  g.contacts[static_cast<std::size_t>(Site::b2_floor)].slip);
        const double one = g.loaded[0].tangential_force[0], other = g.loaded[1].tangential_force[0];
        ASSERT_NEAR(one, other, 1e-3 * (std::abs(one) + std::abs(other)) + 1e-9) << "at " << g.start.value();
      },
      10.0);
}

}  // namespace
}  // namespace vibratory_alignment
