// Core data -> messages: units, axes, signs.
#include <cmath>

#include <gtest/gtest.h>

#include "node/messages.h"
#include "node/transforms.h"
#include "small_scene.h"

namespace vibratory_alignment {
namespace {

// The scales of the small scene: 8 N / 4000 N/m = 2 mm; sqrt(0.1 kg / 4000 N/m) = 5 ms.
constexpr double kLengthScale = 2e-3, kTime = 5e-3, kForce = 8.0;
const ros::Time kSampleStamp(12.5);

ContactSample& at(Sample& sample, Site site) { return sample.contacts[static_cast<std::size_t>(site)]; }

ContactSample pushed(double fx, double fy, double px, double py) {
  ContactSample contact;
  contact.state.phase = Phase::loaded;
  contact.depth = 0.01;
  contact.normal_force = fy;
  contact.force_x = fx;
  contact.force_y = fy;
  contact.point_x = px;
  contact.point_y = py;
  contact.peak_normal_force = 2.0 * fy;
  contact.normal_impulse = 0.5;
  contact.impulse_x = 0.1;
  contact.impulse_y = 0.5;
  return contact;
}

class MessagesTest : public testing::Test {
 protected:
  const Scene scene_ = small_scene::load();
  const Messages messages_{scene_, frames_with_prefix("")};
};

TEST_F(MessagesTest, StateIsGivenDimensionlessAndInSi) {
  Sample sample;
  sample.time = 2.0;
  sample.state = {0.1, 0.9, 0.02, -0.3, 0.4, 5.0};
  sample.misalignment = 0.1;
  sample.mode = Mode::impact;
  const AlignerState state = messages_.state(sample, kSampleStamp);
  EXPECT_EQ(state.header.stamp, kSampleStamp);
  EXPECT_EQ(state.header.frame_id, "slot");
  EXPECT_EQ(state.scene, "small");
  EXPECT_EQ(state.units, "dimensionless");
  EXPECT_TRUE(state.has_scales);
  EXPECT_EQ(state.tau, 2.0);
  EXPECT_DOUBLE_EQ(state.time, 2.0 * kTime);
  EXPECT_EQ(state.dimensionless.x, 0.1);
  EXPECT_EQ(state.dimensionless.omega, 5.0);
  EXPECT_DOUBLE_EQ(state.si.x, 0.1 * kLengthScale);
  EXPECT_DOUBLE_EQ(state.si.y, 0.9 * kLengthScale);
  EXPECT_EQ(state.si.phi, 0.02);
  EXPECT_DOUBLE_EQ(state.si.vx, -0.3 * kLengthScale / kTime);
  EXPECT_DOUBLE_EQ(state.si.omega, 5.0 / kTime);
  EXPECT_DOUBLE_EQ(state.misalignment, 0.1 * kLengthScale);
  EXPECT_EQ(state.mode, AlignerState::MODE_IMPACT);
  EXPECT_DOUBLE_EQ(state.length_scale, kLengthScale);
  EXPECT_DOUBLE_EQ(state.time_scale, kTime);
  EXPECT_DOUBLE_EQ(state.force_scale, kForce);
}

TEST_F(MessagesTest, TellsWhetherTheFirstExcitationActsOnTheTilt) {
  Scene scene = small_scene::load();
  EXPECT_FALSE(Messages(scene, Frames()).state(Sample(), kSampleStamp).excites_tilt);
  scene.excitations.front().direction = Direction::phi;
  EXPECT_TRUE(Messages(scene, Frames()).state(Sample(), kSampleStamp).excites_tilt);
}

TEST_F(MessagesTest, PeaksAndImpulsesAreGivenPerSpot) {
  Sample sample;
  at(sample, Site::a2) = pushed(0.0, 3.0, -0.79, 0.0);
  at(sample, Site::b1) = pushed(0.0, 1.0, 0.7, 0.0);
  at(sample, Site::b1_floor) = pushed(0.0, 2.0, 0.7, 0.0);
  const AlignerState state = messages_.state(sample, kSampleStamp);
  EXPECT_FALSE(state.a1);
  EXPECT_TRUE(state.a2);
  EXPECT_TRUE(state.b1);
  EXPECT_FALSE(state.b2);
  EXPECT_DOUBLE_EQ(state.peak_force[AlignerState::A2], 6.0 * kForce);
  EXPECT_DOUBLE_EQ(state.impulse[AlignerState::A2], 0.5 * kForce * kTime);
  EXPECT_DOUBLE_EQ(state.peak_force[AlignerState::B1], 4.0 * kForce) << "the larger of wall and floor";
  EXPECT_DOUBLE_EQ(state.impulse[AlignerState::B1], 1.0 * kForce * kTime) << "the sum of wall and floor";
}

TEST_F(MessagesTest, ReactionsAreForcesOnThePartInTheirEdgeFrames) {
  Sample sample;
  at(sample, Site::a1) = pushed(-0.5, 3.0, 0.79, 0.0);
  const geometry_msgs::WrenchStamped a1 = messages_.reaction(sample, Site::a1, kSampleStamp);
  EXPECT_EQ(a1.header.frame_id, "edge_a1");
  EXPECT_DOUBLE_EQ(a1.wrench.force.x, -0.5 * kForce);
  EXPECT_EQ(a1.wrench.force.y, 0.0);
  EXPECT_DOUBLE_EQ(a1.wrench.force.z, 3.0 * kForce);
  EXPECT_EQ(a1.wrench.torque.y, 0.0);
  const geometry_msgs::WrenchStamped a2 = messages_.reaction(sample, Site::a2, kSampleStamp);
  EXPECT_EQ(a2.header.frame_id, "edge_a2");
  EXPECT_EQ(a2.wrench.force.z, 0.0);
}

TEST_F(MessagesTest, ContactMomentIsAboutTheMassCentreAndTheNegativeYAxis) {
  Sample sample;
  sample.state.y = 0.9;
  // Up at the right: counter-clockwise, seen with y up; that is a negative torque about ROS y.
  at(sample, Site::a1) = pushed(0.0, 3.0, 0.79, 0.0);
  const AlignerContacts contacts = messages_.contacts(sample, kSampleStamp);
  ASSERT_EQ(contacts.states.size(), 1U);
  const AlignerContact& contact = contacts.states[0];
  EXPECT_EQ(contact.info, "a1");
  ASSERT_EQ(contact.wrenches.size(), 1U);
  EXPECT_DOUBLE_EQ(contact.total_wrench.torque.y, -0.79 * 3.0 * kForce * kLengthScale);
  EXPECT_DOUBLE_EQ(contact.contact_positions[0].x, 0.79 * kLengthScale);
  EXPECT_DOUBLE_EQ(contact.contact_normals[0].z, 1.0);
  EXPECT_DOUBLE_EQ(contact.depths[0], 0.01 * kLengthScale);
}

TEST_F(MessagesTest, ContactThatIsOverStillShowsItsPeakAndImpulse) {
  Sample sample;
  at(sample, Site::a1) = pushed(0.0, 3.0, 0.79, 0.0);
  at(sample, Site::a1).state.phase = Phase::outside;
  const AlignerContacts contacts = messages_.contacts(sample, kSampleStamp);
  ASSERT_EQ(contacts.states.size(), 1U);
  EXPECT_TRUE(contacts.states[0].wrenches.empty());
  EXPECT_DOUBLE_EQ(contacts.states[0].peak_force, 6.0 * kForce);
  EXPECT_DOUBLE_EQ(contacts.states[0].impulse.z, 0.5 * kForce * kTime);
}

TEST_F(MessagesTest, DurationIsNanUnlessAligned) {
  TrialResult result;
  result.outcome = Outcome::stalled;
  EXPECT_TRUE(std::isnan(messages_.result(result, kSampleStamp).duration));
  result.outcome = Outcome::aligned;
  result.aligned_time = 3.0;
  const AlignerResult message = messages_.result(result, kSampleStamp);
  EXPECT_DOUBLE_EQ(message.duration, 3.0 * kTime);
  EXPECT_EQ(message.outcome, "aligned");
}

TEST(MessagesWithoutScales, SiFieldsAreTheDimensionlessNumbers) {
  Scene scene = small_scene::load();
  scene.scales.reset();
  Sample sample;
  sample.time = 2.0;
  sample.state.x = 0.1;
  const AlignerState state = Messages(scene, Frames()).state(sample, kSampleStamp);
  EXPECT_FALSE(state.has_scales);
  EXPECT_EQ(state.time, 2.0);
  EXPECT_EQ(state.si.x, 0.1);
}

TEST(Transforms, TiltTurnsAboutTheNegativeYAxis) {
  const double phi = 0.3;
  const auto part = part_transform({0.1, 0.9, phi, 0.0, 0.0, 0.0}, kLengthScale, Frames(), kSampleStamp).transform;
  EXPECT_DOUBLE_EQ(part.translation.x, 0.1 * kLengthScale);
  EXPECT_EQ(part.translation.y, 0.0);
  EXPECT_DOUBLE_EQ(part.translation.z, 0.9 * kLengthScale);
  // The part's x axis e1 = (cos phi, sin phi) points up: z component of the rotated x axis.
  const auto& q = part.rotation;
  EXPECT_NEAR(2.0 * (q.x * q.z - q.w * q.y), std::sin(phi), 1e-15);
  EXPECT_NEAR(1.0 - 2.0 * (q.y * q.y + q.z * q.z), std::cos(phi), 1e-15);
}

TEST(Transforms, EdgesLieAtTheSlotAndTakeThePrefix) {
  const Scene scene = small_scene::load();
  const auto fixed = static_transforms(scene, frames_with_prefix("left"), {0.1, 0.2, 0.3}, kSampleStamp);
  ASSERT_EQ(fixed.size(), 3U);
  EXPECT_EQ(fixed[0].header.frame_id, "world");
  EXPECT_EQ(fixed[0].child_frame_id, "left/slot");
  EXPECT_EQ(fixed[0].transform.translation.z, 0.3);
  EXPECT_EQ(fixed[1].header.frame_id, "left/slot");
  EXPECT_EQ(fixed[1].child_frame_id, "left/edge_a1");
  EXPECT_DOUBLE_EQ(fixed[1].transform.translation.x, 0.79 * kLengthScale);
  EXPECT_EQ(fixed[2].child_frame_id, "left/edge_a2");
  EXPECT_DOUBLE_EQ(fixed[2].transform.translation.x, -0.79 * kLengthScale);
}

}  // namespace
}  // namespace vibratory_alignment
