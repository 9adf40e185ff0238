// tf2 transforms of a scene: frames.h says which.
#pragma once

#include <array>
#include <vector>

#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>

#include "mechanics/state.h"
#include "model/scene.h"
#include "node/frames.h"

namespace vibratory_alignment {

/// world -> slot (shifted by `slot_position` [m]), slot -> edge_a1, slot -> edge_a2.
std::vector<geometry_msgs::TransformStamped> static_transforms(const Scene& scene, const Frames& frames,
                                                               const std::array<double, 3>& slot_position,
                                                               const ros::Time& stamp);

/// slot -> part; `length`: 1 dimensionless length in metres.
geometry_msgs::TransformStamped part_transform(const State& state, double length, const Frames& frames,
                                               const ros::Time& stamp);

}  // namespace vibratory_alignment
