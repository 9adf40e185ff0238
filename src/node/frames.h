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

/// True for parts of letters, digits, _, - and . with one / between two of them ("left", "cell_2/left"), and for none
/// at all. tf2 takes no name that begins with /; other characters, blanks above all, break the names that users and
/// tools write and split.
inline bool is_frame_prefix(const std::string& prefix) {
  constexpr char kAllowed[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./";
  if (prefix.empty()) return true;
  return prefix.find_first_not_of(kAllowed) == std::string::npos && prefix.front() != '/' && prefix.back() != '/' &&
         prefix.find("//") == std::string::npos;
}

/// All frames but `world` get "prefix/" in front, so that several aligners share one tree. An empty prefix: no change.
inline Frames frames_with_prefix(const std::string& prefix) {
  Frames frames;
  if (prefix.empty()) return frames;
  for (std::string* name : {&frames.slot, &frames.part, &frames.edge_a1, &frames.edge_a2}) *name = prefix + "/" + *name;
  return frames;
}

}  // namespace vibratory_alignment
