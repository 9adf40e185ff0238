// Names of the tf2 frames (REP 105: one tree, rooted in the world frame).
//
//   world -> slot            static; origin on the slot's axis in the plane of the base's top surface
//   slot -> edge_a1, edge_a2 static; at the slot's edges (+l, 0), (-l, 0), axes as slot
//   slot -> part             the mass centre; moves
// MODEL.md's plane is the x-z plane of these frames: ROS x = x, ROS z = y; phi turns about the ROS -y axis (REP 103).
#pragma once

#include <string>

namespace vibratory_alignment {

struct Frames {
  std::string world = "world";
  std::string slot = "slot";
  std::string part = "part";
  std::string edge_a1 = "edge_a1";
  std::string edge_a2 = "edge_a2";
};

/// All frames but `world` get "prefix/" in front, so that several aligners share one tree. An empty prefix: no change.
inline Frames frames_with_prefix(const std::string& prefix) {
  Frames frames;
  if (prefix.empty()) return frames;
  for (std::string* name : {&frames.slot, &frames.part, &frames.edge_a1, &frames.edge_a2}) *name = prefix + "/" + *name;
  return frames;
}

}  // namespace vibratory_alignment
