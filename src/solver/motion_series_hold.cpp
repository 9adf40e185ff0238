// Part of MotionSeries: the tangential forces that hold sticking contacts (docs/hybrid_step.md "Stick").
#include <algorithm>
#include <cmath>

#include "solver/motion_series.h"

namespace vibratory_alignment {
namespace {

/// Rounding of V' relative to the sizes of its terms.
constexpr double kSlipRateRounding = 1e-15;

}  // namespace

void MotionSeries::set_up_mobility() {
  Mobility::Matrix matrix{};
  for (int m = 0; m < sticking_count_; ++m)
    for (int n = 0; n < sticking_count_; ++n) {
      const Contact& a = contacts_[sticking_[m]];
      const Contact& b = contacts_[sticking_[n]];
      matrix[m][n] = system_.x.inverse_inertia * a.drag[0][0] * b.drag[0][0] +
                     system_.y.inverse_inertia * a.drag[0][1] * b.drag[0][1] +
                     system_.phi.inverse_inertia * a.drag_moment[0] * b.drag_moment[0];
    }
  mobility_.set(matrix, sticking_count_, typical_mobility(system_));
}

double MotionSeries::slip_rate_size(const Segment& segment) const {
  const auto force = [](const Axis& axis, const Series& drive, const Series& q, const Series& v) {
    return std::abs(drive[0]) + axis.damping * std::abs(v[0]) + axis.stiffness * std::abs(q[0] - axis.anchor);
  };
  const double reach = system_.half_width + system_.base_distance;
  double forces = system_.weight;
  for (int i = 0; i < segment.loaded_count; ++i)
    forces += std::abs(segment.loaded[i].normal_force[0]) + std::abs(segment.loaded[i].tangential_force[0]);
  const double turn = std::abs(segment.omega[0]),
               speed = std::abs(segment.vx[0]) + std::abs(segment.vy[0]) + reach * turn;
  return system_.x.inverse_inertia * (force(system_.x, segment.drive_x, segment.x, segment.vx) + forces) +
         system_.y.inverse_inertia * (force(system_.y, segment.drive_y, segment.y, segment.vy) + forces) +
         reach * system_.phi.inverse_inertia *
             (force(system_.phi, segment.drive_phi, segment.phi, segment.omega) + reach * forces) +
         turn * speed;
}

/// Sum of the absolute values of what V' of power k is made of: what its rounding is measured by.
double MotionSeries::slip_rate_size(const Contact& contact, int k, const Segment& segment) const {
  const auto axis_size = [&](const Axis& axis, const Series& drive, const Series& q, const Series& v) {
    return std::abs(drive[k]) + axis.damping * std::abs(v[k]) + axis.stiffness * std::abs(q[k]);
  };
  double x =
      axis_size(system_.x, segment.drive_x, segment.x, segment.vx) + system_.x.stiffness * std::abs(system_.x.anchor);
  double y = axis_size(system_.y, segment.drive_y, segment.y, segment.vy) + std::abs(system_.y.anchor) + system_.weight;
  double moment = axis_size(system_.phi, segment.drive_phi, segment.phi, segment.omega);
  for (int i = 0; i < segment.loaded_count; ++i) {
    const Contact& other = contacts_[i];
    const ContactSeries& series = segment.loaded[i];
    for (int j = 0; j <= k; ++j) {
      const double n = std::abs(series.normal_force[k - j]);
      x += std::abs(other.push[j][0]) * n;
      y += std::abs(other.push[j][1]) * n;
      moment += std::abs(other.push_moment[j]) * n;
      if (!other.separate_t) continue;
      const double t = std::abs(series.tangential_force[k - j]);
      x += std::abs(other.drag[j][0]) * t;
      y += std::abs(other.drag[j][1]) * t;
      moment += std::abs(other.drag_moment[j]) * t;
    }
  }
  // V' along t, and what turning adds to it
  const double size = std::abs(contact.drag[0][0]) * system_.x.inverse_inertia * x +
                      std::abs(contact.drag[0][1]) * system_.y.inverse_inertia * y +
                      std::abs(contact.drag_moment[0]) * system_.phi.inverse_inertia * moment;
  double turning = 0.0;
  for (int j = 0; j <= k + 1; ++j) {
    const double reach =
        j == 0 ? system_.half_width + system_.base_distance : std::abs(segment.x[j]) + std::abs(segment.y[j]);
    turning += reach * direction_[k + 2 - j].abs().sum();
  }
  return size + (k + 2) * (k + 1) * turning;
}

/// Tangential forces of power k that keep V = 0: T = 0 first, then G T = -V' corrects the acceleration.
void MotionSeries::hold_sticking(int k, Segment& segment) {
  if (k == 0) set_up_mobility();
  // V' of power k without the forces sought
  trig_term(k + 2, segment);
  Mobility::Vector rhs{}, noise{};
  for (int m = 0; m < sticking_count_; ++m) {
    const Contact& contact = contacts_[sticking_[m]];
    point_term(contact.point, k + 2, segment);
    const PairSeries& point = points_[contact.point];
    const ContactFrame& f = contact.frame;
    rhs[m] = f.sign * (k + 2) * (k + 1) * (f.t1() * point[k + 2][0] + f.t2() * point[k + 2][1]);
    if (!mobility_.regular()) noise[m] = kSlipRateRounding * slip_rate_size(contact, k, segment);
  }
  const Mobility::Vector held = mobility_.hold(rhs, noise);
  for (int m = 0; m < sticking_count_; ++m) {
    const Contact& contact = contacts_[sticking_[m]];
    const Pair& d = contact.drag[0];
    const double force = held[m];
    segment.loaded[sticking_[m]].tangential_force[k] = force;
    segment.vx[k + 1] += system_.x.inverse_inertia * d[0] * force / (k + 1);
    segment.vy[k + 1] += system_.y.inverse_inertia * d[1] * force / (k + 1);
    segment.omega[k + 1] += system_.phi.inverse_inertia * contact.drag_moment[0] * force / (k + 1);
    if (k < kHeldPowers && !mobility_.regular()) {
      const double left = std::abs(mobility_.left_over(m, rhs, held));
      if (left > noise[m]) not_held_[k] = std::max(not_held_[k], left);
    }
  }
  segment.x[k + 2] = segment.vx[k + 1] / (k + 2);
  segment.y[k + 2] = segment.vy[k + 1] / (k + 2);
  segment.phi[k + 2] = segment.omega[k + 1] / (k + 2);
  known_centre_ = std::min(known_centre_, k + 1);  // that of k + 2 was without these forces
}

std::array<double, kSiteCount> MotionSeries::holding_force_noise(
    const std::array<double, kSiteCount>& slip_rate_noise) const {
  Mobility::Vector rate{};
  for (int m = 0; m < sticking_count_; ++m) rate[m] = slip_rate_noise[sticking_[m]];
  const Mobility::Vector spread = mobility_.spread(rate);
  std::array<double, kSiteCount> noise{};
  for (int m = 0; m < sticking_count_; ++m) noise[sticking_[m]] = spread[m];
  return noise;
}

}  // namespace vibratory_alignment
