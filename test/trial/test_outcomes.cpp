// How trials end (MODEL.md "Outcome of a trial"): each outcome where its definition holds, and only there.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../support/cases.h"
#include "../support/random_scenes.h"
#include "../support/runs.h"
#include "../support/scenes.h"

namespace vibratory_alignment {
namespace {

using test::run;
using test::scene_of;

const std::string slips_down = R"(
part: {half_width: 0.673, base_distance: 0.9015, inertia: 0.149}
slot: {clearance: 0.09}
gripper: {stiffness: {x: 0.0147, phi: 7.3}, damping: {x: 0.011, y: 0.01, phi: 1.33}, pressing_force: 0.2}
base: {stiffness: {x: 3648.0, y: 7600.0}, damping: {x: 9.96, y: 20.75}}
contacts: [edges, corners]
friction: {coefficient: 0.319}
excitation: {amplitude: 1.0, frequency: 20.0}
initial: {x: 0.2, y: 0.895, phi: 0.025}
trial: {time_limit: 20.0, aligned_depth: 0.02}
)";

struct Corner {
  double x, y;
};
Corner corner(const Scene& s, const State& q, double side) {
  const double c = std::cos(q.phi), n = std::sin(q.phi), a = side * s.part.half_width, b = s.part.base_distance;
  return {q.x + a * c + b * n, q.y + a * n - b * c};
}

/// Between the walls and below `depth`; a corner that presses into a wall, as deep as its force says, counts.
void expect_aligned(const Scene& s, const State& q, double depth, double slack = 1e-12) {
  for (const double side : {1.0, -1.0}) {
    EXPECT_LE(corner(s, q, side).y, -depth + slack) << s.name;
    EXPECT_LE(std::abs(corner(s, q, side).x), s.slot_half_width() + slack) << s.name;
  }
}

TEST(Outcome, aligned_is_both_corners_in_the_slot_below_the_depth) {
  double before = 0.0;
  for (const double depth : {0.0, 0.02, 0.05, 0.1}) {
    Scene scene = scene_of(slips_down);
    scene.trial.aligned_depth = depth;
    const TrialResult result = run(scene);
    ASSERT_EQ(result.outcome, Outcome::aligned) << depth;
    ASSERT_TRUE(result.aligned_time);
    EXPECT_EQ(*result.aligned_time, result.final_time);
    expect_aligned(scene, result.final_state, depth);
    // it is the first such instant: the higher corner is just there, or one just between the walls
    const Corner right = corner(scene, result.final_state, 1.0), left = corner(scene, result.final_state, -1.0);
    const double below = std::abs(std::max(right.y, left.y) + depth);
    const double between = std::abs(std::max(std::abs(right.x), std::abs(left.x)) - scene.slot_half_width());
    EXPECT_LT(std::min(below, between), 1e-12);
    EXPECT_GT(result.final_time, before);
    before = result.final_time;
  }
}

// A part that lies on the base, its corner pressed into the top surface, is not in the slot.
TEST(Outcome, a_part_on_the_base_is_not_aligned) {
  const Scene scene = scene_of(
      test::plain, {"gripper={stiffness: {x: 9, phi: 60}, anchor: {x: 0.5, y: 0.8}}", "contacts=[edges, corners]",
                    "initial={x: 0.5, y: 0.96, phi: -0.004}", "trial.time_limit=5"});
  const TrialResult result = run(scene);
  EXPECT_NE(result.outcome, Outcome::aligned);
  EXPECT_FALSE(result.aligned_time);
}

TEST(Outcome, random_scenes_align_only_in_the_slot) {
  int aligned = 0;
  for (unsigned seed = 1; seed <= test::cases_of(150); ++seed) {
    Scene scene = test::random_scene(seed);
    scene.name = "seed " + std::to_string(seed);
    scene.slot.depth.reset();
    scene.contacts.walls = false;
    scene.trial.aligned_depth = 0.0;
    const TrialResult result = run(scene);
    if (result.outcome != Outcome::aligned) continue;
    ++aligned;
    expect_aligned(scene, result.final_state, 0.0);
  }
  EXPECT_GT(aligned, test::cases_of(50));
}

TEST(Outcome, until_goes_on_and_still_reports_the_duration) {
  const Scene scene = scene_of(slips_down);
  const TrialResult alone = run(scene), longer = run(scene, {}, 7.5);
  EXPECT_EQ(longer.outcome, Outcome::aligned);
  EXPECT_EQ(longer.final_time, 7.5);
  EXPECT_EQ(*longer.aligned_time, *alone.aligned_time);
  const TrialResult shorter = run(scene, {}, 1.5);
  EXPECT_EQ(shorter.outcome, Outcome::time_limit);
  EXPECT_EQ(shorter.final_time, 1.5);
  EXPECT_FALSE(shorter.aligned_time);
}

TEST(Outcome, time_limit_is_exact) {
  for (const double limit : {0.1, 1.0 / 3.0, 2.7182818}) {
    Scene scene = scene_of(slips_down);
    scene.trial.time_limit = limit;
    const TrialResult result = run(scene);
    EXPECT_EQ(result.outcome, Outcome::time_limit);
    EXPECT_EQ(result.final_time, limit);
  }
}

const std::vector<std::string> with_floor = {"contacts=[edges, corners, walls]", "slot.depth=0.3",
                                             "trial.time_limit=60"};

std::vector<std::string> with(std::vector<std::string> settings, const std::vector<std::string>& more) {
  settings.insert(settings.end(), more.begin(), more.end());
  return settings;
}

// The axial spring gives f0 - depth at the floor: with more than that the part reaches it.
TEST(Outcome, inserted_is_at_the_floor) {
  const Scene scene = scene_of(slips_down, with(with_floor, {"gripper.pressing_force=0.5"}));
  const TrialResult result = run(scene);
  ASSERT_EQ(result.outcome, Outcome::inserted);
  EXPECT_LT(*result.aligned_time, result.final_time);
  const double lower = std::min(corner(scene, result.final_state, 1.0).y, corner(scene, result.final_state, -1.0).y);
  EXPECT_NEAR(lower, -0.3, 1e-12);
}

TEST(Outcome, inserted_is_at_the_asked_depth) {
  const Scene scene = scene_of(
      slips_down, {"contacts=[edges, corners, walls]", "trial.inserted_depth=0.15", "gripper.pressing_force=0.5"});
  const TrialResult result = run(scene);
  ASSERT_EQ(result.outcome, Outcome::inserted);
  const double higher = std::max(corner(scene, result.final_state, 1.0).y, corner(scene, result.final_state, -1.0).y);
  EXPECT_NEAR(higher, -0.15, 1e-12);
  EXPECT_LT(*result.aligned_time, result.final_time);
}

// Too little force to get down to the floor: it hangs in the slot on its spring. That is jammed, not stalled.
TEST(Outcome, jammed_is_at_rest_in_the_slot_above_the_floor) {
  const Scene scene =
      scene_of(slips_down, with(with_floor, {"gripper.pressing_force=0.1", "gripper.damping={x: 0.5, y: 0.5, phi: 1.3}",
                                             "trial.time_limit=400", "slot.depth=0.5"}));
  const TrialResult result = run(scene);
  ASSERT_EQ(result.outcome, Outcome::jammed) << to_string(result.outcome);
  EXPECT_TRUE(result.aligned_time);
  expect_aligned(scene, result.final_state, 0.02, 1e-2);
  EXPECT_GT(corner(scene, result.final_state, 1.0).y, -0.5);
}

/// A part over its slot, with a little play.
const std::string fits = R"(
part: {half_width: 0.6, base_distance: 0.9, inertia: 0.2}
slot: {clearance: 0.09, depth: 0.5}
gripper: {stiffness: {x: 0.08, phi: 60.0}, damping: {x: 0.2, y: 0.5, phi: 0.3}, anchor: {x: 0.0, y: 1.5}}
base: {stiffness: {y: 1.0e4}, damping: {y: 20.0}}
contacts: [edges, walls]
friction: {coefficient: 0.2}
excitation: {amplitude: 0.0, frequency: 20.0}
initial: {x: 0.0, y: 0.95, phi: 0.0}
trial: {time_limit: 200.0, aligned_depth: 0.02}
)";

// A trial that starts on the floor, at balance, has no touch of it: it is inserted where it starts.
TEST(Outcome, inserted_is_what_stands_on_the_floor_from_the_start) {
  Scene scene = scene_of(fits, {"initial.y=null", "gripper.anchor.y=null", "gripper.pressing_force=0.5"});
  for (const char* solver : {"event", "implicit", "auto"}) {
    scene.solver.name = solver;
    const TrialResult result = run(scene);
    EXPECT_EQ(result.outcome, Outcome::inserted) << solver;
    EXPECT_EQ(result.final_time, 0.0) << solver;
    // the spring has given 2 k d of its 0.5
    EXPECT_NEAR(corner(scene, result.final_state, 1.0).y, -0.5 - 0.5 / (2e4 + 1.0), 1e-12) << solver;
  }
}

// It dips into the slot, comes out by its spring and rests above: aligned then, but not jammed in the slot.
TEST(Outcome, stalled_is_what_has_left_the_slot) {
  const Scene scene = scene_of(fits, {"initial.vy=-1.0"});
  const TrialResult result = run(scene);
  EXPECT_TRUE(result.aligned_time);
  EXPECT_GT(corner(scene, result.final_state, 1.0).y, 0.5);
  EXPECT_EQ(result.outcome, Outcome::stalled);
}

TEST(Outcome, stalled_is_at_rest_on_the_base) {
  const Scene scene = scene_of(
      slips_down, {"excitation.amplitude=0", "gripper.damping={x: 0.5, y: 0.5, phi: 1.3}", "trial.time_limit=400"});
  const TrialResult result = run(scene);
  EXPECT_EQ(result.outcome, Outcome::stalled);
  EXPECT_LT(result.final_time, 400.0);
  // nothing moves any more
  const State& q = result.final_state;
  EXPECT_LT(std::abs(q.vx) + std::abs(q.vy) + std::abs(q.omega), 1e-8);
}

TEST(Outcome, stalled_is_periodic_without_alignment) {
  // a ball on a shaken base, period-one
  const Scene scene = scene_of(
      test::ball, {"gripper={damping: {y: 0.2}, anchor: {y: 0.5}}", "excitation={amplitude: 1.0, frequency: 6.0}",
                   "base={stiffness: {y: 1.0e4}, damping: {y: 80}}", "trial.time_limit=1000"});
  const TrialResult result = run(scene);
  EXPECT_EQ(result.outcome, Outcome::stalled);
  EXPECT_LT(result.final_time, 900.0);
}

TEST(Outcome, failed_says_why_and_where) {
  Scene scene = scene_of(slips_down);
  scene.solver.step_limit = 20;
  const TrialResult result = run(scene);
  EXPECT_EQ(result.outcome, Outcome::failed);
  EXPECT_FALSE(result.failure.empty());
  EXPECT_GT(result.final_time, 0.0);
  EXPECT_FALSE(result.aligned_time);
  // a ball keeps its x and phi, and falls from 1.0
  const TrialResult ball = run(scene_of(test::ball, {"solver.step_limit=3"}));
  ASSERT_EQ(ball.outcome, Outcome::failed);
  EXPECT_NE(ball.failure.find(", x = 0.2, y = "), std::string::npos) << ball.failure;
  EXPECT_NE(ball.failure.find(", phi = 0"), std::string::npos) << ball.failure;
}

TEST(Outcome, force_limit_only_marks_the_result) {
  const TrialResult free = run(scene_of(slips_down));
  const double peak = *std::max_element(free.peak_force.begin(), free.peak_force.end());
  for (const double share : {0.999, 1.001}) {
    Scene scene = scene_of(slips_down);
    scene.trial.force_limit = share * peak;
    const TrialResult marked = run(scene);
    EXPECT_EQ(marked.force_limit_exceeded, share < 1.0);
    EXPECT_EQ(test::distance(marked.final_state, free.final_state), 0.0);
    EXPECT_EQ(marked.outcome, free.outcome);
  }
}

TEST(Outcome, names) {
  EXPECT_STREQ(to_string(Outcome::aligned), "aligned");
  EXPECT_STREQ(to_string(Outcome::inserted), "inserted");
  EXPECT_STREQ(to_string(Outcome::jammed), "jammed");
  EXPECT_STREQ(to_string(Outcome::stalled), "stalled");
  EXPECT_STREQ(to_string(Outcome::time_limit), "time_limit");
  EXPECT_STREQ(to_string(Outcome::failed), "failed");
  EXPECT_STREQ(to_string(Mode::impact), "impact");
  EXPECT_STREQ(to_string(Mode::nonimpact), "nonimpact");
  EXPECT_STREQ(to_string(Mode::mixed), "mixed");
}

}  // namespace
}  // namespace vibratory_alignment
