// A trial whose settings change between samples.
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "node/trial_run.h"
#include "small_scene.h"

namespace vibratory_alignment {
namespace {

constexpr double kInterval = 0.01;

bool same_bits(const State& a, const State& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

std::vector<Sample> all_samples(TrialRun& run) {
  std::vector<Sample> samples;
  for (Sample sample; run.next(sample);) samples.push_back(sample);
  return samples;
}

void skip(TrialRun& run, int count) {
  Sample sample;
  for (int i = 0; i < count; ++i) ASSERT_TRUE(run.next(sample));
}

TEST(TrialRun, UndisturbedIsThePlainTrialBitForBit) {
  const Scene scene = small_scene::load();
  Simulation simulation(scene);
  Sampler sampler(simulation, kInterval);
  TrialRun run(scene, kInterval);
  Sample expected, sample;
  int count = 0;
  while (sampler.next(expected)) {
    ASSERT_EQ(run.next_time(), std::min(count * kInterval, run.next_time()));
    ASSERT_TRUE(run.next(sample));
    EXPECT_EQ(sample.time, expected.time);
    EXPECT_TRUE(same_bits(sample.state, expected.state)) << sample.time;
    EXPECT_EQ(run.time(), sample.time);
    ++count;
  }
  EXPECT_TRUE(run.ended());
  EXPECT_FALSE(run.next(sample));
  EXPECT_GT(count, 100);
}

TEST(TrialRun, ChangeEntersAtTheLastSample) {
  const Scene scene = small_scene::load();
  TrialRun plain(scene, kInterval), changed(scene, kInterval);
  Sample a, b;
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(plain.next(a) && changed.next(b));
    ASSERT_TRUE(same_bits(a.state, b.state));
  }
  std::vector<Excitation> excitations = scene.excitations;
  excitations[0].amplitude = 0.0;
  changed.set_excitations(excitations);
  ASSERT_TRUE(plain.next(a) && changed.next(b));
  EXPECT_EQ(a.time, b.time);
  // A force that is missing for dt leaves no more than dt F behind in the velocity.
  EXPECT_NE(a.state.vy, b.state.vy);
  EXPECT_NEAR(a.state.vy, b.state.vy, kInterval * 1.0);
}

// A sample that is many segments away is given up for now; what changes then enters where the motion has come to.
TEST(TrialRun, ChangeEntersWhereASampleWasHeld) {
  Scene scene = small_scene::load();
  scene.solver.name = "rk4";
  scene.solver.step = 1e-5;
  TrialRun run(scene, 0.1);
  Sample sample;
  ASSERT_TRUE(run.next(sample));
  for (int i = 0; i < 3; ++i) ASSERT_FALSE(run.next(sample, [] { return false; }));
  EXPECT_FALSE(run.ended());
  EXPECT_EQ(run.time(), 0.0);
  std::vector<Excitation> excitations = scene.excitations;
  excitations[0].amplitude = 0.0;
  run.set_excitations(excitations);
  ASSERT_TRUE(run.next(sample));
  EXPECT_EQ(sample.time, 0.1);
  // 3000 steps with the excitation, 7000 without
  Simulation other(scene);
  while (other.time() < 0.03 - 1e-9) ASSERT_TRUE(other.advance());
  other.cut(0.03);
  other.set_excitations(excitations);
  while (other.segment().end_time() < 0.1 - 1e-12) ASSERT_TRUE(other.advance());
  EXPECT_NEAR(sample.state.y, other.segment().end.y, 1e-6);
  TrialRun shaken(scene, 0.1);
  skip(shaken, 1);
  Sample undisturbed;
  ASSERT_TRUE(shaken.next(undisturbed));
  EXPECT_GT(std::abs(sample.state.y - undisturbed.state.y), 1e-5);
}

// ... also where it has come to a segment that lasts beyond the next sample, and where another change follows in it. A
// part that nothing shakes keeps its energy about the anchor.
TEST(TrialRun, ChangesInALongFlightEnterAtOnceAndStay) {
  const Scene scene = load_scene(YAML::Load(R"(
part: {half_width: 0.6, base_distance: 0.9}
slot: {clearance: 0.09}
gripper: {anchor: {y: 6.0}}
base: {stiffness: {y: 1.0e4}}
contacts: [edges]
excitation: {amplitude: 1.0, frequency: 0.3}
initial: {x: 0.2, y: 6.0, phi: 0.0}
trial: {time_limit: 100.0}
)"),
                                 "flight");
  TrialRun run(scene, 3.0), plain(scene, 3.0);
  Sample sample, of_plain;
  while (run.next(sample, {}, 20.5)) {
  }
  while (plain.time() < 21.0) ASSERT_TRUE(plain.next(of_plain));
  std::vector<Excitation> none = scene.excitations;
  none[0].amplitude = 0.0;
  run.set_excitations(none);
  ASSERT_TRUE(run.next(sample));
  ASSERT_EQ(sample.time, of_plain.time);
  EXPECT_NE(sample.state.vy, of_plain.state.vy);
  run.set_pressing_force(-5.1);
  const double anchor = 0.9 + 5.1;  // where it touches level, less the press
  double least = HUGE_VAL, most = 0.0;
  while (run.next(sample)) {
    const double stretch = sample.state.y - anchor;
    const double energy = 0.5 * (sample.state.vy * sample.state.vy + stretch * stretch);
    least = std::min(least, energy);
    most = std::max(most, energy);
  }
  EXPECT_GT(sample.time, 60.0);
  EXPECT_LT(most - least, 1e-9);
}

TEST(TrialRun, SameExcitationsAgainChangeNothingButRoundoff) {
  const Scene scene = small_scene::load();
  TrialRun plain(scene, kInterval), changed(scene, kInterval);
  skip(plain, 30);
  skip(changed, 30);
  changed.set_excitations(scene.excitations);
  Sample a, b;
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(plain.next(a) && changed.next(b));
    EXPECT_NEAR(a.state.y, b.state.y, 1e-9);
  }
}

TEST(TrialRun, PhaseIsContinuousWhenTheFrequencyChanges) {
  // No contact: y'' + y = sin(theta). Over one short interval the force is continuous, so vy has no kink: its second
  // difference stays small, while a jump of the phase by order 1 would give kInterval * order 1.
  Scene scene = small_scene::load();
  scene.gripper.pressing_force.reset();
  scene.gripper.anchor_y = scene.initial.y = 6.0;
  scene.initial.phi = 0.0;
  TrialRun run(scene, kInterval);
  std::vector<double> vy;
  Sample sample;
  std::vector<Excitation> excitations = scene.excitations;
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(run.next(sample));
    vy.push_back(sample.state.vy);
    if (i == 40) {
      excitations[0].frequency = 17.0;
      run.set_excitations(excitations);
    }
  }
  for (std::size_t i = 2; i < vy.size(); ++i) {
    EXPECT_LT(std::abs(vy[i] - 2.0 * vy[i - 1] + vy[i - 2]), kInterval * kInterval * (20.0 + 6.0)) << i;
  }
}

TEST(TrialRun, PressingForceMovesTheAnchor) {
  const Scene scene = small_scene::load();
  TrialRun weak(scene, kInterval), strong(scene, kInterval);
  skip(weak, 10);
  skip(strong, 10);
  strong.set_pressing_force(5.0);
  Sample a, b;
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(weak.next(a) && strong.next(b));
  EXPECT_LT(b.state.y, a.state.y);
}

TEST(TrialRun, ResultSoFarIsThatOfATrialWhichEndsThere) {
  TrialRun run(small_scene::load(), kInterval);
  skip(run, 151);
  const TrialResult so_far = run.result();
  EXPECT_EQ(so_far.outcome, Outcome::running);
  // a step may begin elsewhere: equal up to the solver's tolerance
  TrialRun whole(small_scene::load(small_scene::path, {"trial.time_limit=1.5"}), kInterval);
  all_samples(whole);
  const TrialResult expected = whole.result();
  EXPECT_EQ(expected.final_time, 1.5);
  EXPECT_NEAR(so_far.final_time, 1.5, 1e-12);
  EXPECT_NEAR(so_far.final_state.y, expected.final_state.y, 1e-6);
  EXPECT_EQ(so_far.impacts, expected.impacts);
  EXPECT_EQ(so_far.mode, expected.mode);
  EXPECT_GT(expected.peak_force[0], 0.0);
  for (std::size_t i = 0; i < kSpotCount; ++i) EXPECT_NEAR(so_far.peak_force[i], expected.peak_force[i], 1e-6);
}

TEST(TrialRun, RestartRepeatsTheTrialBitForBit) {
  TrialRun run(small_scene::load(), kInterval);
  const std::vector<Sample> first = all_samples(run);
  run.restart();
  EXPECT_FALSE(run.ended());
  const std::vector<Sample> second = all_samples(run);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) ASSERT_TRUE(same_bits(first[i].state, second[i].state));
}

TEST(TrialRun, RestartIsAsIfTheSceneHadTheChangedValues) {
  TrialRun run(small_scene::load(), kInterval);
  skip(run, 10);
  std::vector<Excitation> excitations = small_scene::load().excitations;
  excitations[0].amplitude = 1.5;
  run.set_excitations(excitations);
  run.set_pressing_force(0.3);
  skip(run, 10);
  run.restart();
  TrialRun expected(small_scene::load(small_scene::path, {"excitation.amplitude=1.5", "gripper.pressing_force=0.3"}),
                    kInterval);
  Sample a, b;
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(run.next(a) && expected.next(b));
    ASSERT_TRUE(same_bits(a.state, b.state));
  }
}

TEST(TrialRun, RestartMayHaveOtherLimits) {
  Scene scene = small_scene::load();
  scene.trial.time_limit = 0.5;
  scene.trial.force_limit = 1e-3;
  TrialRun run(scene, kInterval);
  all_samples(run);
  EXPECT_TRUE(run.result().force_limit_exceeded);
  TrialSettings limits = scene.trial;
  limits.time_limit = 0.75;
  limits.force_limit.reset();
  run.restart(limits);
  EXPECT_EQ(all_samples(run).back().time, 0.75);
  EXPECT_FALSE(run.result().force_limit_exceeded);
}

TEST(TrialRun, EndsWithoutASampleWhereItsFirstStepFails) {
  Scene scene = small_scene::load();
  scene.excitations[0].frequency = 1e100;
  TrialRun run(scene, kInterval);
  Sample sample;
  EXPECT_FALSE(run.next(sample));
  EXPECT_TRUE(run.ended());
  const TrialResult result = run.result();
  EXPECT_EQ(result.outcome, Outcome::failed);
  EXPECT_EQ(result.final_time, 0.0);
  EXPECT_FALSE(result.failure.empty());
}

TEST(TrialRun, RestartThatIsImpossibleLeavesTheTrialAsItWas) {
  TrialRun run(small_scene::load(), kInterval);
  skip(run, 10);
  run.set_pressing_force(-5.0);  // pulled up: no equilibrium on the base
  EXPECT_THROW(run.restart(), SceneError);
  Sample sample;
  EXPECT_TRUE(run.next(sample));
  EXPECT_EQ(sample.time, 10 * kInterval);
}

}  // namespace
}  // namespace vibratory_alignment
