#include "solver/step_size.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mechanics/rough_log2.h"

namespace vibratory_alignment {
namespace {

constexpr int kLeadingTerms = 4;
/// log2 of how much larger than the last terms of a series, at the time that they give, the one before them is where
/// they vanish. Where they do not it is (k/r)^2 as large, k the order and r the radians of a step.
constexpr double kGap = 16.0;
/// Of a step: series of fewer powers are those of a decision.
constexpr int kLeastOrder = 8;
/// Of a velocity: slower is at rest. To become as fast as anything that matters it would have to grow 138 times e-fold.
constexpr double kRest = 1e-60;
/// Of a velocity, beside what the part's speed and the forces of the contacts would make it: forces that hold an axis
/// leave it less than this of their rounding.
constexpr double kHeld = 1e-20;
/// Beyond it rounding is all that is left.
constexpr int kMostOrder = 22;
/// Of numbers about one.
constexpr double kUnitRounding = 1e-16;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// True where, at the time that the last two terms of a series give, the one before them is far larger (log2 of sizes):
/// the last two are none then. So it is in a function of t^3, as the tilt of a part is that only a ramp turns from
/// rest: two of three terms vanish.
bool is_gap(double before_last, double last) { return before_last > last + kGap; }

/// log2 of the time at which the terms `order` - 1 and `order` of v have both fallen to `tolerance` times the largest
/// of the leading terms, of which those of v or of a scale are given. One that vanishes, as every second one may,
/// allows any; where both do, the one before them tells.
double log2_step(const double* leading_terms, const Series& v, int order, double log2_tolerance) {
  double leading[kLeadingTerms];
  for (int j = 0; j < kLeadingTerms; ++j) leading[j] = log2_tolerance + rough_log2(std::abs(leading_terms[j]));
  const auto time_of = [&](double size, int k) {
    double time = (leading[0] - size) * kInverse[k];
    for (int j = 1; j < kLeadingTerms; ++j) time = std::max(time, (leading[j] - size) * kInverse[k - j]);
    return time;
  };
  const double last[2] = {rough_log2(std::abs(v[order])), rough_log2(std::abs(v[order - 1]))};
  const double times[2] = {time_of(last[0], order), time_of(last[1], order - 1)};
  const int least = times[0] < times[1] ? 0 : 1;
  const double time = times[least], before = rough_log2(std::abs(v[order - 2]));
  const bool gap = is_gap(before + (order - 2) * time, last[least] + (order - least) * time);
  return gap && order >= kLeastOrder ? std::min(time, time_of(before, order - 2)) : time;
}

/// Likewise of T beside f N, to the power `order`.
double log2_friction_step(const ContactSeries& contact, double friction, int order, double log2_tolerance) {
  double scale[kLeadingTerms];
  for (int k = 0; k < kLeadingTerms; ++k)
    scale[k] = std::abs(contact.tangential_force[k]) + friction * std::abs(contact.normal_force[k]);
  return log2_step(scale, contact.tangential_force, order, log2_tolerance);
}

/// True when contacts hold the axis of velocity v: its terms are no more than rounding of what the part has of speed
/// (`speed`: of all axes) and of the forces that cancel in them. `mobility`: acceleration for a force of one at the far
/// end of the part.
bool contacts_hold(const Segment& s, const Series& v, double speed, double mobility) {
  if (std::abs(v[0]) > kHeld * speed) return false;
  const auto is_rounding = [&](int k) {
    double forces = 0.0;
    for (int i = 0; i < s.loaded_count; ++i)
      forces += std::abs(s.loaded[i].normal_force[k - 1]) + std::abs(s.loaded[i].tangential_force[k - 1]);
    return std::abs(v[k]) * k <= kHeld * mobility * forces;
  };
  for (int k = 1; k < kLeadingTerms; ++k)
    if (!is_rounding(k)) return false;
  return is_rounding(s.order - 1) && is_rounding(s.order);
}

/// log2 of series_step().
double log2_series_step(const System& system, const Segment& segment, double tolerance) {
  const double log2_tolerance = rough_log2(tolerance);
  const double reach = system.half_width + system.base_distance;
  const double speed = std::abs(segment.vx[0]) + std::abs(segment.vy[0]) + std::abs(segment.omega[0]);
  double shortest = kInfinity;
  const auto look = [&](const Series& v, double mobility) {
    // an axis whose leading terms vanish has no scale of its own; what is at rest must not begin to move either
    const double leading = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2]), std::abs(v[3])});
    const double last = std::max(std::abs(v[segment.order - 1]), std::abs(v[segment.order]));
    if (leading == 0.0 || std::max(leading, last) < kRest || contacts_hold(segment, v, speed, mobility)) return;
    shortest = std::min(shortest, log2_step(v.data(), v, segment.order, log2_tolerance));
  };
  look(segment.vx, system.x.inverse_inertia);
  look(segment.vy, system.y.inverse_inertia);
  look(segment.omega, system.phi.inverse_inertia * reach);
  // a contact that holds the part at rest: all that changes is T
  for (int i = 0; i < segment.loaded_count; ++i) {
    const ContactSeries& contact = segment.loaded[i];
    if (slip_of(segment, contact) == Slip::stick)
      shortest = std::min(shortest, log2_friction_step(contact, system.friction, segment.order - 1, log2_tolerance));
  }
  return shortest;
}

}  // namespace

double series_step(const System& system, const Segment& segment, double tolerance) {
  return rough_exp2(log2_series_step(system, segment, tolerance));
}

double contact_step(const System& system, const Segment& segment, double tolerance, double force_tolerance) {
  const double log2_tolerance = rough_log2(force_tolerance);
  double shortest = log2_series_step(system, segment, tolerance);
  for (int i = 0; i < segment.loaded_count; ++i) {
    const ContactSeries& contact = segment.loaded[i];
    if (slip_of(segment, contact) == Slip::regularized)
      shortest = std::min(shortest, log2_friction_step(contact, system.friction, segment.order, log2_tolerance));
  }
  return rough_exp2(shortest);
}

double pair_step(const PairSeries& series, int order, double tolerance) {
  const double log2_tolerance = rough_log2(tolerance);
  const auto size_of = [&](int k) { return rough_log2(std::max(std::abs(series[k][0]), std::abs(series[k][1]))); };
  const auto time_of = [&](double size, int k) { return (log2_tolerance - size) * kInverse[k]; };
  const double time = std::min(time_of(size_of(order), order), time_of(size_of(order - 1), order - 1));
  const double before = size_of(order - 2);
  const bool gap = is_gap(before + (order - 2) * time, log2_tolerance);
  return rough_exp2(gap && order >= kLeastOrder ? std::min(time, time_of(before, order - 2)) : time);
}

double turned_place_step(const Segment& segment, const PairSeries& direction, double step, double tolerance) {
  const int order = segment.order;
  std::array<double, kMaxOrder + 2> from{};  // sums of the terms of the direction from a power on
  double power = 1.0;
  for (int k = 0; k <= order; ++k, power *= step)
    from[k] = (std::abs(direction[k][0]) + std::abs(direction[k][1])) * power;
  for (int k = order; k > 0; --k) from[k - 1] += from[k];
  double lost = 0.0;
  power = step;
  for (int i = 1; i <= order; ++i, power *= step)
    lost += (std::abs(segment.x[i]) + std::abs(segment.y[i])) * power * from[order + 1 - i];
  // its lowest power is order + 1
  return lost > tolerance ? step * std::pow(tolerance / lost, 1.0 / (order + 1)) : step;
}

int series_order(double tolerance) {
  const double digits = -std::log10(tolerance);
  return std::clamp(static_cast<int>(std::ceil(7.0 + digits)), kLeastOrder, kMostOrder);
}

int straight_series_order(double tolerance, double radians) {
  // terms grow to exp(radians) of what they sum to, and leave rounding of that
  const double most = std::min(radians, std::log(tolerance / kUnitRounding));
  const int least = series_order(tolerance);
  // the last term of a ring is radians^order/order!
  double term = 1.0;
  int order = 0;
  while (order < least || (order < kMaxOrder - 2 && term > tolerance)) term *= most / ++order;
  return order;
}

}  // namespace vibratory_alignment
