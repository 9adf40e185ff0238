// The picture of a trial for rviz: a section through the plane of motion, seen along the ROS y axis.
//
//   namespace  id     what
//   base       0      the base with its slot, and the floor if it has one
//   part       0, 1   the part; its mass centre
//   trace      0      the way of the mass centre
//   contact    site   a dot at each contact point
//   reaction   spot   force of the base on the part now
//   peak       spot   the largest force of late, fading: shows impacts that fall between two messages
//   text       line   time, misalignment, force, mode and outcome
// Bodies lie behind the plane of motion, so that frames, trace and arrows are in front of them. All lengths follow the
// size of the slot; the length of an arrow goes with the root of its force relative to the largest so far, so that
// small forces are seen beside large ones. Markers stay until they are deleted.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <geometry_msgs/Point.h>
#include <ros/time.h>
#include <visualization_msgs/MarkerArray.h>

#include "model/scaling.h"
#include "model/scene.h"
#include "node/frames.h"
#include "trial/outcome.h"
#include "trial/sampler.h"

namespace vibratory_alignment {

class Markers {
 public:
  Markers(const Scene& scene, const Frames& frames);

  /// Books a sample: the trace and the forces; every sample counts, also those that are not drawn.
  void add(const Sample& sample);

  /// From now on the text shows what the trial ended in.
  void set_outcome(Outcome outcome) { outcome_ = outcome; }

  /// The picture at the last sample.
  visualization_msgs::MarkerArray draw(const ros::Time& stamp) const;

  /// Forgets trace and forces; the message deletes everything that is drawn.
  visualization_msgs::MarkerArray clear(const ros::Time& stamp);

 private:
  struct Arrow {
    double force_x = 0.0, force_y = 0.0;  ///< N n + T t, dimensionless
    double point_x = 0.0, point_y = 0.0;
  };

  visualization_msgs::Marker marker(const ros::Time& stamp, const char* name, int id, int type) const;
  visualization_msgs::Marker arrow(const ros::Time& stamp, const char* name, int id, const Arrow& force) const;
  void draw_base(const ros::Time& stamp, visualization_msgs::MarkerArray& array) const;
  void draw_part(const ros::Time& stamp, visualization_msgs::MarkerArray& array) const;
  void draw_trace(const ros::Time& stamp, visualization_msgs::MarkerArray& array) const;
  void draw_contacts(const ros::Time& stamp, visualization_msgs::MarkerArray& array) const;
  void draw_text(const ros::Time& stamp, visualization_msgs::MarkerArray& array) const;
  void extend_trace();
  void place(Arrow& arrow, Spot spot) const;

  Frames frames_;
  bool has_scales_;
  OutputUnits units_;
  Part part_;
  double slot_half_width_, slot_depth_;  ///< drawn depth
  bool has_floor_;
  double size_;  ///< half the slot's width; everything is drawn in proportion to it

  Sample sample_;
  Outcome outcome_ = Outcome::running;
  std::vector<geometry_msgs::Point> trace_;
  long trace_stride_ = 1, trace_skipped_ = 0;
  std::array<Arrow, kSpotCount> now_{}, peak_{};
  double largest_force_ = 0.0;  ///< so far
};

}  // namespace vibratory_alignment
