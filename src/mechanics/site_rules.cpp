#include "mechanics/site_rules.h"

#include <cmath>

#include "mechanics/tilt.h"

namespace vibratory_alignment {
namespace {

/// Last digits of lengths.
constexpr double kOnWall = 1e-15;

/// Half the width of the slot, for a corner that on a wall's line, to the last digits, is in it, as one that touches
/// the wall is.
double slot_end(const System& system) {
  return system.slot_half_width + kOnWall * (system.slot_half_width + system.half_width + system.base_distance);
}

}  // namespace

Region site_region(const System& system, Site site, int half) {
  const double a = system.half_width, b = system.base_distance, l = system.slot_half_width;
  Region region;
  if (is_edge(site)) {
    region.count = 3;
    region.conditions[0] = {0.0, 1.0, b, Face::bottom};
    region.conditions[1] = {-1.0, 0.0, a, Face::right_side};
    region.conditions[2] = {1.0, 0.0, a, Face::left_side};
  } else if (site == Site::b1 || site == Site::b2) {
    region.count = 2;
    region.conditions[0] = {0.0, -1.0, 0.0, Face::top};
    region.conditions[1] =
        half == 0 ? RegionCondition{1.0, 0.0, -l, Face::right_wall} : RegionCondition{-1.0, 0.0, -l, Face::left_wall};
  } else {
    region.count = 1;
    region.conditions[0] = {0.0, -1.0, -system.floor_depth, Face::floor};
  }
  return region;
}

bool is_called_for(const System& system, Face face) {
  switch (face) {
    case Face::bottom:
    case Face::right_side:
    case Face::left_side: return system.contacts.edges;
    case Face::top: return system.contacts.corners;
    case Face::right_wall:
    case Face::left_wall: return system.contacts.walls;
    case Face::floor: return system.has_floor;
    default: return false;
  }
}

Region face_limits(const System& system, Face face, const Vec2& p) {
  const double a = system.half_width, b = system.base_distance, l = system.slot_half_width;
  Region limits;
  switch (face) {
    case Face::bottom:  // between the part's corners
      limits.count = 2;
      limits.conditions[0] = {-1.0, 0.0, a, Face::right_side};
      limits.conditions[1] = {1.0, 0.0, a, Face::left_side};
      break;
    case Face::right_side:  // above the lower corner, without upper end
    case Face::left_side:
      limits.count = 1;
      limits.conditions[0] = {0.0, 1.0, b, Face::bottom};
      break;
    case Face::top:  // beside the slot
      limits.count = 1;
      limits.conditions[0] =
          p.x > 0.0 ? RegionCondition{1.0, 0.0, -l, Face::right_wall} : RegionCondition{-1.0, 0.0, -l, Face::left_wall};
      break;
    case Face::right_wall:  // below the edge; the solid goes on behind the floor
    case Face::left_wall:
      limits.count = 1;
      limits.conditions[0] = {0.0, -1.0, 0.0, Face::top};
      break;
    default: break;
  }
  return limits;
}

Region insertion_region(const System& system, double depth, bool between_walls, const ContactState& contact) {
  const double l = slot_end(system);
  Region region;
  region.count = between_walls && !contact.on_wall() ? 3 : 1;
  region.conditions = {{{0.0, -1.0, -depth, Face::none}, {1.0, 0.0, l, Face::none}, {-1.0, 0.0, l, Face::none}}};
  return region;
}

bool is_in_slot(const System& system, double x) { return std::abs(x) <= slot_end(system); }

bool site_in_use(const System& system, Site site) {
  switch (site) {
    case Site::a1:
    case Site::a2: return system.contacts.edges;
    case Site::b1:
    case Site::b2: return system.contacts.corners || system.contacts.walls;
    default: return system.has_floor;
  }
}

void place_contacts(const System& system, const State& state, ContactStates& contacts) {
  const auto [c, s] = tilt_of(state.phi);
  for (int i = 0; i < kSiteCount; ++i) {
    const Site site = static_cast<Site>(i);
    ContactState& contact = contacts[i];
    contact = {};
    if (!site_in_use(system, site)) continue;
    const Vec2 p = site_point(system, state, site, c, s);
    for (int half = 0; half < region_count(site); ++half) {
      const Region region = site_region(system, site, half);
      // inside: all conditions hold; of the faces that the scene calls for the nearest is the one with the least depth
      bool inside = true;
      double least = INFINITY;
      Face nearest = Face::none;
      for (int j = 0; j < region.count; ++j) {
        const double depth = region.conditions[j].value(p);
        const Face face = region.conditions[j].face;
        inside = inside && depth > 0.0;
        if (depth < least && is_called_for(system, face)) {
          least = depth;
          nearest = face;
        }
      }
      if (!inside) continue;
      contact.phase = Phase::free;
      // a corner below the floor level but beside the slot is in the base, not on the floor, unless it presses a wall
      const bool beside = nearest == Face::floor && !is_in_slot(system, p.x);
      const Face corner_face = beside ? contacts[i - 2].face : Face::none;
      if (nearest == Face::none || (beside && corner_face != Face::right_wall && corner_face != Face::left_wall))
        continue;
      contact.face = nearest;
      const ContactKinematics k = contact_kinematics(system, state, site, nearest, p, c, s);
      const double force =
          stiffness_of(system, nearest, c, s) * k.depth + damping_of(system, nearest, c, s) * k.depth_rate;
      contact.phase = force > 0.0 ? Phase::loaded : Phase::unloaded;
    }
  }
}

}  // namespace vibratory_alignment
