#include "solver/flight_view.h"

#include <algorithm>

namespace vibratory_alignment {
namespace {

Vec2 turned(const Vec2& v) { return {-v.y, v.x}; }

}  // namespace

FlightView::FlightView(const System& system, const Flight::Motion& motion, double longest)
    : system_(system),
      state_(motion.state),
      longest_(longest),
      tilt_(tilt_of(state_.phi)),
      outlook_(motion.outlook),
      edge_speed_(sum_of(outlook_.rate)),
      corner_speed_(edge_speed_) {
  if (!system_.phi.moves) return;
  // an edge goes round the mass centre as seen from the part, which moves on meanwhile
  const double away = system_.slot_half_width + std::abs(state_.x) + std::abs(state_.y) + edge_speed_ * longest_;
  corner_speed_ += turning(outlook_.rate) * (system_.half_width + system_.base_distance);
  edge_speed_ += turning(outlook_.rate) * away;
}

FlightView FlightView::back_from(const Flight::Motion& motion, double longest) const {
  Flight::Motion back{motion.state, outlook_};
  back.state.vx = -motion.state.vx;
  back.state.vy = -motion.state.vy;
  back.state.omega = -motion.state.omega;
  back.outlook.acceleration = motion.outlook.acceleration;
  return {system_, back, longest};
}

VIBRATORY_ALIGNMENT_INLINE PointMotion FlightView::point_without_turning(Site site) const {
  const auto [c, s] = tilt_;
  PointMotion m;
  m.p = place(site);
  m.jerk = sum_of(outlook_.third);
  const Vec2 pull = acceleration();
  if (is_edge(site)) {
    m.rate = {-(state_.vx * c + state_.vy * s), state_.vx * s - state_.vy * c};
    m.acceleration = {-(pull.x * c + pull.y * s), pull.x * s - pull.y * c};
  } else {
    m.rate = {state_.vx, state_.vy};
    m.acceleration = pull;
  }
  return m;
}

PointMotion FlightView::point(Site site) const {
  return system_.phi.moves ? turning_point(site) : point_without_turning(site);
}

PointMotion FlightView::turning_point(Site site) const {
  PointMotion m = point_without_turning(site);
  if (is_edge(site))
    turn_edge(m);
  else
    turn_corner(corner_arm(site), m);
  return m;
}

Clearance FlightView::clearance(const PointMotion& m, const Region& region, Face pinned, double horizon) const {
  // what is farthest from holding keeps the point out for longest: often no other condition has to be asked
  int farthest = 0;
  for (int j = 1; j < region.count; ++j)
    if (region.conditions[j].value(m.p) < region.conditions[farthest].value(m.p)) farthest = j;
  const auto time_below = [&](int j) {
    const RegionCondition& condition = region.conditions[j];
    const bool from_zero = pinned != Face::none && condition.face == pinned;
    return m.along(condition).time_below(horizon, from_zero);
  };
  double time = time_below(farthest);
  for (int j = 0; j < region.count && time < horizon; ++j)
    if (j != farthest) time = std::max(time, time_below(j));
  return {time, -region.conditions[farthest].value(m.p)};
}

/// What the part's turning adds to the motion of an edge as seen from the part.
void FlightView::turn_edge(PointMotion& m) const {
  const double omega = state_.omega, alpha = turning(outlook_.acceleration);
  const double pull = sum_of(outlook_.second), speed = sum_of(outlook_.rate);
  const double turn = turning(outlook_.rate);
  const Vec2 jp = turned(m.p), jv = turned(m.rate);
  m.rate = {m.rate.x - omega * jp.x, m.rate.y - omega * jp.y};
  m.acceleration = {m.acceleration.x - 2.0 * omega * jv.x - alpha * jp.x - omega * omega * m.p.x,
                    m.acceleration.y - 2.0 * omega * jv.y - alpha * jp.y - omega * omega * m.p.y};
  m.jerk += 3.0 * (pull * turn + speed * (turning(outlook_.second) + turn * turn));
  add_turning_jerk(std::abs(m.p.x) + std::abs(m.p.y) + speed * longest_, m);
}

/// ... to that of a corner at r from the mass centre.
void FlightView::turn_corner(const Vec2& r, PointMotion& m) const {
  const double omega = state_.omega, alpha = turning(outlook_.acceleration);
  const Vec2 jr = turned(r);
  m.rate = {m.rate.x + omega * jr.x, m.rate.y + omega * jr.y};
  m.acceleration = {m.acceleration.x + alpha * jr.x - omega * omega * r.x,
                    m.acceleration.y + alpha * jr.y - omega * omega * r.y};
  add_turning_jerk(std::abs(r.x) + std::abs(r.y), m);
}

void FlightView::add_turning_jerk(double reach, PointMotion& m) const {
  const double turn = turning(outlook_.rate);
  m.jerk += reach * (turning(outlook_.third) + 3.0 * turn * turning(outlook_.second) + turn * turn * turn);
}

}  // namespace vibratory_alignment
