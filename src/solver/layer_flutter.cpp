#include "solver/layer_flutter.h"

#include <algorithm>
#include <cmath>

#include "solver/collocation.h"

namespace vibratory_alignment {
namespace {

/// Growth in a step that is nothing yet, as an exponent.
constexpr double kLeastGrowth = 0.1;

/// The least root of s^3 + c2 s^2 + c1 s + c0, by Newton's method from beyond it.
double most_negative_root(double c2, double c1, double c0) {
  double s = -2.0 * std::max({std::abs(c2), std::sqrt(std::abs(c1)), std::cbrt(std::abs(c0))});
  for (;;) {
    const double next = s - (((s + c2) * s + c1) * s + c0) / ((3.0 * s + 2.0 * c2) * s + c1);
    if (!(next > s)) return s;
    s = next;
  }
}

}  // namespace

bool flutters_within(double h, const ForceJacobian& jacobian) {
  if (jacobian.count != 1 || jacobian.layer_count != 1) return false;
  const NormalJacobian& normal = jacobian.normal[0];
  const LayerJacobian& layer = jacobian.layer[0];
  // what N and T make of the rates of N and V
  const double p = normal.by_position.dot(normal.push), q = layer.by_slip * normal.by_position.dot(layer.push);
  const double r = layer.slip_by_velocity.dot(normal.push), s = layer.by_slip * layer.slip_by_velocity.dot(layer.push);
  const double delay = normal.by_velocity.dot(normal.by_position) / normal.by_position.squaredNorm();
  const double c2 = -(delay * p + s), c0 = p * s - q * r, c1 = delay * c0 - p;
  // seen by what grows at the least rate that counts
  const double shift = kLeastGrowth / h;
  const double b2 = c2 + 3.0 * shift, b1 = c1 + shift * (2.0 * c2 + 3.0 * shift),
               b0 = c0 + shift * (c1 + shift * (c2 + shift));
  if (!(b2 * b1 < b0) || c0 <= 0.0) return false;
  const double rate_squared = -c0 / most_negative_root(c2, c1, c0);
  const double follows = h * collocation().eigenvalue[0].real();
  return follows * follows * rate_squared > 1.0;
}

}  // namespace vibratory_alignment
