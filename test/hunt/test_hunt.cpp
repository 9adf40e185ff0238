// The hunt: its answers do not depend on the number of threads, bit for bit, and a change of one answer shows.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>

#include "../support/scenes.h"
#include "answer_checks.h"
#include "hunt.h"
#include "mechanics/system.h"
#include "model/scene_loader.h"
#include "random_scene.h"
#include "trace.h"
#include "verdict.h"

namespace vibratory_alignment::hunt {
namespace {

Tally tally_of(Range range, int threads, long count, bool changes = false) {
  HuntOptions options;
  options.changes = changes;
  options.range = range;
  options.count = count;
  options.threads = threads;
  Hunt hunt(options, [](std::uint64_t seed, const Verdict& verdict) {
    ADD_FAILURE() << "seed " << seed << ": " << verdict.faults.front().detail;
  });
  while (!hunt.done()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return hunt.tally();
}

TEST(Hunt, gives_the_same_bits_in_any_number_of_threads) {
  for (const Range range : {Range::ordinary, Range::wild, Range::round}) {
    const Tally alone = tally_of(range, 1, 60), together = tally_of(range, 3, 60);
    EXPECT_EQ(alone.digest, together.digest);
    EXPECT_EQ(alone.outcomes, together.outcomes);
    EXPECT_EQ(alone.scenes, 60);
    EXPECT_EQ(together.scenes, 60);
  }
}

TEST(Hunt, with_changes_gives_other_answers_and_the_same_bits_in_any_number_of_threads) {
  const Tally alone = tally_of(Range::ordinary, 1, 60, true), together = tally_of(Range::ordinary, 3, 60, true);
  EXPECT_EQ(alone.digest, together.digest);
  EXPECT_NE(alone.digest, tally_of(Range::ordinary, 1, 60).digest);
}

// A force whose series is cut off where it hardly matters to the motion, rates that are compared while the part is at
// rest, and a force that damping makes of the last digits of a fast motion and of a stiff gripper.
TEST(Hunt, does_not_take_the_digits_of_an_answer_for_faults) {
  for (const std::uint64_t seed : {532823u, 582117u, 682928u}) {
    const Verdict verdict = judge(random_scene(seed, Range::wild), Range::wild);
    EXPECT_FALSE(verdict.sensitive) << seed;
    for (const Fault& fault : verdict.faults) ADD_FAILURE() << "seed " << seed << ": " << fault.detail;
  }
}

// Implicit steps that were cut short by an event: points left inside the base, forces on the wrong side of their
// limits, equations that a shorter step did not solve, steps so short that their powers overflow or nothing moves; and
// rings passed over whose speed was not small.
TEST(Hunt, finds_nothing_any_more_in_what_implicit_steps_broke) {
  for (const std::uint64_t seed : {3029u,  7091u,  10850u, 16863u, 22188u, 27714u, 30516u, 44066u, 44107u,  52378u,
                                   54873u, 58030u, 58595u, 70590u, 82783u, 85735u, 97402u, 99760u, 111664u, 117582u})
    for (const char* solver : {"implicit", "auto"}) {
      Scene scene = random_scene(seed, Range::ordinary);
      scene.solver.name = solver;
      scene.solver.tolerance = std::max(scene.solver.tolerance, 1e-10);
      const Verdict verdict = judge(scene, Range::ordinary);
      for (const Fault& fault : verdict.faults) ADD_FAILURE() << solver << ", seed " << seed << ": " << fault.detail;
      EXPECT_EQ(verdict.refusal, "") << solver << ", seed " << seed;
    }
}

TEST(Tally, tells_answers_apart_but_not_their_order) {
  Verdict one, other;
  one.digest = 1;
  other.digest = 2;
  Tally a, b, c;
  a.add(10, one), a.add(11, other);
  b.add(11, other), b.add(10, one);
  c.add(10, other), c.add(11, one);
  EXPECT_EQ(a.digest, b.digest);
  EXPECT_NE(a.digest, c.digest);
}

TEST(Tally, counts_what_was_met) {
  Verdict failed, refused, without_start;
  failed.outcome = Outcome::aligned;
  failed.faults = {{Invariant::mirror, ""}, {Invariant::mirror, ""}, {Invariant::ends, ""}};
  refused.outcome = Outcome::failed;
  refused.refusal = "step limit";
  without_start.has_start = false;
  Tally tally;
  tally.add(0, failed), tally.add(1, refused), tally.add(2, without_start);
  EXPECT_EQ(tally.scenes, 3);
  EXPECT_EQ(tally.failed, 1);
  EXPECT_EQ(tally.without_start, 1);
  EXPECT_EQ(tally.refusals.at("step limit"), 1);
  EXPECT_EQ(tally.outcomes[static_cast<std::size_t>(Outcome::aligned)], 1);
  EXPECT_EQ(tally.outcomes[static_cast<std::size_t>(Outcome::failed)], 0);
  EXPECT_EQ(tally.faults[static_cast<std::size_t>(Invariant::mirror)], 1);
  EXPECT_NE(summary(tally, Range::wild).find("refused: step limit"), std::string::npos);
}

// Seed 0 is sound: to call it an open fault is a mistake that shows.
TEST(Hunt, tells_when_an_open_fault_is_mended) {
  HuntOptions options;
  options.count = 1;
  options.open = {0};
  Hunt hunt(options, [](std::uint64_t, const Verdict&) {});
  while (!hunt.done()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(hunt.tally().failed, 1);
  EXPECT_EQ(hunt.tally().open, 0);
}

// A part that is pushed to the right only: judged together with its mirror image, all is well; it never throws.
TEST(Judge, passes_a_sound_scene_and_refuses_one_without_start) {
  Scene scene = test::scene_of(test::plain);
  const Verdict verdict = judge(scene, Range::ordinary);
  EXPECT_TRUE(verdict.has_start);
  EXPECT_TRUE(verdict.faults.empty());
  EXPECT_FALSE(verdict.sensitive);
  scene.solver.name = "no such solver";
  EXPECT_TRUE(judge(scene, Range::ordinary).breaks(Invariant::ends));
  scene = test::scene_of(test::plain);
  scene.initial.x = 10.0;  // nothing can be touched from above there
  EXPECT_FALSE(judge(scene, Range::ordinary).has_start);
}

// With a fixed step points pass unnoticed for a while, and the ledger does not close.
TEST(Judge, finds_what_a_coarse_solver_breaks) {
  Scene scene = test::scene_of(test::plain);
  scene.solver.name = "rk4";
  scene.solver.step = 1e-3;
  const Verdict verdict = judge(scene, Range::ordinary);
  EXPECT_TRUE(verdict.breaks(Invariant::no_passing));
  EXPECT_TRUE(verdict.breaks(Invariant::ledger_closes));
}

// What an implicit step leaves of a ring decides whether a corner that is let go hops once more, here by 1e-15: no
// touch that methods could agree on. Unmerged it makes another number of touches.
TEST(Judge, counts_no_touch_after_a_hop_below_the_tolerance) {
  int hops = 0;
  for (const double pressing_force : {0.62, 0.66, 0.68, 0.7})
    for (const double phi : {-3.0, -2.9, -2.8}) {
      Scene scene = load_scene_file(MENDED_FAULTS "/hop_below_the_tolerance.yaml");
      scene.gripper.pressing_force = pressing_force;
      scene.initial.phi = phi;
      EXPECT_TRUE(judge(scene, Range::ordinary).faults.empty());
      const System system = make_system(scene);
      const Trace merged = run_trial(scene, false, 1.0), whole = run_trial(scene, false, 0.0);
      scene.solver.name = "event";
      const Trace expected = run_trial(scene, false, 1.0), whole_expected = run_trial(scene, false, 0.0);
      EXPECT_LT(difference(system, merged, expected, Compared::places), 1e-6);
      hops += difference(system, whole, whole_expected, Compared::places) == INFINITY;
      // hops that are higher count
      EXPECT_EQ(merged.touches.size(), expected.touches.size());
    }
  EXPECT_GT(hops, 1);
}

// The part comes level: which corner touches first, and 1e-11 earlier than the other one, is rounding.
TEST(Judge, counts_touches_of_a_level_part_as_one) {
  Scene scene = load_scene_file(MENDED_FAULTS "/level_landing.yaml");
  scene.solver.name = "event";
  EXPECT_EQ(run_trial(scene, false, 0.0).touches.size(), 2u);
  EXPECT_EQ(run_trial(scene, false, 1.0).touches.size(), 1u);
  scene.initial.phi = 1e-5;  // not so level
  EXPECT_EQ(run_trial(scene, false, 0.0).touches.size(), run_trial(scene, false, 1.0).touches.size());
}

// Of a base that is still deformed the hop is measured from there: the part is 3e-5 away when it comes back.
TEST(Judge, measures_a_hop_from_the_deformed_base) {
  Scene scene = load_scene_file(MENDED_FAULTS "/hop_from_a_deformed_base.yaml");
  for (const char* solver : {"event", "implicit"}) {
    scene.solver.name = solver;
    EXPECT_EQ(run_trial(scene, false, 10.0).touches.size(), 4u) << solver;
  }
}

TEST(Judge, takes_a_solver_that_gives_up_for_a_fault_in_ordinary_scenes) {
  Scene scene = test::scene_of(test::plain);
  scene.excitations[0].amplitude = 1e300;  // the motion is no longer finite
  EXPECT_TRUE(judge(scene, Range::ordinary).breaks(Invariant::ends));
  EXPECT_FALSE(judge(scene, Range::wild).breaks(Invariant::ends));
}

// Rounding decides how these go on; so do starts that differ in the last digits, not every pair of them. In which
// scenes it is so changes with the last digits of the solver: one is enough.
TEST(Judge, tells_rounding_from_a_broken_mirror) {
  int sensitive = 0;
  for (const std::uint64_t seed : {655205u, 665442u, 665555u, 670323u, 672859u}) {
    const Verdict verdict = judge(random_scene(seed, Range::wild), Range::wild);
    EXPECT_TRUE(verdict.faults.empty()) << seed;
    sensitive += verdict.sensitive;
  }
  EXPECT_GT(sensitive, 0);
}

// Sites of which none is the nearest, because they are equally near or all out of reach, and an outcome one of whose
// conditions is about to hold: the mirror image of a flight that finds its landing from afar is the same to the last
// bit.
TEST(Judge, sees_a_flight_and_its_mirror_image_land_alike) {
  for (const std::uint64_t seed : {5532u, 15389u, 16259u}) {
    const Verdict verdict = judge(random_scene(seed, Range::wild), Range::wild);
    EXPECT_TRUE(verdict.faults.empty()) << seed;
    EXPECT_FALSE(verdict.sensitive) << seed;
  }
}

}  // namespace
}  // namespace vibratory_alignment::hunt
