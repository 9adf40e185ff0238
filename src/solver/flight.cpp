#include "solver/flight.h"

#include <algorithm>
#include <cmath>

#include "mechanics/site_rules.h"

namespace vibratory_alignment {
namespace {

/// Halvings with which the end of a leap is found; what is lost is time, never a touch.
constexpr int kHalvings = 12;

/// value + rate s + 1/2 acceleration s^2 + 1/6 jerk s^3, jerk >= 0: above a condition that starts with these.
struct UpperCurve {
  double value, rate, acceleration, jerk;

  double at(double s) const { return value + s * (rate + s * (0.5 * acceleration + s * jerk / 6.0)); }

  /// Time in [0, longest] up to which the curve stays at or below zero. `from_zero`: it starts at zero and is judged by
  /// what follows.
  double time_below(double longest, bool from_zero) const {
    if (!from_zero && value >= 0.0) return 0.0;
    // on s > 0 it has at most one maximum, at the smaller root of its slope, then rises
    double low = 0.0, high = longest;
    const double discriminant = acceleration * acceleration - 2.0 * jerk * rate;
    if (from_zero && !(rate < 0.0)) return 0.0;
    if (discriminant > 0.0 && jerk > 0.0) {
      const double root = std::sqrt(discriminant);
      const double maximum = (-acceleration - root) / jerk, minimum = (-acceleration + root) / jerk;
      if (maximum > 0.0 && at(maximum) > 0.0) {
        high = std::min(high, maximum);
      } else if (minimum > 0.0) {
        low = std::min(minimum, longest);
      }
    }
    if (at(high) <= 0.0) return high;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (at(middle) <= 0.0 ? low : high) = middle;
    }
    return low;
  }
};

/// A site's point with its first two derivatives and a bound on the third.
struct PointMotion {
  Vec2 p, rate, acceleration;
  double jerk = 0.0;
};

Vec2 turned(const Vec2& v) { return {-v.y, v.x}; }

}  // namespace

void Flight::begin(const System& system, const State& state, const DriveForms& drives, const Instant& now) {
  start_ = now;
  drives_ = drives;
  x_.begin(system.x, state.x, state.vx, 0.0);
  y_.begin(system.y, state.y, state.vy, -system.weight);
  phi_.begin(system.phi, state.phi, state.omega, 0.0);
  for (int i = 0; i < drives.count; ++i) {
    FreeMotion& axis = drives.direction[i] == Direction::x ? x_ : drives.direction[i] == Direction::y ? y_ : phi_;
    axis.add(drives.form[i]);
  }
  rate_ = 0.0;
  for (FreeMotion* axis : {&x_, &y_, &phi_}) {
    axis->settle();
    rate_ = std::max(rate_, axis->rate());
  }
}

void Flight::at(double t, State& state) const {
  if (x_.exact()) x_.at(t, state.x, state.vx);
  if (y_.exact()) y_.at(t, state.y, state.vy);
  if (phi_.exact()) phi_.at(t, state.phi, state.omega);
}

Load3 Flight::drive_at(double t) const {
  Load3 load;
  for (int i = 0; i < drives_.count; ++i) {
    const DriveForm& form = drives_.form[i];
    const double value = form.at(t);
    (drives_.direction[i] == Direction::x ? load.x : drives_.direction[i] == Direction::y ? load.y : load.phi) += value;
  }
  return load;
}

double Flight::free_time(const System& system, double t, const State& state, const ContactStates& contacts,
                         const Pins& pins, const OutcomeGuards& outcomes, double longest) const {
  // accelerations now, bounds on velocities and higher derivatives until the end of the leap
  const Load3 drive = drive_at(t);
  const auto acceleration = [](const Axis& axis, double q, double v, double force) {
    return axis.inverse_inertia * (force - axis.damping * v - axis.stiffness * (q - axis.anchor));
  };
  const Vec2 a{acceleration(system.x, state.x, state.vx, drive.x),
               acceleration(system.y, state.y, state.vy, drive.y - system.weight)};
  const double alpha = acceleration(system.phi, state.phi, state.omega, drive.phi);
  const FreeMotion::Bounds bx = x_.bounds(t + longest), by = y_.bounds(t + longest), turn = phi_.bounds(t + longest);
  const double speed = bx.rate + by.rate, pull = bx.second + by.second, jerk = bx.third + by.third;

  const auto point_motion = [&](Site site) {
    PointMotion m;
    m.p = site_point(system, state, site);
    const double omega = state.omega;
    double reach = 0.0;
    if (is_edge(site)) {
      // body coordinates: r = A - C turned back by phi
      const double c = std::cos(state.phi), s = std::sin(state.phi);
      const Vec2 v{-(state.vx * c + state.vy * s), state.vx * s - state.vy * c};
      const Vec2 b{-(a.x * c + a.y * s), a.x * s - a.y * c};
      const Vec2 jp = turned(m.p), jv = turned(v);
      m.rate = {v.x - omega * jp.x, v.y - omega * jp.y};
      m.acceleration = {b.x - 2.0 * omega * jv.x - alpha * jp.x - omega * omega * m.p.x,
                        b.y - 2.0 * omega * jv.y - alpha * jp.y - omega * omega * m.p.y};
      reach = std::abs(m.p.x) + std::abs(m.p.y) + speed * longest;
    } else {
      const Vec2 r{m.p.x - state.x, m.p.y - state.y};
      const Vec2 jr = turned(r);
      m.rate = {state.vx + omega * jr.x, state.vy + omega * jr.y};
      m.acceleration = {a.x + alpha * jr.x - omega * omega * r.x, a.y + alpha * jr.y - omega * omega * r.y};
      reach = std::abs(r.x) + std::abs(r.y);
    }
    m.jerk = jerk + reach * (turn.third + 3.0 * turn.rate * turn.second + turn.rate * turn.rate * turn.rate);
    if (is_edge(site)) m.jerk += 3.0 * (pull * turn.rate + speed * (turn.second + turn.rate * turn.rate));
    return m;
  };
  const auto time_outside = [&](const RegionCondition& condition, const PointMotion& m, bool from_zero) {
    const UpperCurve curve{condition.value(m.p), condition.c1 * m.rate.x + condition.c2 * m.rate.y,
                           condition.c1 * m.acceleration.x + condition.c2 * m.acceleration.y, m.jerk};
    return curve.time_below(longest, from_zero);
  };

  double least = longest;
  for (int i = 0; i < kSiteCount; ++i) {
    const auto site = static_cast<Site>(i);
    if (!site_in_use(system, site)) continue;
    if (contacts[i].phase != Phase::outside) return 0.0;
    const PointMotion m = point_motion(site);
    for (int half = 0; half < region_count(site); ++half) {
      // outside as long as any one condition fails
      const Region region = site_region(system, site, half);
      double time = 0.0;
      for (int j = 0; j < region.count; ++j)
        time = std::max(time, time_outside(region.conditions[j], m, pins[i].face == region.conditions[j].face));
      least = std::min(least, time);
    }
    if (least == 0.0) return 0.0;
  }
  const auto leave_for_outcome = [&](double depth) {
    double time = 0.0;
    for (const Site site : {Site::b1, Site::b2})
      time = std::max(time, time_outside({0.0, -1.0, -depth, Face::none}, point_motion(site), false));
    least = std::min(least, time);
  };
  if (outcomes.aligned) leave_for_outcome(system.aligned_depth);
  if (outcomes.inserted) leave_for_outcome(system.inserted_depth);
  return least;
}

}  // namespace vibratory_alignment
