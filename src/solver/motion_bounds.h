// What surely does not happen in a segment, told by its start and by bounds on its accelerations: in most steps most
// sites are far from everything (docs/hybrid_step.md "Guards").
#pragma once

#include "mechanics/site_rules.h"
#include "mechanics/system.h"
#include "mechanics/tilt.h"
#include "solver/contact_mode.h"
#include "solver/drive_series.h"
#include "solver/segment.h"

namespace vibratory_alignment {

/// Which outcomes are still waited for.
struct OutcomeGuards {
  bool aligned = false, inserted = false;
};

/// Bounds of a segment with series for its first `duration`: sums of the absolute values of the terms of
/// (v(t) - v(0))/t, or in flight less, from the equations of the axes. A of an axis: |v(t) - v(0)| <= A t and
/// |q(t) - q(0) - v(0) t| <= A t^2/2.
Load3 most_accelerations(const System& system, const Segment& segment, const DriveForms& drives, double duration);

/// Of a segment, whose series are not read; it may have none. All that is passed outlives the bounds.
class MotionBounds {
 public:
  /// A site's point at the segment's start with its rate (edges: body coordinates, corners: world), and an acceleration
  /// that bounds how far from its tangent it goes.
  struct Point {
    Vec2 p, rate;
    double acceleration = 0.0;
  };

  MotionBounds(const System& system, const Segment& segment, const Pins& pins, const Tilt& start)
      : system_(system), segment_(segment), pins_(pins), start_(start) {}

  /// From here on the bounds are of this first part of the segment, in which accelerations are at most so large.
  void set(double duration, const Load3& acceleration);

  /// Largest speed and acceleration of the mass centre: sums of those of the axes.
  double speed() const { return speed_; }
  double acceleration() const { return acceleration_; }

  Vec2 start_point(Site site) const { return site_point(system_, segment_.begin, site, start_.cos, start_.sin); }
  Point point(Site site) const;

  /// Largest value of a condition, at most, where it begins with zero if `at_zero`.
  double largest(const RegionCondition& condition, const Point& point, bool at_zero = false) const;
  /// True when the condition holds throughout.
  bool surely_holds(const RegionCondition& condition, const Point& point) const;

  /// True when a site's point stays outside the region. `pinned`: face on which it starts.
  bool surely_outside(Site site, const Region& region, Face pinned) const;

  /// True when one of the lower corners fails something that is asked of it throughout.
  bool surely_misses(double depth, bool between_walls) const;

  /// True when nothing happens but by forces and friction of the loaded contacts. False also where a point is inside
  /// without force.
  [[gnu::noinline]] bool only_forces_act(const OutcomeGuards& outcomes) const;

 private:
  bool surely_outside(Site site) const;
  bool surely_stays_on(Site site, Face face) const;

  const System& system_;
  const Segment& segment_;
  const Pins& pins_;
  Tilt start_;
  double duration_ = 0.0;
  double speed_ = 0.0, turn_rate_ = 0.0, acceleration_ = 0.0, turn_acceleration_ = 0.0;
};

}  // namespace vibratory_alignment
