#include "node/transforms.h"

#include <string>

#include "node/messages.h"

namespace vibratory_alignment {
namespace {

geometry_msgs::TransformStamped identity(const std::string& parent, const std::string& child, const ros::Time& stamp) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = stamp;
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  transform.transform.rotation.w = 1.0;
  return transform;
}

}  // namespace

std::vector<geometry_msgs::TransformStamped> static_transforms(const Scene& scene, const Frames& frames,
                                                               const std::array<double, 3>& slot_position,
                                                               const ros::Time& stamp) {
  geometry_msgs::TransformStamped slot = identity(frames.world, frames.slot, stamp);
  slot.transform.translation.x = slot_position[0];
  slot.transform.translation.y = slot_position[1];
  slot.transform.translation.z = slot_position[2];
  geometry_msgs::TransformStamped a1 = identity(frames.slot, frames.edge_a1, stamp);
  geometry_msgs::TransformStamped a2 = identity(frames.slot, frames.edge_a2, stamp);
  a1.transform.translation.x = scene.slot_half_width() * ros_units(scene).length;
  a2.transform.translation.x = -a1.transform.translation.x;
  return {slot, a1, a2};
}

geometry_msgs::TransformStamped part_transform(const State& state, double length, const Frames& frames,
                                               const ros::Time& stamp) {
  geometry_msgs::TransformStamped transform = identity(frames.slot, frames.part, stamp);
  transform.transform.translation = ros_vector(state.x, state.y, length);
  transform.transform.rotation = ros_tilt(state.phi);
  return transform;
}

}  // namespace vibratory_alignment
