// Position and velocity of the part (MODEL.md "Geometry and frame"), dimensionless.
#pragma once

#include <cmath>

namespace vibratory_alignment {

struct State {
  double x = 0.0, y = 0.0, phi = 0.0;      ///< mass centre; tilt, counter-clockwise, rad
  double vx = 0.0, vy = 0.0, omega = 0.0;  ///< their rates
};

inline bool is_finite(const State& s) { return std::isfinite(s.x + s.y + s.phi + s.vx + s.vy + s.omega); }

}  // namespace vibratory_alignment
