#include "solver/contact_book.h"

#include <cmath>

#include "solver/base_recovery.h"

namespace vibratory_alignment {
namespace {

/// A point this close to a face, relative to the lengths of the bodies and the place of the part, lies on it.
constexpr double kOnFace = 1e-15;

/// A corner reaches the floor only inside the slot, or while it presses into a wall: from within the slot either way,
/// also where it comes to both in one step.
bool over_floor(const System& system, const ContactBook& book, Site site, const Vec2& point) {
  const Site corner = site == Site::b1_floor ? Site::b1 : Site::b2;
  return book.contacts[static_cast<std::size_t>(corner)].on_wall() || is_in_slot(system, point.x) ||
         is_in_slot(system, book.points[static_cast<std::size_t>(site)].x);
}

/// A condition of a region, at a point, with the surface of a base that has been left not back yet.
double above(const RegionCondition& condition, const Vec2& point, const Recovery& recovery) {
  const double value = condition.value(point);
  return recovery.face == condition.face ? value - recovery.deformation : value;
}

/// The face that a point has crossed to come in: of the condition that became true last, of several at once, as from a
/// corner (to `digits`, the last ones of lengths), the one that is nearest now; or, where all of them held before, of
/// the nearest. `left`: what the base keeps of its deformation, at both ends.
Face crossed_face(const Region& region, const Vec2& from, const Vec2& to, const Recovery& left_before,
                  const Recovery& left_now, double digits) {
  double last = -1.0, least = INFINITY, depth = INFINITY;
  Face crossed = Face::none, nearest = Face::none;
  for (std::size_t j = 0; j < static_cast<std::size_t>(region.count); ++j) {
    const RegionCondition& condition = region.conditions[j];
    const double now = above(condition, to, left_now), before = above(condition, from, left_before);
    const double when = std::abs(before) <= digits ? 0.0 : before <= 0.0 ? before / (before - now) : -1.0;
    if (when > last || (when == last && crossed != Face::none && now < depth)) {
      last = when;
      depth = now;
      crossed = condition.face;
    }
    if (now < least) {
      least = now;
      nearest = condition.face;
    }
  }
  return crossed == Face::none ? nearest : crossed;
}

SiteFate fate_outside(const System& system, const SiteTable& table, const ContactBook& book, Site site,
                      const PlacedState& placed, const Vec2& point, double elapsed) {
  const auto index = static_cast<std::size_t>(site);
  const Recovery& left = book.recoveries[index];
  const Recovery left_now{deformation_between(system, left, book.placed, placed, elapsed), left.face};
  for (std::size_t half = 0; half < static_cast<std::size_t>(region_count(site)); ++half) {
    const Region& region = table.regions[index][half];
    bool inside = true;
    for (std::size_t j = 0; inside && j < static_cast<std::size_t>(region.count); ++j)
      inside = above(region.conditions[j], point, left_now) > 0.0;
    if (!inside) continue;
    const Face face =
        crossed_face(region, book.points[index], point, left, left_now, last_digits(system, book.placed.state));
    const bool touches = is_called_for(system, face) && (face != Face::floor || over_floor(system, book, site, point));
    return touches ? SiteFate{Phase::loaded, face, true, EventKind::touch, face}
                   : SiteFate{Phase::free, Face::none, true, EventKind::enter, face};
  }
  return {};
}

/// A contact lasts as long as its point is on the face, to the last digits: else these would touch and leave in turn.
SiteFate fate_touching(const System& system, Face face, const PlacedState& placed, const Vec2& point) {
  if (!(contact_frame(system, face).depth(point.x, point.y) >= -last_digits(system, placed.state)))
    return {Phase::outside, Face::none, true, EventKind::close, face};
  const Region limits = face_limits(system, face, point);
  for (std::size_t j = 0; j < static_cast<std::size_t>(limits.count); ++j)
    if (limits.conditions[j].value(point) < 0.0)
      return {Phase::outside, Face::none, true, EventKind::run_off, limits.conditions[j].face};
  return {Phase::loaded, face, false, EventKind::touch, Face::none};
}

SiteFate fate_free(const SiteTable& table, Site site, const Vec2& point) {
  const Region& region =
      table.regions[static_cast<std::size_t>(site)][region_count(site) == 2 && point.x < 0.0 ? 1 : 0];
  for (std::size_t j = 0; j < static_cast<std::size_t>(region.count); ++j)
    if (!(region.conditions[j].value(point) > 0.0))
      return {Phase::outside, Face::none, true, EventKind::leave, region.conditions[j].face};
  return {Phase::free, Face::none, false, EventKind::touch, Face::none};
}

/// The base is left: what it keeps of its deformation.
Recovery left_base(const System& system, const PlacedState& placed, const ContactPoint& contact, Face face) {
  if (!system.recovery) return {};
  return left_behind(system, contact.depth, face, placed.cos_phi, placed.sin_phi);
}

/// One site at the end of a step; its point and recovery are known.
void follow_site(const System& system, const ContactState& before, Site site, const SiteFate& fate, ContactBook& book,
                 Segment& segment) {
  const auto index = static_cast<std::size_t>(site);
  ContactState& contact = book.contacts[index];
  Recovery& recovery = book.recoveries[index];
  contact = {};
  if (fate.phase != Phase::loaded) {
    contact.phase = fate.phase;
    if (!fate.changed) return;
    const bool closes_loaded = before.phase == Phase::loaded && fate.event == EventKind::close;
    if (closes_loaded) add_event(segment, EventKind::release, site);
    // a contact without base damping is released and closed in one
    const bool undamped =
        closes_loaded && damping_of(system, before.face, book.placed.cos_phi, book.placed.sin_phi) == 0.0;
    if (!undamped) add_event(segment, fate.event, site, fate.event_face);
    if (fate.event == EventKind::run_off) recovery = {};
    return;
  }
  contact.face = fate.face;
  ContactPoint& point = book.touching[index];
  point = contact_point(system, book.placed, site, fate.face, book.points[index]);
  bool pushes = point.push() > 0.0;
  if (!fate.changed && before.phase == Phase::unloaded && recovery.deformation > 0.0) {
    // left by the part: it pushes again when the part has caught up; between the states it may have been left anew
    const bool caught = point.depth >= recovery.deformation;
    if (caught) recovery = pushes ? Recovery{} : left_base(system, book.placed, point, fate.face);
    pushes = pushes && caught;
  } else {
    recovery = pushes ? Recovery{} : left_base(system, book.placed, point, fate.face);
  }
  contact.phase = pushes ? Phase::loaded : Phase::unloaded;
  const bool was_loaded = before.phase == Phase::loaded;
  if (fate.changed)
    add_event(segment, EventKind::touch, site, fate.face);
  else if (was_loaded != pushes)
    add_event(segment, pushes ? EventKind::reload : EventKind::release, site);
  if (was_loaded && pushes) contact.slip = before.slip;
}

}  // namespace

double last_digits(const System& system, const State& s) {
  return kOnFace *
         (std::abs(s.x) + std::abs(s.y) + system.half_width + system.base_distance + system.slot_half_width);
}

SiteTable::SiteTable(const System& system) {
  for (std::size_t i = 0; i < kSiteCount; ++i) {
    const auto site = static_cast<Site>(i);
    if (!site_in_use(system, site)) continue;
    sites[static_cast<std::size_t>(count++)] = site;
    for (int half = 0; half < region_count(site); ++half)
      regions[i][static_cast<std::size_t>(half)] = site_region(system, site, half);
  }
}

SiteFate fate_of(const System& system, const SiteTable& table, const ContactBook& book, Site site,
                 const PlacedState& placed, const Vec2& point, double elapsed) {
  const ContactState& contact = book.contacts[static_cast<std::size_t>(site)];
  switch (contact.phase) {
    case Phase::outside: return fate_outside(system, table, book, site, placed, point, elapsed);
    case Phase::free: return fate_free(table, site, point);
    default: return fate_touching(system, contact.face, placed, point);
  }
}

ContactBook open_book(const System& system, const SiteTable& table, const State& start) {
  ContactBook book(start);
  place_contacts(system, start, book.contacts);
  for (int n = 0; n < table.count; ++n) {
    const Site site = table.sites[static_cast<std::size_t>(n)];
    const auto i = static_cast<std::size_t>(site);
    const ContactState& contact = book.contacts[i];
    book.points[i] = site_point(system, book.placed, site);
    if (!contact.touching()) continue;
    book.touching[i] = contact_point(system, book.placed, site, contact.face, book.points[i]);
    if (contact.phase == Phase::unloaded)
      book.recoveries[i] = left_base(system, book.placed, book.touching[i], contact.face);
  }
  return book;
}

void follow(const System& system, const SiteTable& table, const ContactBook& before, Segment& segment,
            ContactBook& after) {
  after.placed = PlacedState(segment.end);
  for (int n = 0; n < table.count; ++n) {
    const Site site = table.sites[static_cast<std::size_t>(n)];
    const auto i = static_cast<std::size_t>(site);
    after.points[i] = site_point(system, after.placed, site);
    Recovery& recovery = after.recoveries[i];
    recovery = before.recoveries[i];
    recovery.deformation = deformation_between(system, recovery, before.placed, after.placed, segment.duration);
    if (recovery.deformation < kNoDeformation) recovery = {};
    const SiteFate fate = fate_of(system, table, before, site, after.placed, after.points[i], segment.duration);
    follow_site(system, before.contacts[i], site, fate, after, segment);
  }
}

bool may_push(const System& system, const ContactBook& book, Site site) {
  const auto index = static_cast<std::size_t>(site);
  const ContactState& contact = book.contacts[index];
  if (contact.phase == Phase::unloaded) return !(system.recovery && book.recoveries[index].deformation > 0.0);
  return contact.phase == Phase::loaded;
}

}  // namespace vibratory_alignment
