// Parameters that nothing reads are told of, and no other.
#include "node/unknown_parameters.h"

#include <gtest/gtest.h>

namespace vibratory_alignment {
namespace {

using Lines = std::vector<std::string>;

const Lines known = {"publish_rate", "time_scale", "tf_prefix"};

TEST(UnknownParameters, AreNoneAmongTheKnownOnes) {
  EXPECT_EQ(unknown_parameters("/aligner", {}, known), Lines());
  EXPECT_EQ(unknown_parameters("/aligner", {"tf_prefix", "publish_rate"}, known), Lines());
}

TEST(UnknownParameters, AreNamedWithTheNodeAndTheNearestKnownName) {
  const Lines lines = unknown_parameters("/left/aligner", {"colour", "publish_rat", "time_scale", "tfprefix"}, known);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_NE(lines[0].find("/left/aligner/colour "), std::string::npos) << lines[0];
  EXPECT_EQ(lines[0].find("did you mean"), std::string::npos) << lines[0];
  EXPECT_NE(lines[1].find("/left/aligner/publish_rat "), std::string::npos) << lines[1];
  EXPECT_NE(lines[1].find("did you mean publish_rate?"), std::string::npos) << lines[1];
  EXPECT_NE(lines[2].find("did you mean tf_prefix?"), std::string::npos) << lines[2];
}

// A known name in other letters is another name, as for the parameter server.
TEST(UnknownParameters, AreNamesInOtherLetters) {
  EXPECT_EQ(unknown_parameters("/aligner", {"Publish_rate"}, known).size(), 1u);
}

// Of the node (docs/node.md), the scene, the settings (config/Aligner.cfg), actionlib and diagnostic_updater.
TEST(KnownParameters, AreThoseOfTheNodeAndItsLibraries) {
  const Lines all = {"scene",         "scene_file",     "time_scale", "publish_rate",     "publish_clock",
                     "slot_position", "enabled",        "amplitude",  "frequency",        "phase",
                     "waveform",      "pressing_force", "align",      "diagnostic_period"};
  EXPECT_EQ(unknown_parameters("/aligner", all, known_parameters()), Lines());
}

AlignerConfig settings_of_scene() {
  AlignerConfig settings = AlignerConfig::__getDefault__();
  settings.enabled = true;
  settings.amplitude = 1.25;
  settings.waveform = 2;
  settings.time_scale = 1.0;
  return settings;
}

XmlRpc::XmlRpcValue parameters(const char* name, const XmlRpc::XmlRpcValue& value) {
  XmlRpc::XmlRpcValue given;
  given[name] = value;
  return given;
}

TEST(UnreadSettings, AreThoseThatTheSceneGivesOtherwise) {
  const AlignerConfig scene = settings_of_scene();
  const Lines lines = unread_settings("/left/aligner", parameters("amplitude", 3.5), scene);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].find("/left/aligner/amplitude = 3.5 "), 0u) << lines[0];
  EXPECT_NE(lines[0].find("the scene gives 1.25;"), std::string::npos) << lines[0];
  EXPECT_EQ(unread_settings("/aligner", parameters("enabled", XmlRpc::XmlRpcValue(false)), scene).size(), 1u);
  EXPECT_EQ(unread_settings("/aligner", parameters("waveform", 1), scene).size(), 1u);
  EXPECT_EQ(unread_settings("/aligner", parameters("amplitude", "much"), scene).size(), 1u);
}

// As dynamic_reconfigure has left them, or as a launch file gives a whole number; ~time_scale is read.
TEST(UnreadSettings, AreNoneWhereTheyAreThoseOfTheScene) {
  AlignerConfig scene = settings_of_scene();
  EXPECT_EQ(unread_settings("/aligner", parameters("colour", 1), scene), Lines());
  EXPECT_EQ(unread_settings("/aligner", parameters("amplitude", 1.25), scene), Lines());
  EXPECT_EQ(unread_settings("/aligner", parameters("waveform", 2), scene), Lines());
  EXPECT_EQ(unread_settings("/aligner", parameters("time_scale", 0.1), scene), Lines());
  scene.amplitude = 2.0;
  EXPECT_EQ(unread_settings("/aligner", parameters("amplitude", 2), scene), Lines());
}

}  // namespace
}  // namespace vibratory_alignment
