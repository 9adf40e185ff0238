// Where each site may touch: the regions whose entry starts a contact and the ends of the faces
// (docs/hybrid_step.md "Sites"). One place for the rules that the start of a trial and the hybrid step share.
#pragma once

#include "mechanics/contact_frame.h"

namespace vibratory_alignment {

/// A condition c1 p1 + c2 p2 + c0 > 0 on the coordinates of a site's point (body coordinates of an edge, position of a
/// corner), and the face that is crossed where it becomes true.
struct RegionCondition {
  double c1, c2, c0;
  Face face;

  double value(const Vec2& p) const { return c1 * p.x + c2 * p.y + c0; }
};

/// The other body as seen from a site: the point is inside where all conditions hold.
struct Region {
  std::array<RegionCondition, 3> conditions;
  int count = 0;
};

/// Edges: the part. Corners: one half of the base, 0 the right one, 1 the left one. Floor sites: below the floor.
Region site_region(const System& system, Site site, int half);

/// Number of regions a site has: 1 for edges and floor sites, 2 for corners.
inline int region_count(Site site) { return site == Site::b1 || site == Site::b2 ? 2 : 1; }

/// True when the scene calls for contact with this face.
bool is_called_for(const System& system, Face face);

/// The limits of a face at a contact with its point at p: the contact runs off where one of them falls below zero. The
/// condition's face is the one through which the point then lies outside the other body.
Region face_limits(const System& system, Face face, const Vec2& p);

/// Where a lower corner with this contact is below `depth` and, if asked, between the walls: one that touches a wall
/// is, and one on its line to the last digits.
Region insertion_region(const System& system, double depth, bool between_walls, const ContactState& contact);

/// Whether a corner at this x is between the walls, or on the line of one to the last digits.
bool is_in_slot(const System& system, double x);

/// Whether the scene uses the site at all.
bool site_in_use(const System& system, Site site);

/// Number of sites up to the last one in use.
inline int site_end(const System& system) {
  const bool corners = system.contacts.corners || system.contacts.walls;
  return system.has_floor ? kSiteCount : static_cast<int>(corners ? Site::b1_floor : Site::b1);
}

/// Contact states of a start: points inside the other body touch the nearest of its faces that the scene calls for. The
/// contacts that carry force (N > 0) are loaded; their friction is left to the hybrid step.
void place_contacts(const System& system, const State& state, ContactStates& contacts);

}  // namespace vibratory_alignment
