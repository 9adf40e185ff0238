// Chatter (hard/chatter): infinitely many bounces of a rigid ball in finite time; finitely many on a compliant base.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../support/hard_scene.h"
#include "../support/restitution.h"
#include "../support/runs.h"

namespace vibratory_alignment {
namespace {

constexpr double kHeight = 1e-3, kWeight = 1.0;

struct Chatter {
  double last_touch;
  int touches;
  std::size_t events;
};

Chatter chatter(double stiffness, const char* solver) {
  Scene scene = test::hard_scene("chatter");
  scene.solver.name = solver;
  test::set_base(scene, stiffness, 0.1);
  const std::vector<test::TimedEvent> events = test::events_of(scene, scene.trial.time_limit);
  Chatter c{0.0, 0, events.size()};
  for (const test::TimedEvent& e : events) {
    if (e.event.kind != EventKind::touch) continue;
    c.last_touch = e.time;
    ++c.touches;
  }
  return c;
}

/// Speed at the first touch, from y'' = -y - w.
double first_speed() { return std::sqrt(std::pow(kWeight + kHeight, 2) - kWeight * kWeight); }

/// When a rigid ball has come to rest: the fall, and flights of 2 atan(v/w) with v = e, e^2, ... of the first speed.
double rigid_time_of_rest() {
  double time = std::acos(kWeight / (kWeight + kHeight));
  const double e = test::linear_restitution(0.1);
  for (double v = e * first_speed(); v > 1e-18; v *= e) time += 2.0 * std::atan(v / kWeight);
  return time;
}

// What is cut off of the series, once the speed is lost in the sag, and the time in a contact are a few 1/sqrt(k).
TEST(Chatter, time_to_rest_tends_to_that_of_a_rigid_ball) {
  for (const char* solver : {"event", "implicit", "auto"})
    for (const double k : {1e4, 1e6, 1e8, 1e10, 1e12}) {
      const Chatter c = chatter(k, solver);
      EXPECT_NEAR(c.last_touch, rigid_time_of_rest(), (4.0 + 0.3 * c.touches) / std::sqrt(k)) << solver << ' ' << k;
    }
}

// It bounces until v e^n is about w/sqrt(k); the last ones are longer in contact than in flight, and lose more.
TEST(Chatter, bounces_finitely_often) {
  for (const char* solver : {"event", "implicit", "auto"})
    for (const double k : {1e4, 1e6, 1e8, 1e10, 1e12}) {
      const Chatter c = chatter(k, solver);
      const double bounces =
          std::log(first_speed() * std::sqrt(k) / kWeight) / std::log(1.0 / test::linear_restitution(0.1));
      EXPECT_LE(c.touches, bounces + 3.0) << solver << ' ' << k;
      EXPECT_GE(c.touches, bounces - 8.0) << solver << ' ' << k;
      // touch, release, close
      EXPECT_LE(c.events, 3u * static_cast<unsigned>(c.touches)) << solver << ' ' << k;
    }
}

// ... and then stays there, at rest under its load, which is an outcome.
TEST(Chatter, ends_in_lasting_contact) {
  Scene scene = test::hard_scene("chatter", {"trial.time_limit=1000"});
  test::set_base(scene, 1e4, 0.1);
  const TrialResult result = test::run(scene);
  EXPECT_EQ(result.outcome, Outcome::stalled) << result.failure;
  EXPECT_NEAR(result.final_state.y, 0.9 - kWeight / (1e4 + 1.0), 1e-12);
  EXPECT_LT(result.counts.events, 40);
}

}  // namespace
}  // namespace vibratory_alignment
