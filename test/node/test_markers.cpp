// The picture for rviz.
#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "node/markers.h"
#include "small_scene.h"

namespace vibratory_alignment {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

const ros::Time kStamp(3.0);
constexpr double kLength = 2e-3;  // of the small scene [m]

Marker find(const MarkerArray& array, const std::string& name, int id) {
  const auto found = std::find_if(array.markers.begin(), array.markers.end(),
                                  [&](const Marker& marker) { return marker.ns == name && marker.id == id; });
  if (found == array.markers.end()) throw std::runtime_error("no marker " + name);
  return *found;
}

double arrow_length(const Marker& arrow) {
  return std::hypot(arrow.points[1].x - arrow.points[0].x, arrow.points[1].z - arrow.points[0].z);
}

/// A sample between two messages of which an impact of force `peak` at a1 has come and gone.
Sample after_impact(double peak) {
  Sample sample;
  sample.state.y = 0.95;
  ContactSample& a1 = sample.contacts[static_cast<std::size_t>(Site::a1)];
  a1.peak_normal_force = peak;
  a1.impulse_y = 0.01;
  return sample;
}

class MarkersTest : public testing::Test {
 protected:
  Markers markers_{small_scene::load(), Frames()};
};

TEST_F(MarkersTest, EveryMarkerHasItsOwnNameAndIsInTheSlotFrame) {
  markers_.add(after_impact(5.0));
  std::set<std::pair<std::string, int>> names;
  for (const Marker& marker : markers_.draw(kStamp).markers) {
    EXPECT_TRUE(names.insert({marker.ns, marker.id}).second) << marker.ns << marker.id;
    EXPECT_EQ(marker.header.frame_id, "slot");
    EXPECT_EQ(marker.header.stamp, kStamp);
    const auto& q = marker.pose.orientation;
    EXPECT_NEAR(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1.0, 1e-12);
  }
}

TEST_F(MarkersTest, ImpactBetweenTwoMessagesIsSeenAtItsEdgeAndFades) {
  markers_.add(after_impact(5.0));
  const MarkerArray array = markers_.draw(kStamp);
  EXPECT_EQ(find(array, "reaction", 0).action, Marker::DELETE) << "there is no force now";
  const Marker peak = find(array, "peak", 0);
  ASSERT_EQ(peak.action, Marker::ADD);
  EXPECT_DOUBLE_EQ(peak.points[0].x, 0.79 * kLength);
  EXPECT_EQ(peak.points[0].z, 0.0);
  EXPECT_GT(peak.points[1].z, 0.0) << "the base pushes the part up";

  markers_.add(Sample());
  EXPECT_LT(arrow_length(find(markers_.draw(kStamp), "peak", 0)), arrow_length(peak));
  for (int i = 0; i < 200; ++i) markers_.add(Sample());
  EXPECT_EQ(find(markers_.draw(kStamp), "peak", 0).action, Marker::DELETE);
}

TEST_F(MarkersTest, ArrowsOfAnyForceHaveAReadableLength) {
  for (const double force : {1.0, 1e3, 1e9}) {
    markers_.add(after_impact(force));
    const double length = arrow_length(find(markers_.draw(kStamp), "peak", 0));
    EXPECT_GT(length, 0.3 * 0.7 * kLength) << force;
    EXPECT_LT(length, 2.0 * 0.7 * kLength) << force;
  }
}

TEST_F(MarkersTest, TraceStaysShortAndEndsAtTheCentre) {
  Sample sample;
  for (int i = 0; i < 100000; ++i) {
    sample.state.x = 1e-5 * i;
    markers_.add(sample);
  }
  const Marker trace = find(markers_.draw(kStamp), "trace", 0);
  EXPECT_LT(trace.points.size(), 600U);
  EXPECT_GT(trace.points.size(), 250U);
  EXPECT_EQ(trace.points.front().x, 0.0);
  EXPECT_DOUBLE_EQ(trace.points.back().x, 1e-5 * 99999 * kLength);
}

TEST_F(MarkersTest, TextTellsTimeMisalignmentModeAndOutcome) {
  Sample sample;
  sample.time = 2.0;
  sample.misalignment = 0.1;
  sample.mode = Mode::nonimpact;
  markers_.add(sample);
  markers_.set_outcome(Outcome::aligned);
  std::string text;
  for (const Marker& marker : markers_.draw(kStamp).markers) text += marker.text + "\n";
  for (const char* part : {"tau = 2.00", "10 ms", "misalignment 200 um", "nonimpact", "aligned"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in " << text;
  }
}

TEST_F(MarkersTest, ClearDeletesAllAndForgets) {
  markers_.add(after_impact(5.0));
  const MarkerArray cleared = markers_.clear(kStamp);
  ASSERT_EQ(cleared.markers.size(), 1U);
  EXPECT_EQ(cleared.markers[0].action, Marker::DELETEALL);
  markers_.add(Sample());
  EXPECT_EQ(find(markers_.draw(kStamp), "peak", 0).action, Marker::DELETE);
  EXPECT_LE(find(markers_.draw(kStamp), "trace", 0).points.size(), 2U);
}

}  // namespace
}  // namespace vibratory_alignment
