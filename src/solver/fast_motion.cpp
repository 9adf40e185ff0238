#include "solver/fast_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vibratory_alignment {
namespace {

/// A determinant of three terms that is less than this share of the squares that it is the difference of is that of a
/// real exponential.
constexpr double kReal = 1e-2;

/// The last four derivatives of a velocity at the start, over (order - 3)!.
using Derivatives = std::array<double, 4>;

Derivatives last_derivatives(const Series& v, int order) {
  const auto k = static_cast<double>(order);
  return {v[order - 3], (k - 2.0) * v[order - 2], (k - 2.0) * (k - 1.0) * v[order - 1],
          (k - 2.0) * (k - 1.0) * k * v[order]};
}

/// |lambda| of d_j = Re(c lambda^j): the determinants d_j d_j+2 - d_j+1^2 grow with |lambda|^2.
double rate_of(Derivatives d) {
  // neither of them overflows
  const double scale = 1.0 / std::max(std::abs(d[3]), std::abs(d[2]));
  for (double& derivative : d) derivative *= scale;
  const double before = d[0] * d[2] - d[1] * d[1], last = d[1] * d[3] - d[2] * d[2];
  const bool real = std::abs(last) <= kReal * d[2] * d[2] || !(last * before > 0.0);
  return real ? std::max(std::abs(d[3]), std::abs(d[2])) / std::max(std::abs(d[2]), std::abs(d[1]))
              : std::sqrt(last / before);
}

}  // namespace

FastMotion fast_motion(const System& system, const Segment& segment) {
  const double reach = system.half_width + system.base_distance;
  const std::array<double, 3> lever = {1.0, 1.0, reach};
  const std::array<Derivatives, 3> axes = {last_derivatives(segment.vx, segment.order),
                                           last_derivatives(segment.vy, segment.order),
                                           last_derivatives(segment.omega, segment.order)};
  // the rate is that of the axis with the largest last terms
  double last = 0.0, before = 0.0, most = -1.0;
  std::size_t largest = 0;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    const double last_of_axis = lever[axis] * std::abs(axes[axis][3]);
    const double before_of_axis = lever[axis] * std::abs(axes[axis][2]);
    last += last_of_axis;
    before += before_of_axis;
    if (std::max(last_of_axis, before_of_axis) > most) {
      most = std::max(last_of_axis, before_of_axis);
      largest = axis;
    }
  }
  const double rate = rate_of(axes[largest]), time = 1.0 / rate;
  if (!(rate > 0.0) || !std::isfinite(rate)) return {};
  // times (order - 3)!/rate^(order - 3), one factor at a time: neither overflows
  double speed = std::max(last * time, before) * time * time;
  for (int k = segment.order - 3; k > 0; --k) speed *= k * time;
  return {rate, speed};
}

double normal_force_change(const Segment& segment, double t, int lowest) {
  double most = 0.0;
  for (int i = 0; i < segment.loaded_count; ++i) {
    const Series& force = segment.loaded[i].normal_force;
    double change = 0.0;
    for (int k = segment.order; k > 0; --k) change = (change + (k < lowest ? 0.0 : std::abs(force[k]))) * t;
    // what begins with no more than its last digits is anything but quiet
    if (change > 0.0)
      most = std::max(most, force[0] > 0.0 ? change / force[0] : std::numeric_limits<double>::infinity());
  }
  return most;
}

}  // namespace vibratory_alignment
