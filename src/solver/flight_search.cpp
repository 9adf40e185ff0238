#include "solver/flight_search.h"

#include <algorithm>
#include <cmath>

#include "mechanics/site_rules.h"

namespace vibratory_alignment {
namespace {

/// Leaps, in radians of the fastest motion: shorter ones do not bring it further, longer ones bound too loosely.
constexpr double kShortestLeap = 0.3;
constexpr double kLongestLeap = 6.0;

/// Leaps in one look: what comes closer and closer without touching is left to the series.
constexpr int kMostLeaps = 16;

/// Halvings with which the end of a leap is found; what is lost is time, never a touch.
constexpr int kHalvings = 8;

/// A landing is looked for until so many times its estimate.
constexpr double kLandingSpan = 1.5;

/// Halley's method has arrived when its step is this small beside the span: the next would be its cube, or with an
/// estimated acceleration a part of its square.
constexpr double kLastStep = 1e-7;
constexpr int kMostSteps = 8;

/// A condition ahead: value + rate s + 1/2 acceleration s^2, with an error of at most 1/6 jerk s^3.
struct Curve {
  double value, rate, acceleration, jerk;

  double highest(double s) const { return value + s * (rate + s * (0.5 * acceleration + s * jerk / 6.0)); }
  double lowest(double s) const { return value + s * (rate + s * (0.5 * acceleration - s * jerk / 6.0)); }
  Curve negative() const { return {-value, -rate, -acceleration, jerk}; }

  /// True when the curve surely stays above zero on [0, span].
  bool stays_above(double span) const {
    return value - span * (std::abs(rate) + span * (0.5 * std::abs(acceleration) + span * jerk / 6.0)) > 0.0;
  }

  /// True when the curve surely rises on all of [0, span].
  bool rises(double span) const { return rate + span * (std::min(acceleration, 0.0) - 0.5 * span * jerk) > 0.0; }

  /// First positive zero of value + rate s + 1/2 acceleration s^2 for value < 0, rate > 0; infinity if there is none.
  double estimated_rise() const {
    const double discriminant = rate * rate - 2.0 * acceleration * value;
    return discriminant < 0.0 ? INFINITY : -2.0 * value / (rate + std::sqrt(discriminant));
  }

  /// Time in [0, longest] up to which the curve surely stays at or below zero. `from_zero`: it starts at zero and is
  /// judged by what follows.
  double time_below(double longest, bool from_zero) const {
    if (from_zero ? !(rate < 0.0) : value >= 0.0) return 0.0;
    // on s > 0 its upper bound has at most one maximum, at the smaller root of its slope, then rises
    double low = 0.0, high = longest;
    const double discriminant = acceleration * acceleration - 2.0 * jerk * rate;
    if (discriminant > 0.0 && jerk > 0.0) {
      const double root = std::sqrt(discriminant);
      const double maximum = (-acceleration - root) / jerk, minimum = (-acceleration + root) / jerk;
      if (maximum > 0.0 && highest(maximum) > 0.0) {
        high = std::min(high, maximum);
      } else if (minimum > 0.0) {
        low = std::min(minimum, longest);
      }
    }
    if (highest(high) <= 0.0) return high;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (highest(middle) <= 0.0 ? low : high) = middle;
    }
    return low;
  }
};

/// A site's point with its first two derivatives and a bound on the third.
struct PointMotion {
  Vec2 p, rate, acceleration;
  double jerk = 0.0;

  Curve along(const RegionCondition& condition) const {
    return {condition.value(p), condition.c1 * rate.x + condition.c2 * rate.y,
            condition.c1 * acceleration.x + condition.c2 * acceleration.y, jerk};
  }
};

Vec2 turned(const Vec2& v) { return {-v.y, v.x}; }

/// The flight as seen at one of its times.
class View {
 public:
  View(const System& system, const Flight& flight, double t, const Flight::Motion& motion, double longest)
      : system_(system),
        state_(motion.state),
        longest_(longest),
        c_(std::cos(state_.phi)),
        s_(std::sin(state_.phi)),
        acceleration_{motion.ax, motion.ay},
        turn_acceleration_(motion.alpha),
        bounds_(flight.bounds(t, t + longest)) {}

  double longest() const { return longest_; }

  PointMotion point(Site site) const {
    PointMotion m;
    m.jerk = bounds_.x.third + bounds_.y.third;
    if (is_edge(site)) {
      // body coordinates: r = A - C turned back by phi
      const double rx = side_of(site) * system_.slot_half_width - state_.x, ry = -state_.y;
      const Vec2& a = acceleration_;
      m.p = {rx * c_ + ry * s_, ry * c_ - rx * s_};
      m.rate = {-(state_.vx * c_ + state_.vy * s_), state_.vx * s_ - state_.vy * c_};
      m.acceleration = {-(a.x * c_ + a.y * s_), a.x * s_ - a.y * c_};
      if (system_.phi.moves) turn_edge(m);
    } else {
      const double beta = side_of(site) * system_.half_width, b = system_.base_distance;
      const Vec2 r{beta * c_ + b * s_, beta * s_ - b * c_};
      m.p = {state_.x + r.x, state_.y + r.y};
      m.rate = {state_.vx, state_.vy};
      m.acceleration = acceleration_;
      if (system_.phi.moves) turn_corner(r, m);
    }
    return m;
  }

  /// Time in which the point surely stays out of the region: as long as any one of its conditions fails.
  double time_outside(const PointMotion& m, const Region& region, Face pinned) const {
    // what is farthest from holding keeps the point out for longest: often no other condition has to be asked
    int farthest = 0;
    for (int j = 1; j < region.count; ++j)
      if (region.conditions[j].value(m.p) < region.conditions[farthest].value(m.p)) farthest = j;
    const auto time_below = [&](int j) {
      const RegionCondition& condition = region.conditions[j];
      const bool from_zero = pinned != Face::none && condition.face == pinned;
      return m.along(condition).time_below(longest_, from_zero);
    };
    double time = time_below(farthest);
    for (int j = 0; j < region.count && time < longest_; ++j)
      if (j != farthest) time = std::max(time, time_below(j));
    return time;
  }

  double stiffness(Face face) const { return stiffness_of(system_, face, c_, s_); }
  double damping(Face face) const { return damping_of(system_, face, c_, s_); }

 private:
  /// What the part's turning adds to the motion of an edge as seen from the part.
  void turn_edge(PointMotion& m) const {
    const double omega = state_.omega, alpha = turn_acceleration_;
    const double pull = bounds_.x.second + bounds_.y.second, speed = bounds_.x.rate + bounds_.y.rate;
    const FreeMotion::Bounds& turn = bounds_.phi;
    const Vec2 jp = turned(m.p), jv = turned(m.rate);
    m.rate = {m.rate.x - omega * jp.x, m.rate.y - omega * jp.y};
    m.acceleration = {m.acceleration.x - 2.0 * omega * jv.x - alpha * jp.x - omega * omega * m.p.x,
                      m.acceleration.y - 2.0 * omega * jv.y - alpha * jp.y - omega * omega * m.p.y};
    m.jerk += 3.0 * (pull * turn.rate + speed * (turn.second + turn.rate * turn.rate));
    add_turning_jerk(std::abs(m.p.x) + std::abs(m.p.y) + speed * longest_, m);
  }

  /// ... to that of a corner at r from the mass centre.
  void turn_corner(const Vec2& r, PointMotion& m) const {
    const double omega = state_.omega, alpha = turn_acceleration_;
    const Vec2 jr = turned(r);
    m.rate = {m.rate.x + omega * jr.x, m.rate.y + omega * jr.y};
    m.acceleration = {m.acceleration.x + alpha * jr.x - omega * omega * r.x,
                      m.acceleration.y + alpha * jr.y - omega * omega * r.y};
    add_turning_jerk(std::abs(r.x) + std::abs(r.y), m);
  }

  void add_turning_jerk(double reach, PointMotion& m) const {
    const FreeMotion::Bounds& turn = bounds_.phi;
    m.jerk += reach * (turn.third + 3.0 * turn.rate * turn.second + turn.rate * turn.rate * turn.rate);
  }

  const System& system_;
  const State& state_;
  double longest_, c_, s_;
  Vec2 acceleration_;
  double turn_acceleration_;
  Flight::Bounds bounds_;
};

/// The site that is nearest to an event, and the time in which no other one can have any.
struct Nearest {
  double time = INFINITY, others = INFINITY;
  Site site = Site::a1;
  Region region;
  PointMotion motion;
  bool is_outcome = false;

  /// True when this one becomes the nearest.
  bool take(double t) {
    const bool nearer = t < time;
    others = std::min(others, nearer ? time : t);
    if (nearer) time = t;
    return nearer;
  }
};

class Search {
 public:
  Search(const System& system, const Flight& flight, double t, const ContactStates& contacts, const Pins& pins,
         const OutcomeGuards& outcomes)
      : system_(system), flight_(flight), t_(t), contacts_(contacts), pins_(pins), outcomes_(outcomes) {}

  FlightOutlook run(const State& state, double longest) {
    FlightOutlook outlook;
    Flight::Motion motion = flight_.motion_at(t_);
    motion.state = outlook.end = state;
    for (int i = 0; i < kMostLeaps; ++i) {
      const double left = longest - outlook.time, rate = flight_.rate(t_ + outlook.time);
      const View view(system_, flight_, t_ + outlook.time, motion, std::min(left, kLongestLeap / rate));
      Nearest nearest;
      if (!find_nearest(view, i == 0, nearest)) break;
      const double time = std::min(nearest.time, view.longest());
      // a point that starts on its face has to get off it first
      const bool gets_off = i == 0 && time > 0.0 && pins_[static_cast<std::size_t>(nearest.site)].face != Face::none;
      if (time < left && time * rate < kShortestLeap && !gets_off) {
        if (!lands(view, nearest, outlook, left, i == 0)) break;
        return outlook;
      }
      outlook.time = time == left ? longest : outlook.time + time;
      motion = flight_.motion_at(t_ + outlook.time);
      outlook.end = motion.state;
      if (outlook.time >= longest) break;
    }
    return outlook;
  }

 private:
  /// False where this way of looking does not reach: a point that is inside the other body without contact.
  bool find_nearest(const View& view, bool at_start, Nearest& nearest) const {
    for (int i = 0; i < kSiteCount; ++i) {
      const auto site = static_cast<Site>(i);
      if (!site_in_use(system_, site)) continue;
      const Phase phase = contacts_[i].phase;
      if (phase != Phase::outside && phase != Phase::unloaded) return false;
      const PointMotion motion = view.point(site);
      if (phase == Phase::unloaded) {
        if (nearest.take(0.0)) {
          nearest.site = site;
          nearest.motion = motion;
        }
        continue;
      }
      for (int half = 0; half < region_count(site); ++half) {
        const Region region = site_region(system_, site, half);
        if (!nearest.take(view.time_outside(motion, region, at_start ? pins_[i].face : Face::none))) continue;
        nearest.site = site;
        nearest.motion = motion;
        nearest.region = region;
      }
    }
    if (outcomes_.aligned) outcome_ahead(view, system_.aligned_depth, true, nearest);
    if (outcomes_.inserted) outcome_ahead(view, system_.inserted_depth, false, nearest);
    return true;
  }

  /// Both corners have to be below `depth` and, if asked, between the walls.
  void outcome_ahead(const View& view, double depth, bool between_walls, Nearest& nearest) const {
    const double l = system_.slot_half_width;
    const RegionCondition asked[] = {
        {0.0, -1.0, -depth, Face::none}, {1.0, 0.0, l, Face::none}, {-1.0, 0.0, l, Face::none}};
    double time = 0.0;
    for (const Site site : {Site::b1, Site::b2}) {
      const PointMotion motion = view.point(site);
      for (int j = 0; j < (between_walls ? 3 : 1) && time < view.longest(); ++j)
        time = std::max(time, motion.along(asked[j]).time_below(view.longest(), false));
    }
    if (nearest.take(time)) nearest.is_outcome = true;
  }

  /// Finds the event of the nearest site if it is certain to be the next one: no other site can have any before, and
  /// its condition rises through zero once. `pinned`: N of an unloaded contact has just been zero.
  bool lands(const View& view, const Nearest& nearest, FlightOutlook& outlook, double left, bool pinned) const {
    if (nearest.is_outcome) return false;
    const ContactState& contact = contacts_[static_cast<std::size_t>(nearest.site)];
    const bool unloaded = contact.phase == Phase::unloaded;
    const double most = std::min({left, nearest.others, view.longest()});
    Curve crossing{};
    Face face = contact.face;
    double span = 0.0;
    if (unloaded) {
      const ContactFrame frame = contact_frame(system_, face);
      crossing = nearest.motion.along({frame.sign * frame.n1, frame.sign * frame.n2, frame.offset, face}).negative();
      span = kLandingSpan * crossing.estimated_rise();
      if (!(span <= most) || !stays_unloaded(view, crossing.negative(), face, span, pinned)) return false;
      const Region limits = face_limits(system_, face, nearest.motion.p);
      for (int j = 0; j < limits.count; ++j)
        if (!nearest.motion.along(limits.conditions[j]).stays_above(span)) return false;
    } else {
      int undecided = 0;
      for (int j = 0; j < nearest.region.count; ++j) {
        const Curve curve = nearest.motion.along(nearest.region.conditions[j]);
        if (curve.value > 0.0) continue;
        ++undecided;
        crossing = curve;
        face = nearest.region.conditions[j].face;
      }
      if (undecided != 1 || !is_called_for(system_, face) || face == Face::floor) return false;
      span = kLandingSpan * crossing.estimated_rise();
      if (!(span <= most)) return false;
      for (int j = 0; j < nearest.region.count; ++j)
        if (nearest.region.conditions[j].face != face &&
            !nearest.motion.along(nearest.region.conditions[j]).stays_above(span))
          return false;
    }
    if (!(crossing.value < 0.0) || !crossing.rises(span) || !(crossing.lowest(span) > 0.0)) return false;
    return find_crossing(nearest.site, face, crossing, span, outlook) &&
           (outlook.event = {unloaded ? EventKind::close : EventKind::touch, nearest.site, face}, true);
  }

  /// k d + h d' of an unloaded contact, which has been zero, falls from the start and stays below zero.
  bool stays_unloaded(const View& view, const Curve& depth, Face face, double span, bool pinned) const {
    if (system_.recovery || (is_part_face(face) && !system_.isotropic)) return false;
    const double k = view.stiffness(face), h = view.damping(face);
    const double force = k * depth.value + h * depth.rate, rate = k * depth.rate + h * depth.acceleration;
    const double bend = k * (std::abs(depth.acceleration) + depth.jerk * span) + h * depth.jerk;
    return (pinned || force < 0.0) && rate + 0.5 * bend * span < 0.0;
  }

  /// The zero of a site's depth within `span` from the outlook's end, by Halley's method on the closed form.
  bool find_crossing(Site site, Face face, const Curve& crossing, double span, FlightOutlook& outlook) const {
    double s = span / kLandingSpan, acceleration = crossing.acceleration;
    for (int i = 0; i < kMostSteps; ++i) {
      State state;
      flight_.at(t_ + outlook.time + s, state);
      const ContactKinematics k = contact_kinematics(system_, state, site, face);
      const double newton = -k.depth / k.depth_rate, rate = std::abs(k.depth_rate);
      // the acceleration changes steadily
      if (i == 0) acceleration = 2.0 * (rate - crossing.rate) / s - acceleration;
      const double step = newton / (1.0 + 0.5 * newton * acceleration / rate);
      s += step;
      if (!(s >= 0.0 && s <= span)) return false;
      if (std::abs(step) > kLastStep * span) continue;
      outlook.time += s;
      outlook.lands = true;
      flight_.at(t_ + outlook.time, outlook.end);
      return true;
    }
    return false;
  }

  const System& system_;
  const Flight& flight_;
  double t_;
  const ContactStates& contacts_;
  const Pins& pins_;
  const OutcomeGuards& outcomes_;
};

}  // namespace

FlightOutlook look_ahead(const System& system, const Flight& flight, double t, const State& state,
                         const ContactStates& contacts, const Pins& pins, const OutcomeGuards& outcomes,
                         double longest) {
  return Search(system, flight, t, contacts, pins, outcomes).run(state, longest);
}

}  // namespace vibratory_alignment
