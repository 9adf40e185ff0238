// Core data -> the package's messages, in SI through the scene's scales. One conversion for the live node and the bag.
//
// Without scales in the scene the scales are 1 (1 unit of length = 1 m, of time = 1 s, of force = 1 N).
// Vectors in the plane (x, y) become (x, 0, y); a moment M, counter-clockwise, becomes a torque -M about the ROS y
// axis.
#pragma once

#include <string>

#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Vector3.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/time.h>
#include <vibratory_alignment/AlignerContacts.h>
#include <vibratory_alignment/AlignerResult.h>
#include <vibratory_alignment/AlignerState.h>

#include "model/scaling.h"
#include "model/scene.h"
#include "node/frames.h"
#include "trial/outcome.h"
#include "trial/sampler.h"

namespace vibratory_alignment {

/// Size of the dimensionless units in SI; all 1 for a scene without scales.
OutputUnits ros_units(const Scene& scene);

/// Vector of the plane of motion in ROS axes, times `unit`.
geometry_msgs::Vector3 ros_vector(double x, double y, double unit = 1.0);

/// Tilt of the plane of motion, about -y in ROS axes.
geometry_msgs::Quaternion ros_tilt(double phi);

class Messages {
 public:
  Messages(const Scene& scene, const Frames& frames);

  const Frames& frames() const { return frames_; }
  const OutputUnits& units() const { return units_; }

  AlignerState state(const Sample& sample, const ros::Time& stamp) const;

  /// Force of the base on the part at an edge of the slot (Site::a1 or Site::a2) [N], in that edge's frame. It acts at
  /// the edge: no torque.
  geometry_msgs::WrenchStamped reaction(const Sample& sample, Site edge, const ros::Time& stamp) const;

  AlignerContacts contacts(const Sample& sample, const ros::Time& stamp) const;

  AlignerResult result(const TrialResult& result, const ros::Time& stamp) const;

 private:
  PlanarState dimensionless(const State& state) const;
  PlanarState si(const State& state) const;
  AlignerContact contact(const Sample& sample, Spot spot) const;

  std::string scene_name_, scene_units_;
  bool has_scales_, excites_tilt_;
  OutputUnits units_;
  Frames frames_;
};

}  // namespace vibratory_alignment
