// A contact at one state with the stiffness and damping of its base, from cos and sin of the tilt that all contacts of
// the state share: the solvers with a fixed step evaluate many states.
#pragma once

#include "mechanics/contact_frame.h"
#include "mechanics/tilt.h"

namespace vibratory_alignment {

/// A state with the direction of its body axis e1 = (cos phi, sin phi).
struct PlacedState {
  explicit PlacedState(const State& s) : PlacedState(s, tilt_of(s.phi)) {}

  State state;
  double cos_phi, sin_phi;

 private:
  PlacedState(const State& s, const Tilt& tilt) : state(s), cos_phi(tilt.cos), sin_phi(tilt.sin) {}
};

struct ContactPoint : ContactKinematics {
  double stiffness = 0.0;  ///< k(n)
  double damping = 0.0;    ///< h(n)

  /// k d + h d', which is N where it is positive.
  double push() const { return stiffness * depth + damping * depth_rate; }
  /// Levers of N and T about the mass centre.
  double normal_lever() const { return cross(lever, normal); }
  double tangent_lever() const { return cross(lever, tangent); }
};

/// Body coordinates (u, w) of an edge, or position B of a corner.
Vec2 site_point(const System& system, const PlacedState& placed, Site site);

/// The contact of `site`, whose point is at `point`, with `face`.
ContactPoint contact_point(const System& system, const PlacedState& placed, Site site, Face face, const Vec2& point);

/// True when both lower corners, with these contacts, are below `depth` and, if asked, between the walls
/// (insertion_region).
bool is_below(const System& system, const PlacedState& placed, const ContactStates& contacts, double depth,
              bool between_walls);

}  // namespace vibratory_alignment
