// Restitution of a linear base that can push but not pull, in closed form.
#pragma once

#include <cmath>

namespace vibratory_alignment::test {

/// Speed after over speed before. The part leaves when k d + h d' = 0, which is d'' = 0.
inline double linear_restitution(double damping_ratio) {
  const double zeta = damping_ratio;
  if (zeta < 1.0) {
    const double beta = std::sqrt(1.0 - zeta * zeta);
    return std::exp(-zeta / beta * std::atan2(2.0 * zeta * beta, 2.0 * zeta * zeta - 1.0));
  }
  // d ~ exp(-r t) - exp(-R t): r^2 exp(-r t) = R^2 exp(-R t)
  const double root = std::sqrt(zeta * zeta - 1.0), fast = zeta + root, slow = 1.0 / fast;
  const double t = 2.0 * std::log(fast / slow) / (fast - slow);
  return -(fast * std::exp(-fast * t) - slow * std::exp(-slow * t)) / (fast - slow);
}

}  // namespace vibratory_alignment::test
