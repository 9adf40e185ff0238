// A flight as it is seen from one of its times: where its points are, how they move, and for how long what happens next
// surely does not (docs/hybrid_step.md "Leaps").
#pragma once

#include "mechanics/contact_frame.h"
#include "mechanics/site_rules.h"
#include "mechanics/tilt.h"
#include "solver/bounded_curve.h"
#include "solver/flight.h"

namespace vibratory_alignment {

/// A site's point with its first two derivatives and a bound on the third.
struct PointMotion {
  Vec2 p, rate, acceleration;
  double jerk = 0.0;

  BoundedCurve along(const RegionCondition& condition) const {
    return {condition.value(p), condition.c1 * rate.x + condition.c2 * rate.y,
            condition.c1 * acceleration.x + condition.c2 * acceleration.y, jerk};
  }
};

/// How far an event is: the time within which it surely does not happen, and the length that is free now.
struct Clearance {
  double time = INFINITY, gap = INFINITY;
};

/// The flight as seen at one of its times, ahead or back.
class FlightView {
 public:
  /// Sees as far as `longest` from `motion`, whose bounds hold until there.
  FlightView(const System& system, const Flight::Motion& motion, double longest);

  /// From `motion`, to which this view reaches, back as far as `longest`: time runs the other way, and rates with it.
  FlightView back_from(const Flight::Motion& motion, double longest) const;

  double longest() const { return longest_; }

  /// In the axes of what the site may touch: an edge in those of the part, a corner in those of the world.
  PointMotion point(Site site) const;

  /// Where that point is.
  Vec2 place(Site site) const {
    if (is_edge(site)) {
      // body coordinates: r = A - C turned back by phi
      const double rx = side_of(site) * system_.slot_half_width - state_.x, ry = -state_.y;
      return {rx * tilt_.cos + ry * tilt_.sin, ry * tilt_.cos - rx * tilt_.sin};
    }
    const Vec2 r = corner_arm(site);
    return {state_.x + r.x, state_.y + r.y};
  }
  /// Bounds on the speeds of such points as far as this view reaches, which tell enough of most that are far.
  double most_speed_of_edges() const { return edge_speed_; }
  double most_speed_of_corners() const { return corner_speed_; }

  /// How long, up to `horizon`, the point surely stays out of the region, as long as any one of its conditions fails,
  /// and how far out it is now. `pinned`: the face on which it lies.
  Clearance clearance(const PointMotion& motion, const Region& region, Face pinned, double horizon) const;

  const Tilt& tilt() const { return tilt_; }
  /// omega now, and bounds on |omega| and on its rate |alpha| as far as this view reaches.
  double omega() const { return state_.omega; }
  double most_omega() const { return turning(outlook_.rate); }
  double most_alpha() const { return turning(outlook_.second); }

 private:
  /// From the mass centre to a corner.
  Vec2 corner_arm(Site site) const {
    const double beta = side_of(site) * system_.half_width, b = system_.base_distance;
    return {beta * tilt_.cos + b * tilt_.sin, beta * tilt_.sin - b * tilt_.cos};
  }
  PointMotion point_without_turning(Site site) const;
  // not inlined: what does not turn is not to pay for room that turning takes
  [[gnu::noinline]] PointMotion turning_point(Site site) const;
  void turn_edge(PointMotion& motion) const;
  void turn_corner(const Vec2& r, PointMotion& motion) const;
  void add_turning_jerk(double reach, PointMotion& motion) const;
  Vec2 acceleration() const { return {outlook_.acceleration[FreeAxes::kX], outlook_.acceleration[FreeAxes::kY]}; }
  /// What a bound on |x'| and one on |y'| make together, and the like.
  static double sum_of(const Quad& bounds) { return bounds[FreeAxes::kX] + bounds[FreeAxes::kY]; }
  /// Of the axes' values that of phi.
  static double turning(const Quad& of) { return of[FreeAxes::kPhi]; }

  const System& system_;
  State state_;
  double longest_;
  Tilt tilt_;
  FreeMotion::Outlook outlook_;
  double edge_speed_, corner_speed_;
};

}  // namespace vibratory_alignment
