#include "solver/contact_point.h"

namespace vibratory_alignment {

Vec2 site_point(const System& system, const PlacedState& placed, Site site) {
  return site_point(system, placed.state, site, placed.cos_phi, placed.sin_phi);
}

ContactPoint contact_point(const System& system, const PlacedState& placed, Site site, Face face, const Vec2& point) {
  const double c = placed.cos_phi, s = placed.sin_phi;
  return {contact_kinematics(system, placed.state, site, face, point, c, s), stiffness_of(system, face, c, s),
          damping_of(system, face, c, s)};
}

}  // namespace vibratory_alignment
