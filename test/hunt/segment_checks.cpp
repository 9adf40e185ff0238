#include "segment_checks.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "../support/touch_point.h"
#include "solver/base_recovery.h"

namespace vibratory_alignment::hunt {
namespace {

using test::Touch;
using test::touch_point;
using test::TouchPoint;

constexpr double kDigits = 1e-13;
constexpr double kTimeDigits = 4e-16, kPlaceDigits = 4e-16;
constexpr double kSlipErrors = 1e3;     ///< V also holds what T was wrong by in the segments before
constexpr double kForceDigits = 1e-15;  ///< forces that are in balance
/// Of T that contacts share, each one's (docs/hybrid_step.md "Rounding in these decisions").
constexpr double kSharedForce = 4e-10;
constexpr double kFastestRecovery = 1e12;  ///< a base that recovers at this rate is taken to do so at once
constexpr double kWorstCut = 1e-4;         ///< part of its terms that a force's series may leave out
/// An implicit step fulfils the equations of motion at its end (but where an event has ended it at once, relative to
/// the time: it is not taken again to that). Before that its polynomials leave out what it passes over, of which a
/// damper makes forces, but not more than so many times N (docs/implicit_steps.md "Rings").
constexpr double kPassedOverForce = 1.0, kNoProgress = 1e-15;
constexpr double kSeriesPoints[] = {0.0, 0.13, 0.5, 0.87, 1.0};
constexpr int kFlightPoints = 20;  ///< a leap in flight is long

/// Sum of the absolute terms of a series: what its value is rounded against.
double magnitude_at(const Series& series, int order, double t) {
  double value = 0.0;
  for (int k = order; k >= 0; --k) value = value * t + std::abs(series[static_cast<std::size_t>(k)]);
  return value;
}

/// What a series leaves out: less than its last two terms, and than kWorstCut of all.
double cut_of(const Series& series, int order, double t) {
  const auto size = [&](int k) { return std::abs(series[static_cast<std::size_t>(k)]) * std::pow(t, k); };
  const double last = order > 0 ? size(order - 1) + size(order) : 0.0;
  return std::min(last, kWorstCut * magnitude_at(series, order, t));
}

/// Lengths that a depth is the difference of; the last digit of a tilt of many turns moves the corners, too.
double length_of(const System& s, const State& q) {
  const double turns = std::abs(q.phi) * (s.half_width + s.base_distance);
  return std::abs(q.x) + std::abs(q.y) + turns + s.half_width + s.base_distance + s.slot_half_width +
         (s.has_floor ? s.floor_depth : 0.0);
}

/// Speeds that a rate is the difference of: those at `q` and those that the segment's series are sums of.
double speed_of(const System& s, const Segment& g, const State& q) {
  if (g.layer_crossing != nullptr) {
    const auto most = [&](double State::*speed) { return std::abs(g.begin.*speed) + std::abs(g.end.*speed); };
    return most(&State::vx) + most(&State::vy) + most(&State::omega) * length_of(s, q);
  }
  const auto size = [&](const Series& v, double now) { return std::abs(now) + magnitude_at(v, g.order, g.duration); };
  return size(g.vx, q.vx) + size(g.vy, q.vy) + size(g.omega, q.omega) * length_of(s, q);
}

/// Fastest of the gripper's own rates, at which the last digit of a place becomes a speed.
double gripper_rate(const System& s) {
  const auto square = [](const Axis& axis) { return axis.stiffness * axis.inverse_inertia; };
  return std::sqrt(std::max({square(s.x), square(s.y), square(s.phi)}));
}

/// Largest acceleration of the contact point for a force of one.
double mobility(const System& s, const TouchPoint& p) {
  return s.x.inverse_inertia + s.y.inverse_inertia + (p.rx * p.rx + p.ry * p.ry) * s.phi.inverse_inertia;
}

/// Sizes of what N and T of a loaded contact are sums of, and what is cut off of N.
struct ForceTerms {
  double normal, tangential, normal_cut;
};

ForceTerms force_terms(const Segment& segment, int i, double t) {
  if (segment.layer_crossing != nullptr) {
    const ContactValues values = contact_at(segment, i, t);
    return {std::abs(values.normal_force), std::abs(values.tangential_force), 0.0};
  }
  const ContactSeries& contact = segment.loaded[static_cast<std::size_t>(i)];
  return {magnitude_at(contact.normal_force, segment.order, t),
          magnitude_at(contact.tangential_force, segment.order, t), cut_of(contact.normal_force, segment.order, t)};
}

class SegmentCheck {
 public:
  SegmentCheck(const System& system, const Digits& digits, const Segment& segment)
      : system_(system),
        tolerance_(digits.tolerance),
        fastest_(digits.fastest),
        segment_(segment),
        digits_(kDigits + (segment.coarse || digits.by_implicit_steps ? 1.0 : kCut) * digits.tolerance) {}

  std::optional<Fault> at(double t) {
    t_ = t;
    state_ = t >= segment_.duration ? segment_.end : state_at(segment_, t);
    const State& q = state_;
    if (!std::isfinite(q.x + q.y + q.phi + q.vx + q.vy + q.omega)) return fault(Invariant::finite, "state", q.x);
    for (int i = 0; i < segment_.loaded_count; ++i)
      if (auto found = loaded(i)) return found;
    for (int site = 0; site < kSiteCount; ++site)
      if (auto found = outside(static_cast<Site>(site))) return found;
    return {};
  }

  /// What is touched at the segment's end is touched at its surface.
  std::optional<Fault> touches() {
    t_ = segment_.duration;
    state_ = segment_.end;
    for (int i = 0; i < segment_.event_count; ++i) {
      const Event& event = segment_.events[static_cast<std::size_t>(i)];
      if (event.kind != EventKind::touch) continue;
      const double depth = touch_point(system_, state_, {event.site, event.face}).depth - surface_of(event.site);
      if (depth > depth_noise() + at_once()) return fault(Invariant::no_passing, "depth at a touch", depth);
    }
    return {};
  }

 private:
  Fault fault(Invariant invariant, const char* what, double value) const {
    std::ostringstream text;
    text.precision(10);
    text << what << " = " << value << " at t = " << segment_.start.value() << " + " << t_;
    return {invariant, text.str()};
  }

  /// A depth is known to the digits of its lengths, and to how far the last digit of the time moves the part.
  double depth_noise() const {
    const double time = segment_.start.value() + t_;
    return digits_ * length_of(system_, state_) + kTimeDigits * time * speed_of(system_, segment_, state_);
  }

  std::optional<Fault> loaded(int i) const {
    const Site site = segment_.loaded[static_cast<std::size_t>(i)].site;
    const TouchPoint p = touch_point(system_, state_, {site, segment_.contacts[static_cast<std::size_t>(site)].face});
    const ContactValues values = contact_at(segment_, i, t_);
    const double n = values.normal_force, t = values.tangential_force;
    const ForceTerms terms = force_terms(segment_, i, t_);
    if (!std::isfinite(n) || !std::isfinite(t)) return fault(Invariant::finite, "contact force", n + t);

    const double speed = speed_of(system_, segment_, state_);
    const double rate_noise =
        digits_ * speed + kDigits * fastest_ + kPlaceDigits * gripper_rate(system_) * length_of(system_, state_);
    const double n_noise =
        p.stiffness * depth_noise() + p.damping * rate_noise + (kDigits + tolerance_) * terms.normal + terms.normal_cut;
    if (n < -n_noise) return fault(Invariant::base_pushes, "N", n);
    const bool hardly = segment_.duration <= kNoProgress * segment_.start.value();
    const bool at_end = !segment_.coarse || (t_ >= segment_.duration && !hardly);
    const double passed_over = at_end ? 0.0 : kPassedOverForce * std::max(0.0, std::min(n, p.normal_force));
    if (std::abs(n - p.normal_force) > 10.0 * n_noise + passed_over)
      return fault(Invariant::base_pushes, "N - (k d + h d')", n - p.normal_force);

    // V is wrong by its digits and by what wrong forces make of it in the segment
    const double limit = system_.friction * std::max(n, 0.0);
    double t_noise = system_.friction * n_noise + (kDigits + tolerance_) * terms.tangential;
    const double slip_noise =
        kSlipErrors * (digits_ + tolerance_) * speed + mobility(system_, p) * (n_noise + t_noise) * segment_.duration;
    if (segment_.loaded_count > 1) t_noise += kSharedForce * limit;
    if (system_.regularization > 0.0) t_noise += limit * slip_noise / system_.regularization;
    if (std::abs(t) > limit + t_noise) return fault(Invariant::friction_cone, "|T| - f N", std::abs(t) - limit);
    // judged by the energy that it feeds in, for a last digit of V may stay where an event has ended a segment at once
    const double power_noise = std::abs(t) * slip_noise + t_noise * std::abs(p.slip);
    if ((t * p.slip - power_noise) * segment_.duration > energy_noise(system_, segment_))
      return fault(Invariant::friction_brakes, "T V", t * p.slip);
    return {};
  }

  /// How deep the site's point is below all of `faces`, which bound the other body.
  double depth_inside(Site site, std::initializer_list<Face> faces) const {
    double depth = INFINITY;
    for (const Face face : faces) depth = std::min(depth, touch_point(system_, state_, {site, face}).depth);
    return depth;
  }

  double depth_inside(Site site) const {
    switch (site) {
      case Site::a1:
      case Site::a2:
        if (!system_.contacts.edges) return -INFINITY;
        return depth_inside(site, {Face::bottom, Face::right_side, Face::left_side});
      case Site::b1:
      case Site::b2:
        if (!system_.contacts.corners && !system_.contacts.walls) return -INFINITY;
        return std::max(depth_inside(site, {Face::top, Face::right_wall}),
                        depth_inside(site, {Face::top, Face::left_wall}));
      default: break;
    }
    const bool within_slot =
        depth_inside(site, {Face::right_wall}) < 0.0 && depth_inside(site, {Face::left_wall}) < 0.0;
    if (!system_.has_floor || !within_slot) return -INFINITY;
    return depth_inside(site, {Face::floor});
  }

  /// Depth of the base's surface below a site's point, which has left it deformed.
  double surface_of(Site site) const {
    const Recovery& base = segment_.recoveries[static_cast<std::size_t>(site)];
    return base.deformation > 0.0 ? Relaxation(system_, segment_, base).deformation_at(t_) : 0.0;
  }

  /// How far a base has not recovered yet that is taken to do so at once.
  double at_once() const { return system_.recovery ? speed_of(system_, segment_, state_) / kFastestRecovery : 0.0; }

  /// A point that is said to be outside, is.
  std::optional<Fault> outside(Site site) const {
    const ContactState& contact = segment_.contacts[static_cast<std::size_t>(site)];
    if (contact.phase != Phase::outside) return {};
    const double depth = depth_inside(site) - surface_of(site);
    if (depth > depth_noise() + at_once())
      return fault(Invariant::no_passing, "depth of a point that is outside", depth);
    return {};
  }

  static constexpr double kCut = 1e-2;  ///< part of the tolerance that a step may be wrong by; an implicit one by all

  const System& system_;
  double tolerance_, fastest_;
  const Segment& segment_;
  double digits_;  ///< of lengths and speeds
  double t_ = 0.0;
  State state_;
};

}  // namespace

std::optional<Fault> check_segment(const System& system, const Digits& digits, const Segment& segment) {
  SegmentCheck check(system, digits, segment);
  if (segment.flight != nullptr || segment.layer_crossing != nullptr) {
    for (int i = 0; i <= kFlightPoints; ++i)
      if (auto found = check.at(segment.duration * i / kFlightPoints)) return found;
    return check.touches();
  }
  for (const double share : kSeriesPoints) {
    if (auto found = check.at(share * segment.duration)) return found;
    if (segment.duration == 0.0) break;
  }
  return check.touches();
}

double energy_noise(const System& system, const Segment& segment) {
  const double h = segment.duration, depth_noise = kDigits * length_of(system, segment.begin);
  const State& q = segment.begin;
  double noise = depth_noise * (system.x.stiffness * std::abs(q.x - system.x.anchor) +
                                system.y.stiffness * std::abs(q.y - system.y.anchor));
  for (int i = 0; i < segment.loaded_count; ++i) {
    const ContactSeries& contact = segment.loaded[static_cast<std::size_t>(i)];
    const Face face = segment.contacts[static_cast<std::size_t>(contact.site)].face;
    const TouchPoint p = touch_point(system, segment.begin, {contact.site, face});
    const ForceTerms terms = force_terms(segment, i, h);
    const double force = terms.normal + terms.tangential + p.stiffness * depth_noise;
    const double creep = mobility(system, p) * kForceDigits * force * h;  // a speed
    noise += force * (depth_noise + creep * h);
    if (!segment.coarse) continue;
    // at the nodes of an implicit step N is known to the last digits of the places only, and with it the work of T
    const TouchPoint at_end = touch_point(system, segment.end, {contact.site, face});
    const double slip = std::max(std::abs(p.slip), std::abs(at_end.slip));
    noise += p.stiffness * kPlaceDigits * length_of(system, q) * system.friction * slip * h;
  }
  return noise;
}

}  // namespace vibratory_alignment::hunt
