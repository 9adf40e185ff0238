// What dynamic_reconfigure may do to a scene.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "node/drive_settings.h"
#include "small_scene.h"

namespace vibratory_alignment {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(DriveSettings, StartWithTheScene) {
  const DriveSettings settings(small_scene::load(small_scene::path, {"excitation.phase=0.5"}), 0.25);
  const AlignerConfig& config = settings.config();
  EXPECT_TRUE(config.enabled);
  EXPECT_EQ(config.amplitude, 1.0);
  EXPECT_EQ(config.frequency, 20.0);
  EXPECT_EQ(config.phase, 0.5);
  EXPECT_EQ(config.waveform, 0);
  EXPECT_EQ(config.pressing_force, 0.2);
  EXPECT_EQ(config.time_scale, 0.25);
}

TEST(DriveSettings, AreInTheUnitsOfAnSiScene) {
  const Scene scene = small_scene::load(small_scene::si_path);
  DriveSettings settings(scene, 1.0);
  AlignerConfig config = settings.config();
  EXPECT_NEAR(config.amplitude, 8.0, 1e-12);
  EXPECT_NEAR(config.frequency, 636.0, 1e-9);
  EXPECT_NEAR(config.pressing_force, 1.6, 1e-12);

  config.amplitude *= 2.0;
  EXPECT_TRUE(settings.change(config).empty());
  EXPECT_NEAR(settings.excitations()[0].amplitude, 2.0 * scene.excitations[0].amplitude, 1e-14);
  EXPECT_EQ(settings.excitations()[0].frequency, scene.excitations[0].frequency) << "untouched to the last bit";
}

TEST(DriveSettings, PressingForceIsKnownFromTheAnchorToo) {
  Scene scene = small_scene::load();
  scene.gripper.pressing_force.reset();
  scene.gripper.anchor_y = 0.5;
  scene.initial.y = 0.9;
  scene.initial.phi = 0.0;
  const DriveSettings settings(scene, 1.0);
  EXPECT_NEAR(settings.config().pressing_force, 0.9 - 0.5, 1e-15) << "y_touch = base_distance at phi = 0";
}

TEST(DriveSettings, DisabledExcitationKeepsItsFrequencyAndPhase) {
  DriveSettings settings(small_scene::load(), 1.0);
  AlignerConfig config = settings.config();
  config.enabled = false;
  EXPECT_TRUE(settings.change(config).empty());
  EXPECT_EQ(settings.excitations()[0].amplitude, 0.0);
  EXPECT_EQ(settings.excitations()[0].frequency, 20.0);
  config.enabled = true;
  settings.change(config);
  EXPECT_EQ(settings.excitations()[0].amplitude, 1.0);
}

TEST(DriveSettings, RefuseNanAndInfinityAndReportTheOldValue) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (double AlignerConfig::*value : {&AlignerConfig::amplitude, &AlignerConfig::frequency, &AlignerConfig::phase,
                                         &AlignerConfig::pressing_force, &AlignerConfig::time_scale}) {
      DriveSettings settings(small_scene::load(), 1.0);
      AlignerConfig requested = settings.config();
      const double old = requested.*value;
      requested.*value = bad;
      EXPECT_EQ(settings.change(requested).size(), 1U);
      EXPECT_EQ(requested.*value, old);
      EXPECT_EQ(settings.config().*value, old);
    }
  }
}

TEST(DriveSettings, GoodValuesOfARequestCountBesideABadOne) {
  DriveSettings settings(small_scene::load(), 1.0);
  AlignerConfig requested = settings.config();
  requested.amplitude = kNan;
  requested.frequency = 30.0;
  settings.change(requested);
  EXPECT_EQ(settings.excitations()[0].amplitude, 1.0);
  EXPECT_EQ(settings.excitations()[0].frequency, 30.0);
}

TEST(DriveSettings, ValueOfTheSceneBeyondTheRangeSurvivesOtherChanges) {
  DriveSettings settings(small_scene::load(small_scene::path, {"excitation.amplitude=5000"}), 1.0);
  AlignerConfig requested = settings.config();
  requested.time_scale = 0.5;
  requested.__clamp__();  // as the server does
  settings.undo_clamping(requested);
  settings.change(requested);
  EXPECT_EQ(requested.amplitude, 5000.0);
  EXPECT_EQ(settings.excitations()[0].amplitude, 5000.0);
  EXPECT_EQ(settings.config().time_scale, 0.5);
}

// Who sets it without that server, as a goal does, means the end of the range.
TEST(DriveSettings, EndOfTheRangeCanBeSetWhereTheSceneLiesBeyondIt) {
  DriveSettings settings(small_scene::load(small_scene::path, {"excitation.amplitude=5000"}), 1.0);
  AlignerConfig requested = settings.config();
  requested.amplitude = 1000.0;
  EXPECT_TRUE(settings.change(requested).empty());
  EXPECT_EQ(settings.excitations()[0].amplitude, 1000.0);
}

TEST(DriveSettings, ChirpNeedsASweep) {
  DriveSettings without(small_scene::load(), 1.0);
  AlignerConfig requested = without.config();
  requested.waveform = 3;
  EXPECT_EQ(without.change(requested).size(), 1U);
  EXPECT_EQ(requested.waveform, 0);

  Scene scene = small_scene::load();
  scene.excitations[0].waveform = Waveform::chirp;
  scene.excitations[0].end_frequency = 40.0;
  scene.excitations[0].sweep_time = 2.0;
  DriveSettings with(scene, 1.0);
  requested.waveform = 1;
  EXPECT_TRUE(with.change(requested).empty());
  EXPECT_EQ(with.excitations()[0].waveform, Waveform::square);
  requested.waveform = 3;
  EXPECT_TRUE(with.change(requested).empty());
  EXPECT_EQ(with.excitations()[0].waveform, Waveform::chirp);
}

}  // namespace
}  // namespace vibratory_alignment
