// Who touches what, from states alone: the contacts of the solvers with a fixed step (docs/solvers.md "Contacts").
//
// The book holds at the end of a step. At the end of the next one every site is looked at again: a point that has come
// in touches the face that it crossed last, a contact ends where its depth is no longer positive or its foot is beyond
// the end of the face. Nothing is located between the two states.
#pragma once

#include "mechanics/site_rules.h"
#include "solver/contact_mode.h"
#include "solver/contact_point.h"
#include "solver/segment.h"

namespace vibratory_alignment {

/// The sites that the scene uses, with their regions.
struct SiteTable {
  explicit SiteTable(const System& system);

  int count = 0;
  std::array<Site, kSiteCount> sites{};                     ///< the first `count`
  std::array<std::array<Region, 2>, kSiteCount> regions{};  ///< by site and half (site_region)
};

struct ContactBook {
  explicit ContactBook(const State& state) : placed(state) {}

  PlacedState placed;                               ///< the state it holds at
  ContactStates contacts;                           ///< phase and face by states; slip as the solver decides it
  Recoveries recoveries;                            ///< deformation at the book's instant
  std::array<Vec2, kSiteCount> points{};            ///< of the sites in use (site_point)
  std::array<ContactPoint, kSiteCount> touching{};  ///< of those that touch
};

/// What has become of a site since the book's instant.
struct SiteFate {
  Phase phase = Phase::outside;  ///< outside, free or, standing for all that touches, loaded
  Face face = Face::none;        ///< touched
  bool changed = false;          ///< `event` has happened
  EventKind event = EventKind::touch;
  Face event_face = Face::none;  ///< as in Event
};

/// The fate of a site that is at `point`, in the state `placed`, `elapsed` after the book's instant.
SiteFate fate_of(const System& system, const SiteTable& table, const ContactBook& book, Site site,
                 const PlacedState& placed, const Vec2& point, double elapsed);

/// A point this close to a face lies on it.
double last_digits(const System& system, const State& state);

/// The book of a start: points inside the other body touch its nearest face.
ContactBook open_book(const System& system, const SiteTable& table, const State& start);

/// Adds an event at the segment's end; what is beyond the room for them is left out.
inline void add_event(Segment& segment, EventKind kind, Site site, Face face = Face::none) {
  if (segment.event_count < kMaxEvents)
    segment.events[static_cast<std::size_t>(segment.event_count++)] = {kind, site, face};
}

/// Sets `after` to the book at the segment's end, where `before` holds at its start. Adds the events of the contacts,
/// those of friction left out; contacts that go on being loaded keep their slip, others have none yet.
void follow(const System& system, const SiteTable& table, const ContactBook& before, Segment& segment,
            ContactBook& after);

/// True when a contact may push in the step that starts with the book: it is loaded, or unloaded on a base that is
/// where the part is. A base that recovers and has been left pushes again only after the part has caught up with it.
bool may_push(const System& system, const ContactBook& book, Site site);

}  // namespace vibratory_alignment
