// Bags that are written without a ROS master.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <tf2_msgs/TFMessage.h>
#include <vibratory_alignment/AlignerResult.h>
#include <vibratory_alignment/AlignerState.h>

#include "node/bag_writer.h"
#include "small_scene.h"

namespace vibratory_alignment {
namespace {

namespace fs = std::filesystem;
constexpr double kInterval = 0.01;

class BagWriterTest : public testing::Test {
 protected:
  void TearDown() override { fs::remove(path_); }

  /// Runs the scene into a bag; returns its samples without those at event instants.
  std::vector<Sample> record(bool with_events, bool finish = true) {
    Simulation simulation(scene_);
    Sampler sampler(simulation, kInterval, with_events);
    BagWriter writer(path_, scene_);
    std::vector<Sample> regular;
    for (Sample sample; sampler.next(sample);) {
      writer.write(sample);
      if (!sample.is_event || sample.is_last) regular.push_back(sample);
    }
    if (finish) writer.finish(simulation.result());
    return regular;
  }

  std::vector<AlignerState> states() const {
    std::vector<AlignerState> states;
    rosbag::Bag bag(path_);
    for (const rosbag::MessageInstance& message : rosbag::View(bag, rosbag::TopicQuery("/aligner/state"))) {
      states.push_back(*message.instantiate<AlignerState>());
    }
    return states;
  }

  const Scene scene_ = small_scene::load();
  const std::string path_ = testing::TempDir() + "bag_writer_" + std::to_string(getpid()) + ".bag";
};

TEST_F(BagWriterTest, HoldsEverySampleBitForBit) {
  const std::vector<Sample> samples = record(false);
  const std::vector<AlignerState> recorded = states();
  ASSERT_EQ(recorded.size(), samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(recorded[i].tau, samples[i].time);
    EXPECT_EQ(recorded[i].dimensionless.x, samples[i].state.x);
    EXPECT_EQ(recorded[i].dimensionless.omega, samples[i].state.omega);
  }
}

TEST_F(BagWriterTest, HasTheTopicsOfTheNodeInOrderOfTime) {
  const std::size_t count = record(false).size();
  rosbag::Bag bag(path_);
  std::map<std::string, std::size_t> messages;
  ros::Time last;
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    ++messages[message.getTopic()];
    EXPECT_GE(message.getTime(), last);
    last = message.getTime();
  }
  for (const char* topic :
       {"/tf", "/aligner/state", "/aligner/reaction/a1", "/aligner/reaction/a2", "/aligner/contacts"}) {
    EXPECT_EQ(messages[topic], count) << topic;
  }
  EXPECT_EQ(messages["/tf_static"], 1U);
  EXPECT_EQ(messages["/aligner/parameter_updates"], 1U);
  EXPECT_EQ(messages["/aligner/restarts"], 1U);
  EXPECT_EQ(messages["/aligner/result"], 1U);
  EXPECT_GT(messages["/aligner/markers"], 1U);
}

TEST_F(BagWriterTest, StampsAreSimulatedSecondsFromOneOn) {
  record(false);
  ros::Time last;
  for (const AlignerState& state : states()) {
    EXPECT_GT(state.header.stamp, last) << "never the same twice";
    EXPECT_NEAR(state.header.stamp.toSec(), 1.0 + state.time, 1e-9);
    last = state.header.stamp;
  }
}

TEST_F(BagWriterTest, LatchedTopicsAreMarkedAsSuch) {
  record(false);
  rosbag::Bag bag(path_);
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    const bool latched = connection->header->count("latching") != 0 && connection->header->at("latching") == "1";
    const bool expected = connection->topic == "/tf_static" || connection->topic == "/aligner/result" ||
                          connection->topic == "/aligner/restarts" ||
                          connection->topic == "/aligner/parameter_updates" || connection->topic == "/aligner/markers";
    EXPECT_EQ(latched, expected) << connection->topic;
  }
}

TEST_F(BagWriterTest, EventSamplesLeaveTheirPeaksAndImpulsesToTheNextMessage) {
  record(false);
  const std::vector<AlignerState> plain = states();
  record(true);
  const std::vector<AlignerState> with_events = states();
  ASSERT_EQ(plain.size(), with_events.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    EXPECT_EQ(plain[i].dimensionless.vy, with_events[i].dimensionless.vy);
    for (std::size_t spot = 0; spot < 4; ++spot) {
      EXPECT_NEAR(plain[i].peak_force[spot], with_events[i].peak_force[spot], 1e-9) << i;
      EXPECT_NEAR(plain[i].impulse[spot], with_events[i].impulse[spot], 1e-12) << i;
    }
  }
}

TEST_F(BagWriterTest, UnfinishedBagIsRemoved) {
  record(false, false);
  EXPECT_FALSE(fs::exists(path_));
}

TEST_F(BagWriterTest, PathThatCannotBeWrittenIsNamed) {
  try {
    BagWriter writer("/no/such/directory/trial.bag", scene_);
    FAIL() << "must throw";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/no/such/directory/trial.bag"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace vibratory_alignment
