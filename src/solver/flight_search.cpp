#include "solver/flight_search.h"

#include <algorithm>
#include <cmath>

#include "mechanics/site_rules.h"
#include "solver/base_recovery.h"
#include "solver/flight_view.h"

namespace vibratory_alignment {
namespace {

/// Leaps: shorter ones, in radians of what a series would have to follow, do not bring it further; longer ones, in
/// radians of the fastest motion, bound too loosely.
constexpr double kShortestLeap = 0.3;
constexpr double kLongestLeap = 6.0;

/// Leaps in one look: what comes closer and closer without touching is left to the series.
constexpr int kMostLeaps = 16;

/// The end of an unloaded contact is looked for until so many times its estimate.
constexpr double kClosingSpan = 1.5;

/// A landing is looked for where its estimate is at most so many times what is known to be free.
constexpr double kFarthestLanding = 2.5;

/// What comes later than so many times the time of what may come first is not looked at.
constexpr double kFarBeyond = 1.5;

/// A point touches a face alone where it is clear of corners, and all other points are clear of their faces, by this
/// part of the lengths of the bodies.
constexpr double kClear = 1e-6;

/// Halley's method has arrived when its step is this small beside the time it may go: the next would be its cube, or
/// with an estimated acceleration a part of its square.
constexpr double kLastStep = 1e-9;
constexpr int kMostSteps = 8;

/// Faces on which points lie where a look begins: they are judged by how they move off it.
using PinnedFaces = std::array<Face, kSiteCount>;

bool any_on_face(const PinnedFaces& pinned) {
  return std::any_of(pinned.begin(), pinned.end(), [](Face face) { return face != Face::none; });
}

/// The site that may have an event first: the time in which it surely has none, that in which nothing else has, and the
/// least gap of all that do not lie on a face.
struct Nearest {
  double time = INFINITY, others = INFINITY, gap = INFINITY;
  Site site = Site::a1;
  int half = 0;  ///< which of its regions
  PointMotion motion;
  bool is_outcome = false;

  /// True when this one becomes the nearest.
  bool take(const Clearance& clearance, bool on_face) {
    const double t = clearance.time;
    const bool nearer = t < time;
    others = std::min(others, nearer ? time : t);
    if (nearer) time = t;
    if (!on_face) gap = std::min(gap, clearance.gap);
    return nearer;
  }
  /// Nothing is asked much beyond what may come first, nor beyond what may come next.
  double horizon(double reach) const { return std::min({reach, others, time > 0.0 ? kFarBeyond * time : INFINITY}); }
  void is_at(Site at, int of_its_halves, const PointMotion& point) {
    site = at;
    half = of_its_halves;
    motion = point;
  }
};

class Search {
 public:
  Search(const System& system, const Flight& flight, double t, const ContactStates& contacts, const Pins& pins,
         const Recoveries& recoveries, const OutcomeGuards& outcomes)
      : system_(system),
        flight_(flight),
        t_(t),
        contacts_(contacts),
        pins_(pins),
        recoveries_(recoveries),
        outcomes_(outcomes) {}

  FlightOutlook run(const State& state, double longest) {
    FlightOutlook outlook;
    Flight::Motion motion;
    double longest_leap = 0.0;
    const auto look_from = [&](double now) {
      longest_leap = std::min(longest - outlook.time, kLongestLeap / flight_.rate(now));
      flight_.motion_at(now, now + longest_leap, motion);
    };
    look_from(t_);
    motion.state = outlook.end = state;
    PinnedFaces pinned{};
    for (std::size_t i = 0; i < kSiteCount; ++i) pinned[i] = pins_[i].face;
    for (int i = 0; i < kMostLeaps && outlook.time < longest; ++i) {
      // seen from the part edges turn about it, also where its turning knows no rate
      const double reach = std::min(longest_leap, kLongestLeap / std::abs(motion.state.omega));
      const FlightView view(system_, motion, reach);
      Nearest nearest;
      if (!find_nearest(view, pinned, reach, nearest)) break;
      const double time = std::min(nearest.time, reach), left = longest - outlook.time;
      // of sites alike, or all beyond reach, none is the nearest: the mirror image would begin with another one
      const bool is_nearest = nearest.time < std::min(nearest.others, reach);
      if (is_nearest && (lands(view, nearest, pinned[static_cast<std::size_t>(nearest.site)], outlook) ||
                         closes(view, nearest, left, outlook)))
        return outlook;
      // points that start on a face have to get off it first
      const bool is_short = time < left && time * flight_.series_rate() < kShortestLeap;
      if (is_short && !(time > 0.0 && any_on_face(pinned))) break;
      outlook.time = time == left ? longest : outlook.time + time;
      look_from(t_ + outlook.time);
      outlook.end = motion.state;
      pinned = {};
    }
    return outlook;
  }

 private:
  /// What may happen first, up to `reach`. False where this way of looking does not reach: a point that is inside the
  /// other body without contact.
  bool find_nearest(const FlightView& view, const PinnedFaces& pinned, double reach, Nearest& nearest) const {
    if (!ask<Site::a1>(view, pinned, reach, nearest) || !ask<Site::b1>(view, pinned, reach, nearest) ||
        !ask<Site::b1_floor>(view, pinned, reach, nearest))
      return false;
    const double horizon = nearest.horizon(reach);
    if (outcomes_.aligned) outcome_ahead(view, system_.aligned_depth, true, horizon, nearest);
    if (outcomes_.inserted) outcome_ahead(view, system_.inserted_depth, false, horizon, nearest);
    return true;
  }

  /// When the sites of a pair, whose first one is given, may have an event: both are asked the same, as the mirror
  /// image begins with the other one. False for a point that is inside the other body without contact.
  template <Site first>
  bool ask(const FlightView& view, const PinnedFaces& pinned, double reach, Nearest& nearest) const {
    if (!site_in_use(system_, first)) return true;
    const double horizon = nearest.horizon(reach);
    for (int i = static_cast<int>(first); i < static_cast<int>(first) + 2; ++i) {
      const auto site = static_cast<Site>(i);
      const Phase phase = contacts_[i].phase;
      if (phase == Phase::outside && pinned[i] == Face::none && is_far<first>(view, site, horizon, nearest)) continue;
      const PointMotion motion = view.point(site);
      if (phase == Phase::unloaded) {
        if (nearest.take({0.0, 0.0}, false)) nearest.is_at(site, 0, motion);
        continue;
      }
      if (phase != Phase::outside) return false;
      for (int half = 0; half < region_count(first); ++half) {
        const Clearance clearance = view.clearance(motion, site_region(system_, first, half), pinned[i], horizon);
        if (nearest.take(clearance, pinned[i] != Face::none)) nearest.is_at(site, half, motion);
      }
    }
    return true;
  }

  /// True when the site's speed is too low for any of its regions up to the horizon.
  template <Site first>
  bool is_far(const FlightView& view, Site site, double horizon, Nearest& nearest) const {
    const Vec2 place = view.place(site);
    double gap = INFINITY;
    for (int half = 0; half < region_count(first); ++half)
      gap = std::min(gap, gap_of(site_region(system_, first, half), place));
    const double speed = is_edge(first) ? view.most_speed_of_edges() : view.most_speed_of_corners();
    if (!(gap > speed * horizon)) return false;
    nearest.take({horizon, gap}, false);
    return true;
  }

  /// How far out of the region a point is.
  static double gap_of(const Region& region, const Vec2& place) {
    double gap = -INFINITY;
    for (int j = 0; j < region.count; ++j) gap = std::max(gap, -region.conditions[j].value(place));
    return gap;
  }

  /// Both corners have to be below `depth` and, if asked, between the walls (one that touches a wall is).
  void outcome_ahead(const FlightView& view, double depth, bool between_walls, double horizon, Nearest& nearest) const {
    const auto asked = [&](Site corner) {
      return insertion_region(system_, depth, between_walls, contacts_[static_cast<std::size_t>(corner)]);
    };
    double gap = -INFINITY;
    for (const Site site : {Site::b1, Site::b2}) gap = std::max(gap, gap_of(asked(site), view.place(site)));
    if (gap > view.most_speed_of_corners() * horizon) {
      nearest.take({horizon, gap}, false);
      return;
    }
    std::array<BoundedCurve, 6> curves;
    std::size_t count = 0, farthest = 0;
    for (const Site site : {Site::b1, Site::b2}) {
      const PointMotion motion = view.point(site);
      const Region region = asked(site);
      for (int j = 0; j < region.count; ++j) {
        curves[count] = motion.along(region.conditions[j]);
        if (curves[count].value < curves[farthest].value) farthest = count;
        ++count;
      }
    }
    // as long as one is missing; most often that which is farthest from holding
    Clearance clearance{curves[farthest].time_below(horizon, false), -curves[farthest].value};
    for (std::size_t k = 0; k < count && clearance.time < horizon; ++k)
      if (k != farthest) clearance.time = std::max(clearance.time, curves[k].time_below(horizon, false));
    if (nearest.take(clearance, false)) nearest.is_outcome = true;
  }

  /// Finds the landing of the nearest site if it is certain to be the next event: what the views ahead from here and
  /// back from there see together leaves no time for another one.
  bool lands(const FlightView& view, const Nearest& nearest, Face pinned, FlightOutlook& outlook) const {
    if (nearest.is_outcome || !(nearest.time > 0.0)) return false;
    // a base that recovers is touched later than one that has recovered
    if (recoveries_[static_cast<std::size_t>(nearest.site)].deformation > 0.0) return false;
    const Region region = site_region(system_, nearest.site, nearest.half);
    int crossed = 0, undecided = 0;
    for (int j = 0; j < region.count; ++j) {
      const RegionCondition& condition = region.conditions[j];
      if (condition.face != pinned && condition.value(nearest.motion.p) > 0.0) continue;
      ++undecided;
      crossed = j;
    }
    const Face face = region.conditions[crossed].face;
    if (undecided != 1 || !is_called_for(system_, face) || face == Face::floor) return false;
    const BoundedCurve crossing = nearest.motion.along(region.conditions[crossed]);
    const double estimate = crossing.estimated_rise();
    if (!(estimate <= std::min(kFarthestLanding * nearest.time, view.longest()))) return false;
    double s = estimate;
    if (!find_crossing(nearest.site, face, crossing, view.longest(), outlook.time, s)) return false;
    const double time = outlook.time + s;
    Flight::Motion motion;
    flight_.motion_at(t_ + time, t_ + time, motion);
    const FlightView back = view.back_from(motion, s);
    const PointMotion point = back.point(nearest.site);
    const double clear = kClear * (system_.half_width + system_.base_distance + system_.slot_half_width);
    for (int j = 0; j < region.count; ++j) {
      const RegionCondition& condition = region.conditions[j];
      if (j != crossed && !(condition.value(point.p) > clear)) return false;
    }
    PinnedFaces landed{};
    landed[static_cast<std::size_t>(nearest.site)] = face;
    Nearest before;
    const double unseen = std::max(s - nearest.time, 0.0);
    if (!find_nearest(back, landed, unseen, before) || !(before.time >= unseen && before.gap > clear)) return false;
    outlook.time = time;
    outlook.lands = true;
    outlook.event = {EventKind::touch, nearest.site, face};
    outlook.end = motion.state;
    return true;
  }

  /// Finds the end of an unloaded contact if it is certain to be the next event: no other site can have any before, and
  /// the depth falls through zero once.
  bool closes(const FlightView& view, const Nearest& nearest, double left, FlightOutlook& outlook) const {
    if (nearest.is_outcome) return false;
    const ContactState& contact = contacts_[static_cast<std::size_t>(nearest.site)];
    if (contact.phase != Phase::unloaded) return false;
    const Face face = contact.face;
    const ContactFrame frame = contact_frame(system_, face);
    const BoundedCurve crossing =
        nearest.motion.along({frame.sign * frame.n1, frame.sign * frame.n2, frame.offset, face}).negative();
    const double estimate = crossing.estimated_rise(), span = kClosingSpan * estimate;
    if (!(span <= std::min({left, nearest.others, view.longest()}))) return false;
    if (!stays_unloaded(view, crossing.negative(), face, span)) return false;
    const Region limits = face_limits(system_, face, nearest.motion.p);
    for (int j = 0; j < limits.count; ++j)
      if (!nearest.motion.along(limits.conditions[j]).stays_above(span)) return false;
    if (!(crossing.value < 0.0) || !crossing.rises(span) || !(crossing.lowest(span) > 0.0)) return false;
    double s = estimate;
    if (!find_crossing(nearest.site, face, crossing, span, outlook.time, s)) return false;
    outlook.time += s;
    outlook.lands = true;
    outlook.event = {EventKind::close, nearest.site, face};
    flight_.at(t_ + outlook.time, outlook.end);
    return true;
  }

  /// d k/h + d' of an unloaded contact, which is not above zero, falls.
  bool stays_unloaded(const FlightView& view, const BoundedCurve& depth, Face face, double span) const {
    if (system_.recovery) return false;
    const RelaxationRate relaxation = relaxation_rate(system_, face, view.tilt().cos, view.tilt().sin);
    const RelaxationBounds most = relaxation_bounds(system_, face);
    const double turning = view.most_omega();
    const double change = most.slope * turning,
                 bend_of_change = most.slope * view.most_alpha() + most.bend * turning * turning;
    const double acceleration = std::abs(depth.acceleration) + depth.jerk * span,
                 speed = std::abs(depth.rate) + acceleration * span, way = std::abs(depth.value) + speed * span;
    const double rate =
        relaxation.value * depth.rate + depth.acceleration + relaxation.slope * view.omega() * depth.value;
    const double bend =
        (relaxation.value + change * span) * acceleration + depth.jerk + 2.0 * change * speed + bend_of_change * way;
    return rate + 0.5 * bend * span < 0.0;
  }

  /// The zero of a site's depth within `span` from the time `from`, by Halley's method on the closed form. `s`: its
  /// estimate, then itself.
  bool find_crossing(Site site, Face face, const BoundedCurve& crossing, double span, double from, double& s) const {
    double acceleration = crossing.acceleration;
    for (int i = 0; i < kMostSteps; ++i) {
      State state;
      flight_.at(t_ + (from + s), state);
      const ContactKinematics k = contact_kinematics(system_, state, site, face);
      const double newton = -k.depth / k.depth_rate, rate = std::abs(k.depth_rate);
      // the acceleration there, by the trapezoid's rule from the two rates
      if (i == 0) acceleration = 2.0 * (rate - crossing.rate) / s - acceleration;
      const double step = newton / (1.0 + 0.5 * newton * acceleration / rate);
      s += step;
      if (!(s >= 0.0 && s <= span)) return false;
      // a turning point that is no zero stops it as well: there Newton's step is a long one
      if (std::abs(step) <= kLastStep * span) return std::abs(newton) <= 2.0 * std::abs(step);
    }
    return false;
  }

  const System& system_;
  const Flight& flight_;
  double t_;
  const ContactStates& contacts_;
  const Pins& pins_;
  const Recoveries& recoveries_;
  const OutcomeGuards& outcomes_;
};

}  // namespace

FlightOutlook look_ahead(const System& system, const Flight& flight, double t, const State& state,
                         const ContactStates& contacts, const Pins& pins, const Recoveries& recoveries,
                         const OutcomeGuards& outcomes, double longest) {
  return Search(system, flight, t, contacts, pins, recoveries, outcomes).run(state, longest);
}

}  // namespace vibratory_alignment
