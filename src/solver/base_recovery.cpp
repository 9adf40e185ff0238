#include "solver/base_recovery.h"

#include <algorithm>
#include <cmath>

#include "solver/turning_face.h"

namespace vibratory_alignment {
namespace {

/// A base that recovers at a rate of this does so at once.
constexpr double kFastestRecovery = 1e12;

double rate_at_start(const System& system, const Segment& segment, Face face) {
  const Tilt tilt = tilt_of(segment.begin.phi);
  return relaxation_rate(system, face, tilt.cos, tilt.sin).value;
}

/// k/h as a series: h (k/h) = k, power by power.
Series rate_series(const System& system, const Segment& segment, Face face) {
  Series stiffness, damping, rate{};
  for (int k = 0; k <= segment.order; ++k) {
    turning_term(system, face, k, segment, stiffness[k], damping[k]);
    double rest = stiffness[k];
    for (int j = 1; j <= k; ++j) rest -= damping[j] * rate[k - j];
    rate[k] = rest / damping[0];
  }
  return rate;
}

}  // namespace

bool recovers_at_once(const System& system, Face face, double cos_phi, double sin_phi) {
  const double damping = damping_of(system, face, cos_phi, sin_phi);
  return damping == 0.0 || damping * kFastestRecovery < stiffness_of(system, face, cos_phi, sin_phi);
}

Recovery left_behind(const System& system, double deformation, Face face, double cos_phi, double sin_phi) {
  if (!(deformation > kNoDeformation) || recovers_at_once(system, face, cos_phi, sin_phi)) return {};
  return {deformation, face};
}

RelaxationRate relaxation_rate(const System& system, Face face, double cos_phi, double sin_phi) {
  const double k = stiffness_of(system, face, cos_phi, sin_phi), h = damping_of(system, face, cos_phi, sin_phi);
  const double rate = k / h;
  return {rate, (stiffness_slope_of(system, face, cos_phi, sin_phi) -
                 rate * damping_slope_of(system, face, cos_phi, sin_phi)) /
                    h};
}

RelaxationBounds relaxation_bounds(const System& system, Face face) {
  if (recovers_evenly(system, face)) return {0.0, 0.0};
  // (a + b cos 2 phi)/(p + q cos 2 phi), whose slope has the factor b p - a q
  const double factor = 0.5 * std::abs(system.stiffness_y * system.damping_x - system.stiffness_x * system.damping_y);
  const double q = 0.5 * std::abs(system.damping_y - system.damping_x);
  const double least = std::min(system.damping_x, system.damping_y), per_square = factor / (least * least);
  return {2.0 * per_square, 4.0 * per_square * (1.0 + 2.0 * q / least)};
}

bool recovers_evenly(const System& system, Face face) {
  return !is_part_face(face) || !system.phi.moves ||
         system.stiffness_x * system.damping_y == system.stiffness_y * system.damping_x;
}

Series deformation_series(const System& system, const Segment& segment, const Recovery& recovery) {
  Series u{};
  u[0] = recovery.deformation;
  const bool evenly = recovers_evenly(system, recovery.face);
  const double even_rate = evenly ? rate_at_start(system, segment, recovery.face) : 0.0;
  const Series rate = evenly ? Series{} : rate_series(system, segment, recovery.face);
  for (int k = 0; k < segment.order; ++k) {
    const double next = -kInverse[k + 1] * (evenly ? even_rate * u[k] : product_term(rate, u, k));
    // from where it might overflow on it is, in a step of 1/rate at most, less than the last digit of the deformation
    if (!(std::abs(next) < kNearOverflow)) break;
    u[k + 1] = next;
  }
  return u;
}

Relaxation::Relaxation(const System& system, const Segment& segment, const Recovery& recovery)
    : start_(recovery.deformation) {
  exponent_[0] = 0.0;
  if (recovers_evenly(system, recovery.face)) {
    order_ = 1;
    exponent_[1] = rate_at_start(system, segment, recovery.face);
  } else {
    order_ = segment.order + 1;
    const Series rate = rate_series(system, segment, recovery.face);
    for (int k = 1; k <= order_; ++k) exponent_[k] = rate[k - 1] * kInverse[k];
  }
}

double Relaxation::deformation_at(double t) const { return start_ * std::exp(-value_at(exponent_, order_, t)); }

double recovery_step(const System& system, const Segment& segment, const Recovery& recovery, double tolerance) {
  double step = 1.0 / rate_at_start(system, segment, recovery.face);
  if (recovers_evenly(system, recovery.face)) return step;
  const Series rate = rate_series(system, segment, recovery.face);
  for (int k = segment.order - 1; k <= segment.order; ++k)
    if (rate[k] != 0.0) step = std::min(step, std::pow(tolerance / std::abs(rate[k]), kInverse[k + 1]));
  return step;
}

double deformation_between(const System& system, const Recovery& recovery, const PlacedState& from,
                           const PlacedState& to, double elapsed) {
  if (recovery.deformation == 0.0) return 0.0;
  const RelaxationRate start = relaxation_rate(system, recovery.face, from.cos_phi, from.sin_phi);
  double relaxed = start.value * elapsed;
  if (!recovers_evenly(system, recovery.face)) {
    const RelaxationRate end = relaxation_rate(system, recovery.face, to.cos_phi, to.sin_phi);
    const double bend = start.slope * from.state.omega - end.slope * to.state.omega;
    relaxed = std::max(0.0, elapsed * (0.5 * (start.value + end.value) + elapsed * bend / 12.0));
  }
  return recovery.deformation * std::exp(-relaxed);
}

}  // namespace vibratory_alignment
