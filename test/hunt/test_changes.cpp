// Changes in the run: of every kind, the same for the same seed, made where they are said to be, and written as a file
// that is read back bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "../support/scenes.h"
#include "answer_checks.h"
#include "model/scene.h"
#include "model/scene_error.h"
#include "random_changes.h"
#include "random_scene.h"
#include "scene_text.h"
#include "trace.h"
#include "verdict.h"

namespace vibratory_alignment::hunt {
namespace {

Trial random_trial(std::uint64_t seed, Range range) {
  const Scene scene = random_scene(seed, range);
  return {scene, random_changes(seed, scene)};
}

/// Ends of all segments of the trial.
std::set<double> ends_of(const Trial& trial) {
  std::set<double> ends;
  Simulation simulation(trial.scene);
  Changer changer(trial.changes);
  while (simulation.advance()) {
    changer.make_due(simulation);
    ends.insert(simulation.segment().end_time());
  }
  return ends;
}

std::string written(const std::string& text) {
  const std::string path = testing::TempDir() + "va_hunt_changes.yaml";
  std::ofstream(path) << text;
  return path;
}

TEST(RandomChanges, call_for_everything_there_is) {
  for (const Range range : {Range::ordinary, Range::wild, Range::round}) {
    int cuts_alone = 0, late = 0, presses = 0, no_press = 0, off = 0, fewer = 0, at_once = 0, tiny = 0, both = 0,
        others = 0;
    std::set<Waveform> waveforms;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
      const Trial trial = random_trial(seed, range);
      double last = -1.0;
      for (const Change& c : trial.changes) {
        EXPECT_GE(c.time, last) << seed;
        at_once += c.time == last;
        tiny += c.time > last && c.time <= last + 2e-12;
        last = c.time;
        late += c.cut_late;
        cuts_alone += !c.excitations && !c.pressing_force;
        both += c.excitations && c.pressing_force;
        presses += c.pressing_force.has_value();
        no_press += c.pressing_force && *c.pressing_force == 0.0;
        if (!c.excitations) continue;
        fewer += c.excitations->size() < trial.scene.excitations.size();
        for (std::size_t i = 0; i < c.excitations->size(); ++i) {
          const Excitation& e = (*c.excitations)[i];
          off += e.amplitude == 0.0;
          others += e.waveform != trial.scene.excitations[i].waveform;
          waveforms.insert(e.waveform);
        }
      }
    }
    for (const int count : {cuts_alone, late, presses, no_press, off, fewer, at_once, tiny, both, others})
      EXPECT_GT(count, 5);
    EXPECT_EQ(waveforms.size(), 4u);
  }
}

TEST(RandomChanges, lie_at_events_of_the_changed_motion) {
  int at_events = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Trial trial = random_trial(seed, Range::ordinary);
    if (trial.changes.empty()) continue;
    Simulation simulation(trial.scene);
    Changer changer(trial.changes);
    while (simulation.advance()) {
      at_events += simulation.segment().event_count > 0 && changer.next_time() == simulation.segment().end_time();
      changer.make_due(simulation);
    }
  }
  EXPECT_GT(at_events, 20);
}

TEST(RandomChanges, are_the_same_for_the_same_seed) {
  const Scene scene = random_scene(3, Range::ordinary);
  const auto text = [&](std::uint64_t seed) { return trial_text({scene, random_changes(seed, scene)}); };
  EXPECT_EQ(text(3), text(3));
  EXPECT_NE(text(3), text(4));
}

TEST(RandomChanges, are_none_where_nothing_starts) {
  Scene scene = test::scene_of(test::plain);
  scene.initial.x = 10.0;  // nothing can be touched from above there
  EXPECT_TRUE(random_changes(0, scene).empty());
}

class ChangedTrial : public testing::Test {
 protected:
  static constexpr double kCut = 0.31234, kChange = 0.71234;

  /// The trial is cut twice at one instant, and changed at a later one after its first touch.
  Trial changed() const {
    Trial trial = scene_;
    trial.changes.resize(3);
    trial.changes[0].time = trial.changes[1].time = kCut;
    trial.changes[2].time = kChange;
    trial.changes[2].excitations = scene_.excitations;
    trial.changes[2].excitations->at(0).amplitude *= 0.5;
    return trial;
  }

  Scene scene_ = test::scene_of(test::plain);
  System system_ = make_system(scene_);
};

TEST_F(ChangedTrial, is_cut_where_it_is_changed) {
  for (const bool late : {false, true}) {
    Trial trial = changed();
    for (Change& change : trial.changes) change.cut_late = late;
    const std::set<double> ends = ends_of(trial), alone = ends_of(scene_);
    for (const double time : {kCut, kChange}) {
      EXPECT_EQ(ends.count(time), 1u) << late;
      EXPECT_EQ(alone.count(time), 0u);
    }
  }
}

TEST_F(ChangedTrial, is_changed_from_there_on) {
  const Trace alone = run_trial(scene_, true), trace = run_trial(changed(), true);
  EXPECT_FALSE(trace.fault);
  ASSERT_LT(alone.touches.front().time, kChange);
  EXPECT_LT(std::abs(trace.touches.front().time - alone.touches.front().time), 1e-9);
  EXPECT_GT(std::abs(trace.result.final_state.x - alone.result.final_state.x), 1e-6);
  // a change that has been made late and cut again is the same change
  Trial late = changed();
  late.changes[2].cut_late = true;
  EXPECT_LT(difference(system_, trace, run_trial(late, true), Compared::places_and_rates), 1e-7);
}

TEST_F(ChangedTrial, changes_its_press) {
  Trial trial = scene_;
  const Trace alone = run_trial(trial, true);
  trial.changes.resize(1);
  trial.changes[0].time = 0.3;
  trial.changes[0].pressing_force = 0.1;
  const Trace trace = run_trial(trial, true);
  EXPECT_GT(std::abs(trace.result.final_state.y - alone.result.final_state.y), 1e-6);
  EXPECT_FALSE(check_energy(trial.scene, trace));
}

TEST_F(ChangedTrial, is_the_same_when_it_is_sampled) {
  const Trial trial = changed();
  EXPECT_FALSE(check_same(run_trial(trial, false).result, run_sampled(trial, 0.07, true)));
  EXPECT_TRUE(check_same(run_trial(trial, false).result, run_sampled(scene_, 0.07, true)));
}

// To the other side pushes what pushed to this one.
TEST_F(ChangedTrial, has_a_mirror_image) {
  Trial trial = changed();
  trial.changes[2].excitations->at(0).direction = Direction::x;
  const Trial image = mirrored(trial);
  EXPECT_EQ(image.changes[2].excitations->at(0).amplitude, -trial.changes[2].excitations->at(0).amplitude);
  EXPECT_EQ(trial_text(mirrored(image)), trial_text(trial));
  const Trace trace = run_trial(trial, true);
  EXPECT_LT(difference(system_, trace, mirrored(run_trial(image, false)), Compared::places_and_rates), 1e-9);
  Trial half = image;
  half.changes = trial.changes;
  EXPECT_GT(difference(system_, trace, mirrored(run_trial(half, false)), Compared::places_and_rates), 1e-6);
}

TEST_F(ChangedTrial, breaks_nothing) {
  const Verdict verdict = judge(changed(), Range::ordinary);
  for (const Fault& fault : verdict.faults) ADD_FAILURE() << to_string(fault.invariant) << ": " << fault.detail;
  EXPECT_FALSE(verdict.sensitive);
  EXPECT_NE(verdict.digest, judge(scene_, Range::ordinary).digest);
}

// Of a fixed step a cut makes two others.
TEST_F(ChangedTrial, is_found_to_be_another_where_cuts_are_not_neutral) {
  Trial trial = changed();
  trial.scene.solver.name = "semi_implicit";
  trial.scene.solver.step = 1e-3;
  trial.changes[2].time = 0.63456;  // in contact
  const Verdict verdict = judge(trial, Range::ordinary);
  EXPECT_TRUE(verdict.breaks(Invariant::cuts));
  EXPECT_TRUE(verdict.breaks(Invariant::same_settings));
  trial.changes.clear();
  EXPECT_FALSE(judge(trial, Range::ordinary).breaks(Invariant::cuts));
}

// Left alone the part is found to be at rest before the time limit; watched from the change on it is not.
TEST(Judge, lets_a_change_restart_the_watch_for_settling) {
  Trial trial = load_trial_file(written(R"(
name: ordinary_5608
units: dimensionless
part: {half_width: 1, base_distance: 1}
slot: {clearance: 0.004}
gripper: {stiffness: {}, anchor: {x: 0, phi: 0}, pressing_force: 1}
base: {stiffness: {x: 1, y: 1}}
contacts: [edges]
excitation: {amplitude: 1, frequency: 40, direction: x}
initial: {x: 0, phi: -0.1}
trial: {time_limit: 4}
changes: [{time: 2.881592628856984}]
)"));
  EXPECT_TRUE(judge(trial, Range::ordinary).faults.empty());
  EXPECT_EQ(run_trial(trial, false).result.outcome, Outcome::stalled);
  trial.changes[0].excitations = trial.scene.excitations;
  EXPECT_EQ(run_trial(trial, false).result.outcome, Outcome::time_limit);
}

TEST(TrialText, is_read_back_bit_for_bit) {
  for (const Range range : {Range::ordinary, Range::wild, Range::round})
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      const Trial trial = random_trial(seed, range);
      const std::string text = trial_text(trial);
      const Trial read = load_trial_file(written(text));
      EXPECT_EQ(trial_text(read), text);
      EXPECT_EQ(read.changes.size(), trial.changes.size());
      for (std::size_t i = 0; i < read.changes.size(); ++i) {
        EXPECT_EQ(read.changes[i].time, trial.changes[i].time);
        EXPECT_EQ(read.changes[i].pressing_force, trial.changes[i].pressing_force);
        EXPECT_EQ(read.changes[i].cut_late, trial.changes[i].cut_late);
        EXPECT_EQ(read.changes[i].excitations.has_value(), trial.changes[i].excitations.has_value());
      }
    }
}

TEST(TrialText, is_that_of_the_scene_where_nothing_changes) {
  const Scene scene = random_scene(1, Range::ordinary);
  EXPECT_EQ(trial_text(scene), scene_text(scene));
}

TEST(TrialText, with_faults_is_refused) {
  const std::string scene = scene_text(random_scene(1, Range::ordinary));
  for (const char* change : {"{time: soon}", "{pressing_force: 1}", "{time: 1, excitation: [{amplitude: 1}]}", "3"})
    EXPECT_THROW(load_trial_file(written(scene + "changes: [" + change + "]\n")), SceneError) << change;
}

}  // namespace
}  // namespace vibratory_alignment::hunt
