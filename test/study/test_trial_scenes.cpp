// The scenes of a study's trials: those that `align trial --set ...` has for the same values, in any order of the
// trials.
#include "study/trial_scenes.h"

#include <gtest/gtest.h>

#include <functional>
#include <sstream>

#include "model/scene.h"
#include "model/scene_error.h"
#include "study_text.h"

namespace vibratory_alignment {
namespace {

using test::scene_of;
using test::study_of;

/// The parts of a scene that the studies below vary.
std::string told(const Scene& scene) {
  std::ostringstream text;
  text.precision(17);
  text << scene.initial.x << ' ' << scene.gripper.anchor_x << ' ' << scene.gripper.pressing_force.value_or(-1) << ' '
       << scene.gripper.phi.stiffness << ' ' << scene.contacts.corners << ' ' << scene.friction.has_value() << ' '
       << (scene.friction ? scene.friction->coefficient : 0.0) << ' ' << scene.solver.name << ' '
       << scene.solver.tolerance << ' ' << scene.trial.time_limit;
  for (const Excitation& e : scene.excitations) text << ' ' << e.frequency << ' ' << e.phase << ' ' << e.amplitude;
  return text.str();
}

const std::string mixed = R"(
set: {gripper.stiffness.phi: 75, trial.time_limit: 2}
vary:
  - contacts: [[edges], [edges, corners]]
  - friction: [null, {coefficient: 0.1}, {coefficient: 0.4}]
  - {initial.x: [0.2, 0.3], gripper.pressing_force: [0.1, 0.2]}
  - solver.name: [event, implicit]
  - excitation.phase: {from: 0, to: 6}
samples: {count: 3}
)";

TEST(TrialScenes, AreThoseOfTheSameSettings) {
  const Study study = study_of(mixed);
  TrialScenes scenes(study);
  const std::vector<std::string> names = varied_names(study);
  for (std::size_t i = 0; i < trial_count(study); ++i) {
    std::vector<std::string> settings = {"gripper.stiffness.phi=75", "trial.time_limit=2"};
    const std::vector<VariedValue> values = values_at(study, i);
    for (std::size_t k = 0; k < values.size(); ++k) settings.push_back(names[k] + "=" + values[k].text);
    EXPECT_EQ(told(scenes.at(i)), told(scene_of(test::plain, settings))) << i;
  }
}

TEST(TrialScenes, DoNotDependOnTheOrder) {
  const Study study = study_of(mixed);
  TrialScenes forward(study), backward(study);
  std::vector<std::string> seen;
  for (std::size_t i = 0; i < trial_count(study); ++i) seen.push_back(told(forward.at(i)));
  for (std::size_t i = trial_count(study); i-- > 0;) EXPECT_EQ(told(backward.at(i)), seen[i]) << i;
}

TEST(TrialScenes, OffsetsAddToWhatTheTrialHasOtherwise) {
  // to a value of the scene, of `set`, and to one that is varied as well
  const Study plain = study_of("vary: {initial.x: {from: -0.02, to: 0.02, count: 3, as: offset}}");
  const Study set = study_of("set: {initial.x: 0.5}\nvary: {initial.x: {from: -0.02, to: 0.02, count: 3, as: offset}}");
  const Study both =
      study_of("vary: [{initial.x: {from: -0.02, to: 0.02, count: 3, as: offset}}, {initial.x: [0.3, 0.6]}]");
  TrialScenes a(plain), b(set), c(both);
  for (std::size_t i = 0; i < 3; ++i) {
    const double offset = -0.02 + 0.02 * static_cast<double>(i);
    EXPECT_DOUBLE_EQ(a.at(i).initial.x, 0.21 + offset);
    EXPECT_DOUBLE_EQ(b.at(i).initial.x, 0.5 + offset);
    EXPECT_DOUBLE_EQ(c.at(2 * i).initial.x, 0.3 + offset);
    EXPECT_DOUBLE_EQ(c.at(2 * i + 1).initial.x, 0.6 + offset);
  }
  EXPECT_DOUBLE_EQ(a.at(0).initial.x, 0.19) << "offsets do not add up";
}

TEST(TrialScenes, AnOffsetToNothingIsRefused) {
  EXPECT_THROW(study_of("vary: {initial.y: {from: 0, to: 1, count: 2, as: offset}}\nset: {initial.y: null}"),
               SceneError);
}

TEST(TrialScenes, LeaveWhatAnAliasSharesAlone) {
  std::string text = test::plain;
  text.replace(text.find("coefficient: 0.24"), 17, "coefficient: &shared 0.24");
  text += "weight: *shared\n";
  TrialScenes scenes(study_of("vary: [{friction.coefficient: [0.1, 0.2]}, {excitation.phase: [0, 1]}]", text));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(scenes.at(i).weight, 0.24);
  TrialScenes offsets(study_of("vary: {friction.coefficient: {from: 0.1, to: 0.2, count: 2, as: offset}}", text));
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(offsets.at(i).weight, 0.24);
}

TEST(TrialScenes, ARefusedOneDoesNotSpoilTheNext) {
  const Study study = study_of("vary: [{slot.clearance: [0.1, 0, 0.2]}, {solver.name: [event, nosuch, implicit]}]");
  TrialScenes scenes(study);
  EXPECT_EQ(scenes.at(0).slot.clearance, 0.1);
  EXPECT_THROW(scenes.at(1), SceneError);
  EXPECT_EQ(scenes.at(2).solver.name, "implicit");
  EXPECT_THROW(scenes.at(3), SceneError);
  EXPECT_EQ(scenes.at(6).slot.clearance, 0.2);
  // one that cannot even be put into the tree: there is no weight to add the offset to
  TrialScenes weights(study_of("vary: [{weight: [1, null]}, {weight: {from: 0, to: 1, count: 2, as: offset}}]"));
  EXPECT_EQ(weights.at(1).weight, 2.0);
  EXPECT_THROW(weights.at(2), SceneError);
  EXPECT_EQ(weights.at(1).weight, 2.0);
}

TEST(TrialScenes, NullIsFineWhereTheSceneHasNoSuchKey) {
  TrialScenes scenes(study_of("vary: [{solver.name: [event, rk4], solver.step: [null, 1.0e-4]}, {weight: [null, 1]}]"));
  EXPECT_FALSE(scenes.at(0).solver.step);
  EXPECT_EQ(scenes.at(0).weight, 0.0);
  EXPECT_EQ(scenes.at(1).weight, 1.0);
  EXPECT_EQ(scenes.at(2).solver.step, 1.0e-4);
}

TEST(TrialScenes, ReachIntoLists) {
  TrialScenes scenes(
      study_of("set: {excitation: [{amplitude: 1, frequency: 2}, {amplitude: 3, frequency: 4}]}\n"
               "vary: {excitation.1.frequency: [5, 6]}"));
  EXPECT_EQ(scenes.at(1).excitations[1].frequency, 6.0);
  EXPECT_EQ(scenes.at(0).excitations[1].frequency, 5.0);
  EXPECT_EQ(scenes.at(0).excitations[0].frequency, 2.0);
}

TEST(Study, WithSettingsLeavesTheStudyAlone) {
  const Study study = study_of("vary: {initial.x: [0.2, 0.3]}");
  const Study changed = with_settings(study, {"friction.coefficient=0.4", "gripper.pressing_force=0.5"});
  EXPECT_EQ(TrialScenes(changed).at(1).friction->coefficient, 0.4);
  EXPECT_EQ(TrialScenes(changed).at(1).initial.x, 0.3);
  EXPECT_EQ(TrialScenes(study).at(1).friction->coefficient, 0.24);
}

}  // namespace
}  // namespace vibratory_alignment
