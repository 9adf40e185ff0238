// A study's file: what is read, and that every fault is refused with key path, value and what is allowed.
#include "study/study_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>

#include "model/scene_error.h"
#include "study/design.h"
#include "study/fingerprint.h"
#include "study/study_refusals.h"
#include "study_text.h"

namespace vibratory_alignment {
namespace {

using test::study_of;

std::vector<std::string> faults_of(const std::string& text) {
  try {
    study_of(text);
  } catch (const SceneError& error) {
    return error.faults();
  }
  return {};
}

TEST(StudyFile, NameAndScene) {
  EXPECT_EQ(study_of("").name, "study");
  EXPECT_EQ(study_of("study: map").name, "map");
  EXPECT_EQ(trial_count(study_of("")), 1u);
  // a scene that comes with the package
  const test::Folder folder;
  const auto find = [](const std::string& name) { return std::string(SCENE_DIR) + "/" + name + ".yaml"; };
  const Study study = load_study(folder.write("s.yaml", "scene: fig2\nvary: {initial.x: [0.2, 0.3]}"), find);
  EXPECT_EQ(study.scene_source, std::string(SCENE_DIR) + "/fig2.yaml");
}

TEST(StudyFile, SamplesHaveDefaults) {
  const Study study = study_of("vary: {initial.x: {from: 0.2, to: 0.3}}\nsamples: {count: 8}");
  ASSERT_TRUE(study.samples);
  EXPECT_EQ(study.samples->method, SampleMethod::sobol);
  EXPECT_EQ(study.samples->seed, 0u);
  EXPECT_EQ(trial_count(study), 8u);
}

struct Fault {
  const char* text;   ///< of the study
  const char* place;  ///< how the fault begins
  const char* words;  ///< what else it says
};

TEST(StudyFile, FaultsAreRefusedAtTheirPlace) {
  const Fault cases[] = {
      {"varry: {initial.x: [1]}", "varry: ", "did you mean vary?"},
      {"vary: {initial.x: 0.3}", "vary.initial.x: 0.3: ", "a list of at least one value, or a range"},
      {"vary: {initial.x: []}", "vary.initial.x: ", "a list of at least one value"},
      {"vary: [{initial.x: [0.2, 0.3], initial.phi: [0]}]", "vary.0.initial.phi: ", "equally many"},
      {"vary: [{initial.x: [0.2], initial.phi: {from: 0, to: 1}}]\nsamples: {count: 2}",
       "vary.0.initial.phi: ", "sampled"},
      {"vary: {initial.x: {from: 0, count: 3}}", "vary.initial.x.to: missing", "a number"},
      {"vary: {initial.x: {from: 0, to: 1, count: 1}}", "vary.initial.x.count: 1: ", "from 2"},
      {"vary: {initial.x: {from: 0, to: 1, count: 2.5}}", "vary.initial.x.count: 2.5: ", "whole"},
      {"vary: {initial.x: {from: nan, to: 1, count: 2}}", "vary.initial.x.from: nan: ", "a number"},
      {"vary: {initial.x: {from: 0, to: 1, count: 3, spacing: log}}", "vary.initial.x.from: 0: ", "> 0"},
      {"vary: {initial.x: {from: 0, to: 1, count: 3, spacing: cubic}}",
       "vary.initial.x.spacing: cubic: ", "linear or log"},
      {"vary: {initial.x: {from: 0, to: 1, count: 3, as: delta}}", "vary.initial.x.as: delta: ", "value or offset"},
      {"vary: {initial.x: {from: 0, to: 1, coun: 3}}", "vary.initial.x.coun: ", "did you mean count?"},
      {"vary: {initial.x: {from: 0, to: 1}}", "samples: missing", "count"},
      {"vary: {initial.x: {from: 0, to: 1}}\nsamples: {}", "samples.count: missing", "whole number"},
      {"vary: {initial.x: {from: 0, to: 1}}\nsamples: {count: 0}", "samples.count: 0: ", "whole number"},
      {"vary: {initial.x: {from: 0, to: 1}}\nsamples: {count: 4, method: halton}",
       "samples.method: halton: ", "sobol or random"},
      {"vary: {initial.x: {from: 0, to: 1}}\nsamples: {count: 4, seed: -1}", "samples.seed: -1: ", "from 0"},
      {"vary: {initial.x: [1]}\nsamples: {count: 4}", "samples: ", "nothing is sampled"},
      {"vary: [{initial.x: [1]}, {initial.x: [2]}]", "vary.1.initial.x: ", "twice"},
      {"vary: [{gripper.stiffness.phi: [1]}, {gripper.stiffness: [{phi: 2}]}]",
       "vary.1.gripper.stiffness: ", "part of"},
      {"vary: {initial.x: [1, 2], initial.phi: [0, 1]}", "vary: ", "must be a list"},
      {"vary: []", "vary: ", "list of at least one"},
      {"vary: [{}]", "vary: ", "must name a key"},
      {"set: {initial.x.y: 3}", "set.initial.x.y: ", "neither a map nor a list"},
      {"set: {nosuch: null}", "set.nosuch: ", "no such key"},
      {"vary: [{initial.x: {from: 0, to: 1, count: 1000000000}}, {initial.phi: {from: 0, to: 1, count: 10000000}}]",
       "vary: ", "1e15"},
  };
  for (const Fault& c : cases) {
    const std::vector<std::string> faults = faults_of(c.text);
    ASSERT_EQ(faults.size(), 1u) << c.text << "\n" << (faults.size() > 1 ? faults[0] + "\n" + faults[1] : "");
    EXPECT_EQ(faults[0].substr(0, std::string(c.place).size()), c.place) << faults[0];
    EXPECT_NE(faults[0].find(c.words), std::string::npos) << faults[0];
  }
}

TEST(StudyFile, AllFaultsAreToldAtOnce) {
  EXPECT_EQ(faults_of("vary: [{initial.x: 3}, {initial.phi: {from: a, to: 1, count: 3}}]\nsample: {count: 3}").size(),
            3u);
}

// A mistyped key would else give a study of refused trials.
TEST(StudyFile, KeysThatNoSceneHasAreRefusedAtOnce) {
  const std::vector<std::string> faults = faults_of("vary: {initial.z: [0.2, 0.3, 0.4]}");
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].find("initial.z: 0.2: unknown key"), std::string::npos) << faults[0];
}

TEST(StudyFile, AKeyThatNoSceneHasIsRefusedWhereverManyTrialsAreLeft) {
  const std::vector<std::string> faults =
      faults_of("vary: [{initial.z: {from: 0, to: 1, count: 100000}}, {friction.coefficient: [-1, 0.2]}]");
  ASSERT_EQ(faults.size(), 1u) << "what is wrong with some trials alone is for their rows to say";
  EXPECT_NE(faults[0].find("initial.z: 0: unknown key"), std::string::npos) << faults[0];
}

// Some points of a study may have no scene: that is for the sweep to say.
TEST(StudyFile, SomeRefusedTrialsDoNoHarm) {
  EXPECT_TRUE(faults_of("vary: {slot.clearance: {from: 0, to: 0.1, count: 3}}").empty());
  EXPECT_TRUE(faults_of("vary: {slot.clearance: [0, 0.1, 0, 0.1, 0]}").empty());
  EXPECT_TRUE(faults_of("vary: {slot.clearance: [0, 0, 0, 0, -1, 0.1, 0]}").empty());
  // none of so many that all could be looked at is fine, but for reasons of their own
  EXPECT_TRUE(faults_of("vary: [{slot.clearance: [0, 0.1], part.half_width: [0.7, -1]}, "
                        "{initial.x: {from: 0.2, to: 0.3, count: 2000}}]")
                  .empty());
}

TEST(StudyFile, NothingButRefusedTrialsAreRefused) {
  const std::vector<std::string> faults = faults_of("vary: {slot.clearance: [0, -1, wide]}");
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].find("slot.clearance: 0: must be a number > 0"), 0u) << faults[0];
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(StudyFile, FaultsOfTheSceneNameThePlaceThatHasSetThem) {
  const auto ends_with = [](const std::string& text, const std::string& end) {
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
  };
  std::string message = message_of([] { study_of("set: {part.foo: 1}"); });
  EXPECT_NE(message.find("part.foo: 1: unknown key"), std::string::npos) << message;
  EXPECT_TRUE(ends_with(message, "study.yaml: set)")) << message;
  message = message_of([] { study_of("set: {slot.clearance: 0.1}\nvary: {slot.clearance: [0, -1]}"); });
  EXPECT_TRUE(ends_with(message, "study.yaml: vary)")) << message;
  EXPECT_EQ(message.find("study.yaml: set"), std::string::npos) << message;
  message = message_of(
      [] { refuse_without_scenes(with_settings(study_of("set: {slot.clearance: 0.1}"), {"slot.clearance=-2"})); });
  EXPECT_TRUE(ends_with(message, "(set by slot.clearance=-2)")) << message;
  EXPECT_EQ(message.find("study.yaml: set"), std::string::npos) << message;
  message = message_of([] { study_of("vary: {initial.x: [0.2]}", "units: dimensionless"); });
  EXPECT_EQ(message.find("set by study"), std::string::npos) << message;
}

TEST(StudyFile, SettingsOfVariedKeysAreRefused) {
  const Study study = study_of(
      "vary: [{initial.x: [0.2, 0.3]}, {initial.phi: {from: -0.01, to: 0.01, count: 3, as: offset}},"
      " {gripper.stiffness.phi: [50, 60]}]");
  for (const char* setting : {"initial.x=0.25", "initial.x=nonsense", "initial.x.y=1"}) {
    const std::string message = message_of([&] {
      refuse_settings_of_varied_keys(study, {"part.inertia=0.3", setting});
    });
    EXPECT_EQ(message.find("--set " + std::string(setting) + ": "), 0u) << message;
    EXPECT_NE(message.find("study.yaml varies initial.x"), std::string::npos) << message;
  }
  EXPECT_NO_THROW(refuse_settings_of_varied_keys(
      study, {"initial.phi=0.02", "initial.xx=1", "gripper.stiffness={x: 0.05}", "initial.y=0.9"}));
}

TEST(StudyFile, OfNoSceneIsRefused) {
  const test::Folder folder;
  const auto none = [](const std::string& name) -> std::string { throw std::runtime_error(name + ": no such scene"); };
  try {
    load_study(folder.write("s.yaml", "scene: nosuch"), none);
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("s.yaml: scene: nosuch: no such scene"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(load_study(folder.write("s.yaml", "vary: {initial.x: [1]}"), none), SceneError);
  EXPECT_THROW(load_study("/nosuch/study.yaml", none), SceneError);
}

// --resume and `align merge` go by it: rows of one study must not pass for those of another one.
TEST(Fingerprint, TellsStudiesOfOtherTrialsApart) {
  const std::vector<std::string> others = {
      "",
      "set: {initial.x: 0.25}",
      "vary: {initial.x: {from: 0.1, to: 0.4, count: 4}}",
      "vary: {initial.x: {from: 0.2, to: 0.4, count: 4}}",
      "vary: {initial.x: {from: 0.1, to: 0.5, count: 4}}",
      "vary: {initial.x: {from: 0.1, to: 0.4, count: 5}}",
      "vary: {initial.x: {from: 0.1, to: 0.4, count: 4, spacing: log}}",
      "vary: {initial.x: {from: 0.1, to: 0.4, count: 4, as: offset}}",
      "vary: {initial.vx: {from: 0.1, to: 0.4, count: 4}}",
      "vary: {initial.x: [0.1, 0.2, 0.3, 0.4]}",
      "vary: {initial.x: [0.1, 0.2, 0.3, 0.5]}",
      "vary: {initial.x: {from: 0.1, to: 0.4}}\nsamples: {count: 4}",
      "vary: {initial.x: {from: 0.1, to: 0.4}}\nsamples: {count: 8}",
      "vary: {initial.x: {from: 0.1, to: 0.4}}\nsamples: {count: 4, seed: 1}",
      "vary: {initial.x: {from: 0.1, to: 0.4}}\nsamples: {count: 4, method: random}",
      "vary: [{initial.x: [0.1, 0.2]}, {initial.vx: [0.1, 0.2]}]",
      "vary: [{initial.vx: [0.1, 0.2]}, {initial.x: [0.1, 0.2]}]",
      "vary: [{initial.x: [0.1, 0.2], initial.vx: [0.1, 0.2]}]",
  };
  std::set<std::string> seen;
  for (const std::string& text : others) {
    const std::string found = fingerprint(study_of(text), "1.0");
    EXPECT_TRUE(seen.insert(found).second) << text;
    EXPECT_EQ(fingerprint(study_of(text + "\n# a comment"), "1.0"), found) << text;
    EXPECT_NE(fingerprint(study_of(text), "1.1"), found) << text;
  }
}

}  // namespace
}  // namespace vibratory_alignment
