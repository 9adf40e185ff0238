#include "solver/transitions.h"

#include <algorithm>
#include <cmath>

#include "mechanics/site_rules.h"
#include "mechanics/tilt.h"
#include "solver/base_recovery.h"
#include "solver/coincidence.h"

namespace vibratory_alignment {
namespace {

/// A sliding velocity this small, relative to the speeds it is made of, is zero.
constexpr double kZeroSlip = 1e-14;

/// A time in which nothing comes to pass: what friction stops within it is at rest. Faster than the second nothing is
/// stopped in it.
constexpr double kNoTime = 1e-20, kFaint = 1e-12;

/// Motions whose rates a sliding velocity may be the rest of.
using Motions = std::array<State, 3>;

/// Speeds that the sliding velocity of a contact is made of, at most.
double slip_scale(const ContactKinematics& k, const Motions& motions) {
  const double arm = cross(k.lever, k.tangent);
  double largest = 0.0;
  for (const State& s : motions)
    largest = std::max(largest, std::abs(k.tangent.x * s.vx) + std::abs(k.tangent.y * s.vy) + std::abs(arm * s.omega));
  return largest;
}

/// True for a sliding velocity so small that friction ends it at once, of a part whose motion has all but died out: its
/// sign is rounding whatever it is the rest of.
[[gnu::noinline, gnu::cold]] bool stops_at_once(const System& system, const State& state, const ContactKinematics& k,
                                                Face face) {
  const auto [c, s] = tilt_of(state.phi);
  const double normal_force =
      stiffness_of(system, face, c, s) * k.depth + damping_of(system, face, c, s) * k.depth_rate;
  const double deceleration =
      mobility_along(system, k.tangent, cross(k.lever, k.tangent)) * system.friction * normal_force;
  return std::abs(k.slip_velocity) <= kNoTime * deceleration;
}

/// Rates gained: of what has no series all of them, else what the acceleration of the segment's start makes.
State gain_of(const Segment& segment) {
  State gain;
  if (segment.flight != nullptr || segment.layer_crossing != nullptr) {
    gain.vx = segment.end.vx - segment.begin.vx;
    gain.vy = segment.end.vy - segment.begin.vy;
    gain.omega = segment.end.omega - segment.begin.omega;
    return gain;
  }
  gain.vx = segment.duration * segment.vx[1];
  gain.vy = segment.duration * segment.vy[1];
  gain.omega = segment.duration * segment.omega[1];
  return gain;
}

/// What comes to rest at the end of a segment was moving before.
Motions motions_of(const Segment& segment) { return {segment.begin, segment.end, gain_of(segment)}; }

/// A friction force this near to its limit, relative to it, is at the limit.
constexpr double kAtLimit = 1e-2;

/// What T exceeds its limit by beyond the end of a segment, after as long again, as a share of the limit: more is no
/// rounding.
constexpr double kClearly = 1e-3;

bool is_instant(const System& system, const Segment& segment) {
  if (segment.duration > kInstant) return false;
  const State gain = gain_of(segment);
  return nothing_moves(system, segment.begin, gain.vx, gain.vy, gain.omega);
}

bool only_slip(const FoundEvents& events) {
  return std::all_of(events.events.begin(), events.events.begin() + events.count,
                     [](const Event& event) { return event.kind == EventKind::slip; });
}

/// True where other forces act from now on.
bool change_forces(const FoundEvents& events) {
  return events.kink ||
         std::any_of(events.events.begin(), events.events.begin() + events.count, [](const Event& event) {
           return event.kind == EventKind::touch || event.kind == EventKind::reload ||
                  event.kind == EventKind::release || event.kind == EventKind::run_off;
         });
}

/// Of what was zero with the forces before, the value still is, and no more.
void keep_values_only(SitePins& pins) {
  pins.slip = std::min(pins.slip, 1);
  pins.hold_plus = std::min(pins.hold_plus, 1);
  pins.hold_minus = std::min(pins.hold_minus, 1);
}

/// Slip velocity beyond which a contact slides with the full friction force.
double sliding_threshold(const System& system) { return system.tanh_saturation * system.regularization; }

/// Sets the law of friction of every loaded contact. `zero_slip` marks those whose V or stick an event has just brought
/// to its end, `slides` those that are decided already; `motions`: what V is small against; `unmoved`: the events lie
/// within the last digits of the state.
void set_friction(const System& system, const State& state, const DriveForms& drives, const Motions& motions,
                  const SiteFlags& zero_slip, const SiteFlags& slides, bool unmoved, FrictionChoice& friction,
                  ContactMode& mode) {
  if (system.friction == 0.0) return;
  SiteFlags at_rest{};
  for (std::size_t i = 0; i < kSiteCount; ++i) {
    ContactState& contact = mode.contacts[i];
    if (contact.phase != Phase::loaded) {
      contact.slip = Slip::none;
      continue;
    }
    const ContactKinematics kinematics = contact_kinematics(system, state, static_cast<Site>(i), contact.face);
    const double v = kinematics.slip_velocity;
    if (system.regularization > 0.0) {
      // sliding, or the layer about V = 0; an event has put V on the border, from where the old law tells the way
      if (zero_slip[i]) {
        contact.slip = contact.slip == Slip::regularized ? (v > 0.0 ? Slip::plus : Slip::minus) : Slip::regularized;
        mode.pins[i].slip = 1;
      } else if (contact.slip == Slip::none) {
        contact.slip = std::abs(v) <= sliding_threshold(system) ? Slip::regularized
                       : v > 0.0                                ? Slip::plus
                                                                : Slip::minus;
      }
      continue;
    }
    const bool zero = std::abs(v) <= kZeroSlip * slip_scale(kinematics, motions) ||
                      (std::abs(v) <= kFaint && stops_at_once(system, state, kinematics, contact.face));
    at_rest[i] = !slides[i] && (zero_slip[i] || contact.slip == Slip::stick || zero);
    // what slides in name only is at its limit; what has just been found to start sliding is not
    const bool starts = mode.pins[i].slip > 0 && mode.pins[i].slip <= MotionSeries::kHeldPowers;
    if (at_rest[i] && !zero_slip[i] && !starts && contact.slip == Slip::plus) mode.pins[i].hold_minus = 1;
    if (at_rest[i] && !zero_slip[i] && !starts && contact.slip == Slip::minus) mode.pins[i].hold_plus = 1;
    if (!at_rest[i] && contact.slip == Slip::none) contact.slip = v > 0.0 ? Slip::plus : Slip::minus;
  }
  friction.decide(state, drives, at_rest, mode, unmoved);
}

/// Marks the limit that T of a sticking contact has reached at the segment's end as zero.
void pin_limit(const System& system, const Segment& segment, Site site, SitePins& pins) {
  int i = 0;
  while (segment.loaded[i].site != site) ++i;
  const double t = value_at(segment.loaded[i].tangential_force, segment.order - 1, segment.duration);
  const double most = system.friction * value_at(segment.loaded[i].normal_force, segment.order, segment.duration);
  if (std::abs(t) >= (1.0 - kAtLimit) * most) (t > 0.0 ? pins.hold_plus : pins.hold_minus) = 1;
}

/// True when T of the only contact runs through the limit that it has reached at the segment's end, so fast that it
/// cannot stay within: no choice is left but to slide against it. Nothing else happens at that instant.
bool breaks_clearly(const System& system, const Segment& segment, const FoundEvents& events, const SitePins& pins) {
  if (segment.loaded_count != 1 || events.count != 1 || events.parts || events.kink) return false;
  if ((pins.hold_plus > 0) == (pins.hold_minus > 0)) return false;
  const ContactSeries& contact = segment.loaded[0];
  const double sign = pins.hold_plus > 0 ? 1.0 : -1.0;
  double most = 0.0, left_slope = 0.0, left = 0.0;
  for (int k = segment.order - 1; k >= 0; --k) {
    const double friction = system.friction * contact.normal_force[k];
    most = most * segment.duration + friction;
    left_slope = left_slope * segment.duration + left;
    left = left * segment.duration + friction - sign * contact.tangential_force[k];
  }
  return -left_slope * segment.duration > kClearly * most;
}

/// A contact without base damping along its normal: N starts and ends at zero depth.
bool is_undamped(const System& system, const State& state, Face face) {
  const auto [c, s] = tilt_of(state.phi);
  return damping_of(system, face, c, s) == 0.0;
}

/// What the base keeps of its deformation when the contact at `site` is released.
Recovery release_recovery(const System& system, const State& state, Site site, Face face) {
  if (!system.recovery) return {};
  const auto [c, s] = tilt_of(state.phi);
  return left_behind(system, contact_kinematics(system, state, site, face).depth, face, c, s);
}

}  // namespace

void apply_events(const System& system, const Segment& segment, const DriveForms& drives_at_end,
                  FrictionChoice& friction, FoundEvents& events, ContactMode& mode) {
  // what was zero at the start no longer is, unless no time has passed
  if (!is_instant(system, segment)) mode.pins = {};
  if (change_forces(events)) std::for_each(mode.pins.begin(), mode.pins.end(), keep_values_only);
  const State& state = segment.end;
  SiteFlags zero_slip{}, slides{};
  for (int i = 0; i < events.count; ++i) {
    const Site site = events.events[i].site;
    const auto index = static_cast<std::size_t>(site);
    ContactState& contact = mode.contacts[index];
    SitePins& pins = mode.pins[index];
    const Face face = events.events[i].face;
    // a contact that has ended takes its other events with it
    if (contact.phase != segment.contacts[index].phase) continue;
    switch (events.events[i].kind) {
      case EventKind::touch:
        contact = {Phase::loaded, face, Slip::none};
        pins = {};  // those of an earlier contact, maybe of another face, at the same instant
        pins.normal = is_undamped(system, state, face) ? 1 : 0;
        mode.recoveries[index] = {};
        break;
      case EventKind::reload:
        contact.phase = Phase::loaded;
        // of a base that is deformed still N does not start at zero (the segment's: what is left at its end may be
        // none)
        pins.normal = segment.recoveries[index].deformation > 0.0 ? 0 : 1;
        mode.recoveries[index] = {};
        break;
      case EventKind::release:
        mode.recoveries[index] = release_recovery(system, state, site, contact.face);
        // a base that recovers leaves with the part: depth and deformation agree in value and rate
        pins.normal = mode.recoveries[index].deformation > 0.0 ? 2 : 1;
        if (is_undamped(system, state, contact.face)) {
          // N = k d: force and depth end together
          pins.face = contact.face;
          contact = {};
        } else {
          contact.phase = Phase::unloaded;
          contact.slip = Slip::none;
        }
        break;
      case EventKind::close:
        pins.face = contact.face;
        contact = {};
        break;
      case EventKind::run_off:
        contact = {};
        pins.face = face;
        mode.recoveries[index] = {};
        break;
      case EventKind::leave:
        contact = {};
        pins.face = face;
        break;
      case EventKind::enter: contact = {Phase::free, Face::none, Slip::none}; break;
      case EventKind::slip_reversal: zero_slip[index] = true; break;
      case EventKind::slip:
        zero_slip[index] = true;
        if (contact.slip != Slip::stick) break;
        if (!events.parts) pin_limit(system, segment, site, pins);
        // after an implicit step what N does at once, faster than the step, must not decide
        if ((segment.coarse && (pins.hold_plus > 0 || pins.hold_minus > 0)) ||
            breaks_clearly(system, segment, events, pins)) {
          contact.slip = pins.hold_plus > 0 ? Slip::minus : Slip::plus;
          pins.slip = 2;
          pins.hold_plus = pins.hold_minus = 0;
          zero_slip[index] = false;
          slides[index] = true;
        }
        break;
      default: break;
    }
  }
  const bool unmoved = only_slip(events) && !events.parts && is_unmoved(system, segment.begin, segment.end);
  set_friction(system, state, drives_at_end, motions_of(segment), zero_slip, slides, unmoved, friction, mode);
  for (int i = 0; i < events.count; ++i) {
    Event& event = events.events[i];
    if (event.kind == EventKind::slip_reversal &&
        mode.contacts[static_cast<std::size_t>(event.site)].slip == Slip::stick)
      event.kind = EventKind::stick;
  }
}

double excess_friction(const System& system, const Segment& segment, double step) {
  double excess = 0.0;
  const double h = std::min(step, 1.0);  // nothing may move at all
  for (int i = 0; i < segment.loaded_count; ++i) {
    const ContactSeries& contact = segment.loaded[i];
    if (slip_of(segment, contact) != Slip::stick) continue;
    const Series& n = contact.normal_force;
    const double beyond = std::abs(contact.tangential_force[0]) - system.friction * std::abs(n[0]);
    if (!(beyond > 0.0)) continue;
    // N may begin with a higher power, as far as decisions look, where T begins with last digits of other forces
    double size = 0.0;
    for (int k = std::min(segment.order, MotionSeries::kHeldPowers - 1); k >= 0; --k) size = size * h + std::abs(n[k]);
    size *= system.friction;
    if (beyond > excess * size) excess = beyond / size;
  }
  return excess;
}

void decide_friction_anew(const System& system, const Segment& segment, const DriveForms& drives,
                          const SiteFlags& zero_slip, FrictionChoice& friction, ContactMode& mode) {
  set_friction(system, segment.end, drives, motions_of(segment), zero_slip, {}, false, friction, mode);
}

ContactMode start_mode(const System& system, const State& start, const DriveForms& drives, FrictionChoice& friction) {
  ContactMode mode{};
  place_contacts(system, start, mode.contacts);
  for (std::size_t i = 0; i < kSiteCount; ++i)
    if (mode.contacts[i].phase == Phase::unloaded)
      mode.recoveries[i] = release_recovery(system, start, static_cast<Site>(i), mode.contacts[i].face);
  set_friction(system, start, drives, {start, start, start}, {}, {}, false, friction, mode);
  return mode;
}

}  // namespace vibratory_alignment
