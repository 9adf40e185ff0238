#include "solver/series_noise.h"

#include <algorithm>
#include <cmath>

#include "mechanics/contact_frame.h"
#include "mechanics/holding_forces.h"

namespace vibratory_alignment {
namespace {

/// Rounding of a coefficient relative to the largest term of its series.
constexpr double kSeriesRounding = 4e-15;

/// Rounding of the depth, which a stiff base turns into force, relative to the lengths that it is made of.
constexpr double kStateRounding = 6e-16;

/// Largest |g_k| h^k.
double largest_term(const Series& g, int order, double h) {
  double largest = 0.0, power = 1.0;
  for (int k = 0; k <= order; ++k, power *= h) largest = std::max(largest, std::abs(g[k]) * power);
  return largest;
}

/// Largest |k g_k| h^(k-1).
double largest_slope_term(const Series& g, int order, double h) {
  double largest = 0.0, power = 1.0;
  for (int k = 1; k <= order; ++k, power *= h) largest = std::max(largest, k * std::abs(g[k]) * power);
  return largest;
}

using Kinematics = std::array<ContactKinematics, kSiteCount>;

TangentRow row_of(const ContactKinematics& k) { return {k.tangent.x, k.tangent.y, cross(k.lever, k.tangent)}; }
TangentRow normal_row_of(const ContactKinematics& k) { return {k.normal.x, k.normal.y, cross(k.lever, k.normal)}; }

bool sticks(const Segment& segment, int loaded) { return slip_of(segment, segment.loaded[loaded]) == Slip::stick; }

/// What errors of forces and moment make of V' while some contacts stick: little, where these hold what the errors move
/// most. Only where it is little beside what they would make of a free part, or decides about what slides.
void hold_noise(const System& system, const Segment& segment, const Kinematics& kinematics, const TangentRow& load,
                double rounding, double curvature, SeriesNoise& noise) {
  HoldingForces::Rows rows;
  int count = 0;
  for (int i = 0; i < segment.loaded_count; ++i)
    if (sticks(segment, i)) rows[count++] = row_of(kinematics[i]);
  if (count == 0) return;
  HoldingForces holding;
  holding.set(system, rows, count);
  if (!holding.delicate() && count == segment.loaded_count) return;
  using Responses = std::array<HoldingForces::Answer, 3>;
  const auto responses = [&](bool told_apart) {
    return Responses{holding.respond({load.x, 0.0, 0.0}, told_apart), holding.respond({0.0, load.y, 0.0}, told_apart),
                     holding.respond({0.0, 0.0, load.moment}, told_apart)};
  };
  const Responses shared = responses(false), told_apart = responses(true);
  const auto rate = [](const TangentRow& row, const Responses& answers) {
    double sum = 0.0;
    for (const HoldingForces::Answer& a : answers) sum += std::abs(row.x * a.x + row.y * a.y + row.moment * a.phi);
    return sum;
  };
  const int order = segment.order;
  const double ax = largest_slope_term(segment.vx, order, noise.h), ay = largest_slope_term(segment.vy, order, noise.h),
               turn = largest_slope_term(segment.omega, order, noise.h);
  noise.held_slip_rate = 0.0;
  for (int i = 0; i < segment.loaded_count; ++i) {
    const TangentRow row = row_of(kinematics[i]);
    const double motion =
        curvature + rounding * (std::abs(row.x) * ax + std::abs(row.y) * ay + std::abs(row.moment) * turn);
    if (sticks(segment, i)) {
      // contacts that count as the same do not hold what they differ by
      noise.held_slip_rate = std::max(noise.held_slip_rate, rate(row, told_apart) + motion);
      continue;
    }
    noise.slip_rate[i] = std::min(noise.slip_rate[i], rate(row, shared) + motion);
    noise.mobility[i] = std::min(noise.mobility[i], rate(row, {holding.respond(row)}));
    const double of_normal_force = rate(row, {holding.respond(normal_row_of(kinematics[i]))});
    noise.state_slip_rate[i] =
        std::min(noise.state_slip_rate[i],
                 noise.state_normal_force[i] * (of_normal_force + system.friction * noise.mobility[i]) + motion);
  }
}

}  // namespace

bool SeriesNoise::is_finite() const {
  double sum = 0.0;
  for (const double rate : slip_rate) sum += rate;
  return std::isfinite(sum);
}

SeriesNoise series_noise(const System& system, const Segment& segment, double h, double allowance) {
  const double rounding = allowance * kSeriesRounding;
  SeriesNoise noise;
  noise.h = h;
  const int order = segment.order;
  const auto axis_force = [&](const Axis& axis, const Series& drive, const Series& q, const Series& v) {
    return largest_term(drive, order, h) + axis.damping * largest_term(v, order, h) +
           axis.stiffness * (std::abs(axis.anchor) + largest_term(q, order, h));
  };
  double x = axis_force(system.x, segment.drive_x, segment.x, segment.vx);
  double y = axis_force(system.y, segment.drive_y, segment.y, segment.vy) + system.weight;
  double moment = axis_force(system.phi, segment.drive_phi, segment.phi, segment.omega);

  const double turn = largest_term(segment.omega, order, h);
  const double reach = system.half_width + system.base_distance;
  const double length = std::abs(segment.x[0]) + std::abs(segment.y[0]) + reach + system.slot_half_width;
  const double speed = largest_term(segment.vx, order, h) + largest_term(segment.vy, order, h) + turn * length;
  State start;
  start.x = segment.x[0];
  start.y = segment.y[0];
  start.phi = segment.phi[0];
  Kinematics kinematics;
  const auto arm_of = [](const Vec2& lever, const Vec2& v) { return std::abs(cross(lever, v)); };
  double force_x = rounding * x, force_y = rounding * y, torque = rounding * moment;
  for (int i = 0; i < segment.loaded_count; ++i) {
    const ContactSeries& contact = segment.loaded[i];
    const Face face = segment.contacts[static_cast<std::size_t>(contact.site)].face;
    const double c = segment.cos_phi[0], s = segment.sin_phi[0];
    const double stiff = stiffness_of(system, face, c, s), damping = damping_of(system, face, c, s);
    noise.normal_force[i] = rounding * largest_term(contact.normal_force, order, h);
    noise.state_normal_force[i] =
        std::min(allowance, kMostLimitAllowance) * kStateRounding * (stiff * length + damping * speed);
    const double tangential =
        system.friction * noise.normal_force[i] + rounding * largest_term(contact.tangential_force, order, h);
    const ContactKinematics& k = kinematics[i] = contact_kinematics(system, start, contact.site, face);
    force_x += std::abs(k.normal.x) * noise.normal_force[i] + std::abs(k.tangent.x) * tangential;
    force_y += std::abs(k.normal.y) * noise.normal_force[i] + std::abs(k.tangent.y) * tangential;
    torque += arm_of(k.lever, k.normal) * noise.normal_force[i] + arm_of(k.lever, k.tangent) * tangential;
  }
  const double curvature = rounding * turn * speed;
  for (int i = 0; i < segment.loaded_count; ++i) {
    const ContactKinematics& k = kinematics[i];
    const auto rate = [&](double fx, double fy, double m) {
      return std::abs(k.tangent.x) * system.x.inverse_inertia * fx +
             std::abs(k.tangent.y) * system.y.inverse_inertia * fy +
             arm_of(k.lever, k.tangent) * system.phi.inverse_inertia * m;
    };
    noise.slip_rate[i] = rate(force_x, force_y, torque) + curvature;
    noise.mobility[i] = rate(std::abs(k.tangent.x), std::abs(k.tangent.y), arm_of(k.lever, k.tangent));
    const double f = system.friction, own = noise.state_normal_force[i];
    noise.state_slip_rate[i] =
        own * (rate(std::abs(k.normal.x), std::abs(k.normal.y), arm_of(k.lever, k.normal)) + f * noise.mobility[i]);
  }
  noise.held_slip_rate = *std::max_element(noise.slip_rate.begin(), noise.slip_rate.end());
  hold_noise(system, segment, kinematics, {force_x, force_y, torque}, rounding, curvature, noise);
  return noise;
}

}  // namespace vibratory_alignment
