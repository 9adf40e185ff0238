#include "solver/contact_point.h"

#include "mechanics/site_rules.h"

namespace vibratory_alignment {

Vec2 site_point(const System& system, const PlacedState& placed, Site site) {
  return site_point(system, placed.state, site, placed.cos_phi, placed.sin_phi);
}

ContactPoint contact_point(const System& system, const PlacedState& placed, Site site, Face face, const Vec2& point) {
  const double c = placed.cos_phi, s = placed.sin_phi;
  return {contact_kinematics(system, placed.state, site, face, point, c, s), stiffness_of(system, face, c, s),
          damping_of(system, face, c, s)};
}

bool is_below(const System& system, const PlacedState& placed, const ContactStates& contacts, double depth,
              bool between_walls) {
  // the mean of both corners is at y - b cos phi
  if (placed.state.y - system.base_distance * placed.cos_phi > -depth) return false;
  for (const Site corner : {Site::b1, Site::b2}) {
    const Vec2 point = site_point(system, placed, corner);
    const Region region = insertion_region(system, depth, between_walls, contacts[static_cast<std::size_t>(corner)]);
    for (int j = 0; j < region.count; ++j)
      if (!(region.conditions[j].value(point) > 0.0)) return false;
  }
  return true;
}

}  // namespace vibratory_alignment
