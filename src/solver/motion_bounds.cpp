#include "solver/motion_bounds.h"

#include <algorithm>
#include <cmath>

namespace vibratory_alignment {
namespace {

/// Sums of the absolute values of the terms of (v(t) - v(0))/t.
Load3 mean_accelerations(const Segment& segment, double duration) {
  Pair sum{};
  double turn = 0.0;
  for (int k = segment.order; k >= 1; --k) {
    sum = sum * duration + Pair{std::abs(segment.vx[k]), std::abs(segment.vy[k])};
    turn = turn * duration + std::abs(segment.omega[k]);
  }
  return {sum[0], sum[1], turn};
}

/// Of an axis: in flight from its equation, where its spring and damper act on at most what the acceleration itself
/// makes of the start; else the sum of its series' terms.
double most_acceleration(const Axis& axis, double q, double v, double force, double terms, bool in_flight, double h) {
  if (!axis.moves) return 0.0;
  const double speed = std::abs(v);
  const double feedback = axis.inverse_inertia * (0.5 * axis.stiffness * h * h + axis.damping * h);
  if (in_flight && feedback < 0.5) {
    const double start = force + axis.stiffness * (std::abs(q - axis.anchor) + speed * h) + axis.damping * speed;
    return axis.inverse_inertia * start / (1.0 - feedback);
  }
  return terms;
}

}  // namespace

Load3 most_accelerations(const System& system, const Segment& segment, const DriveForms& drives, double duration) {
  double force_x = 0.0, force_y = system.weight, moment = 0.0;
  for (int i = 0; i < drives.count; ++i) {
    const DriveForm& form = drives.form[i];
    const double most = std::abs(form.constant) + std::abs(form.slope) * duration + std::abs(form.amplitude);
    (drives.direction[i] == Direction::x ? force_x : drives.direction[i] == Direction::y ? force_y : moment) += most;
  }
  const Load3 terms = mean_accelerations(segment, duration);
  const bool in_flight = segment.loaded_count == 0;
  return {most_acceleration(system.x, segment.x[0], segment.vx[0], force_x, terms.x, in_flight, duration),
          most_acceleration(system.y, segment.y[0], segment.vy[0], force_y, terms.y, in_flight, duration),
          most_acceleration(system.phi, segment.phi[0], segment.omega[0], moment, terms.phi, in_flight, duration)};
}

void MotionBounds::set(double duration, const Load3& acceleration) {
  duration_ = duration;
  acceleration_ = acceleration.x + acceleration.y;
  turn_acceleration_ = acceleration.phi;
  speed_ = std::abs(segment_.begin.vx) + std::abs(segment_.begin.vy) + acceleration_ * duration_;
  turn_rate_ = std::abs(segment_.begin.omega) + turn_acceleration_ * duration_;
}

MotionBounds::Point MotionBounds::point(Site site) const {
  const double vx = segment_.begin.vx, vy = segment_.begin.vy, omega = segment_.begin.omega;
  Point point;
  point.p = start_point(site);
  double reach = 0.0;
  if (is_edge(site)) {
    // (u, w)' = -(v.e1, v.e2) + omega (w, -u)
    const double c = start_.cos, s = start_.sin;
    point.rate = {-(vx * c + vy * s) + omega * point.p.y, vx * s - vy * c - omega * point.p.x};
    reach = std::abs(point.p.x) + std::abs(point.p.y) + speed_ * duration_;
  } else {
    const double rx = point.p.x - segment_.begin.x, ry = point.p.y - segment_.begin.y;
    point.rate = {vx - omega * ry, vy + omega * rx};
    reach = std::abs(rx) + std::abs(ry);
  }
  point.acceleration =
      acceleration_ + 2.0 * turn_rate_ * speed_ + reach * (turn_acceleration_ + turn_rate_ * turn_rate_);
  return point;
}

double MotionBounds::largest(const RegionCondition& condition, const Point& point, bool at_zero) const {
  const double rate = condition.c1 * point.rate.x + condition.c2 * point.rate.y;
  // a parabola that opens upward: largest at an end
  const double change = (rate + 0.5 * point.acceleration * duration_) * duration_;
  if (at_zero) return change;
  const double value = condition.value(point.p);
  return std::max(value, value + change);
}

bool MotionBounds::surely_holds(const RegionCondition& condition, const Point& point) const {
  const RegionCondition opposite{-condition.c1, -condition.c2, -condition.c0, condition.face};
  return largest(opposite, point) < 0.0;
}

bool MotionBounds::surely_outside(Site site, const Region& region, Face pinned) const {
  const Point of_site = point(site);
  for (int j = 0; j < region.count; ++j) {
    const RegionCondition& condition = region.conditions[j];
    if (largest(condition, of_site, pinned != Face::none && condition.face == pinned) < 0.0) return true;
  }
  return false;
}

bool MotionBounds::surely_outside(Site site) const {
  const Face pinned = pins_[static_cast<std::size_t>(site)].face;
  for (int half = 0; half < region_count(site); ++half)
    if (!surely_outside(site, site_region(system_, site, half), pinned)) return false;
  return true;
}

bool MotionBounds::surely_stays_on(Site site, Face face) const {
  const Point of_site = point(site);
  const Region limits = face_limits(system_, face, of_site.p);
  for (int j = 0; j < limits.count; ++j)
    if (!surely_holds(limits.conditions[j], of_site)) return false;
  return true;
}

bool MotionBounds::surely_misses(double depth, bool between_walls) const {
  for (const Site corner : {Site::b1, Site::b2}) {
    const ContactState& contact = segment_.contacts[static_cast<std::size_t>(corner)];
    if (surely_outside(corner, insertion_region(system_, depth, between_walls, contact), Face::none)) return true;
  }
  return false;
}

bool MotionBounds::only_forces_act(const OutcomeGuards& outcomes) const {
  for (int i = 0, end = site_end(system_); i < end; ++i) {
    const auto site = static_cast<Site>(i);
    if (!site_in_use(system_, site)) continue;
    const ContactState& contact = segment_.contacts[static_cast<std::size_t>(i)];
    if (contact.phase == Phase::loaded ? !surely_stays_on(site, contact.face)
                                       : contact.phase != Phase::outside || !surely_outside(site))
      return false;
  }
  return !(outcomes.aligned && !surely_misses(system_.aligned_depth, true)) &&
         !(outcomes.inserted && !surely_misses(system_.inserted_depth, false));
}

}  // namespace vibratory_alignment
