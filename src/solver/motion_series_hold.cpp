// Part of MotionSeries: the tangential forces that hold sticking contacts (docs/hybrid_step.md "Stick").
#include <algorithm>
#include <cmath>

#include "solver/motion_series_terms.h"

namespace vibratory_alignment {
namespace {

/// Rounding of V' relative to the sizes of its terms.
constexpr double kSlipRateRounding = 1e-15;

/// Part of the accelerations that, if no more is left of them, shows their rounding.
constexpr double kMostlyHeld = 1e-4;

}  // namespace

void MotionSeries::set_up_holding() {
  HoldingForces::Rows rows;
  for (int m = 0; m < sticking_count_; ++m) {
    const Contact& contact = contacts_[sticking_[m]];
    rows[m] = {contact.drag[0][0], contact.drag[0][1], contact.drag[0][2]};
  }
  holding_.set(system_, rows, sticking_count_);
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
      moment += std::abs(other.push[j][2]) * n;
      if (!other.separate_t) continue;
      const double t = std::abs(series.tangential_force[k - j]);
      x += std::abs(other.drag[j][0]) * t;
      y += std::abs(other.drag[j][1]) * t;
      moment += std::abs(other.drag[j][2]) * t;
    }
  }
  // V' along t, and what turning adds to it
  const double size = std::abs(contact.drag[0][0]) * system_.x.inverse_inertia * x +
                      std::abs(contact.drag[0][1]) * system_.y.inverse_inertia * y +
                      std::abs(contact.drag[0][2]) * system_.phi.inverse_inertia * moment;
  return size + motion_size(k, k + 1, segment);
}

/// Likewise of what V' of power k is made of in the motion, positions up to power `known`.
double MotionSeries::motion_size(int k, int known, const Segment& segment) const {
  double sum = 0.0;
  for (int j = 0; j <= known; ++j) {
    const double reach =
        j == 0 ? system_.half_width + system_.base_distance : std::abs(segment.x[j]) + std::abs(segment.y[j]);
    sum += reach * (std::abs(direction_[k + 2 - j][0]) + std::abs(direction_[k + 2 - j][1]));
  }
  return (k + 2) * (k + 1) * sum;
}

/// V' of power k of the sticking contacts, negated; the motion is known to the forces of this power.
void MotionSeries::negated_slip_rates(int k, Segment& segment, HoldingForces::Vector& rates) {
  trig_term(k + 2, segment);
  for (int m = 0; m < sticking_count_; ++m) {
    const Contact& contact = contacts_[sticking_[m]];
    point_term(contact.point, k + 2, segment);
    const PairSeries& point = points_[contact.point];
    const ContactFrame& f = contact.frame;
    rates[m] = f.sign * (k + 2) * (k + 1) * (f.t1() * point[k + 2][0] + f.t2() * point[k + 2][1]);
  }
}

/// The accelerations of power k.
HoldingForces::Answer MotionSeries::motion(int k, const Segment& segment) {
  return {{}, (k + 1) * segment.vx[k + 1], (k + 1) * segment.vy[k + 1], (k + 1) * segment.omega[k + 1]};
}

void MotionSeries::set_motion(int k, const HoldingForces::Answer& motion, Segment& segment) {
  segment.vx[k + 1] = motion.x / (k + 1);
  segment.vy[k + 1] = motion.y / (k + 1);
  segment.omega[k + 1] = motion.phi / (k + 1);
  segment.x[k + 2] = segment.vx[k + 1] / (k + 2);
  segment.y[k + 2] = segment.vy[k + 1] / (k + 2);
  segment.phi[k + 2] = segment.omega[k + 1] / (k + 2);
  known_centre_ = std::min(known_centre_, k + 1);  // that of k + 2 was without this motion
}

/// Tangential forces of power k that keep V = 0: those that the accelerations with T = 0, and what the powers before
/// make of V', ask for.
void MotionSeries::hold_sticking(int k, Segment& segment) {
  if (k == 0) set_up_holding();
  const HoldingForces::Answer free = motion(k, segment);
  HoldingForces::Vector rates{}, noise{}, own{};
  set_motion(k, {}, segment);
  negated_slip_rates(k, segment, rates);
  for (int m = 0; m < sticking_count_; ++m) own[m] = -rates[m];
  const bool needs_noise = !holding_.regular() && (k < kHeldPowers || holding_.tells_apart_by_noise());
  for (int m = 0; m < sticking_count_ && needs_noise; ++m)
    noise[m] = kSlipRateRounding * slip_rate_size(contacts_[sticking_[m]], k, segment);
  HoldingForces::Answer held = holding_.hold_motion(free, own, noise);
  const auto take = [&] {
    for (int m = 0; m < sticking_count_; ++m) segment.loaded[sticking_[m]].tangential_force[k] = held.force[m];
    set_motion(k, held, segment);
  };
  take();
  // in all powers alike: one in which more is left would set the step
  if (k == 0) takes_out_twice_ = rounding_shows(free, held, segment);
  if (!takes_out_twice_) {
    watch_held(k, rates, noise, held);
    return;
  }
  // the rounding of these large forces is no motion
  negated_slip_rates(k, segment, rates);
  if (needs_noise) noise.fill(kSlipRateRounding * motion_size(k, k + 2, segment));
  HoldingForces::Answer correction = holding_.hold(rates, noise);
  if (correction.told_apart && !held.told_apart) {  // T are then those of the motion, told apart as well
    held = holding_.hold_motion(free, own, {});
    take();
    negated_slip_rates(k, segment, rates);
    correction = holding_.hold(rates, noise);
  }
  watch_held(k, rates, noise, correction);
  const HoldingForces::Answer now = motion(k, segment);
  set_motion(k, {{}, now.x + correction.x, now.y + correction.y, now.phi + correction.phi}, segment);
}

/// True when the rounding of T may show: where it moves the part by more than its motion is rounded, where little is
/// left of the motion, and where V of what slides beside may begin with less.
bool MotionSeries::rounding_shows(const HoldingForces::Answer& free, const HoldingForces::Answer& held,
                                  const Segment& segment) const {
  const double reach = system_.half_width + system_.base_distance;
  const auto size = [&](const HoldingForces::Answer& a) {
    return std::abs(a.x) + std::abs(a.y) + reach * std::abs(a.phi);
  };
  const bool something_slides = segment.loaded_count > sticking_count_;
  return holding_.delicate() || something_slides || size(held) < kMostlyHeld * size(free);
}

/// Keeps what is left of V' of power k.
void MotionSeries::watch_held(int k, const HoldingForces::Vector& rates, const HoldingForces::Vector& noise,
                              const HoldingForces::Answer& held) {
  if (k >= kHeldPowers || holding_.regular()) return;
  for (int m = 0; m < sticking_count_; ++m) {
    const double left = std::abs(holding_.left_over(m, rates, held));
    if (left > noise[m]) not_held_[k] = std::max(not_held_[k], left);
  }
}

std::array<double, kSiteCount> MotionSeries::holding_force_noise(
    const std::array<double, kSiteCount>& slip_rate_noise) const {
  HoldingForces::Vector rate{};
  for (int m = 0; m < sticking_count_; ++m) rate[m] = slip_rate_noise[sticking_[m]];
  const HoldingForces::Vector spread = holding_.spread(rate);
  std::array<double, kSiteCount> noise{};
  for (int m = 0; m < sticking_count_; ++m) noise[sticking_[m]] = spread[m];
  return noise;
}

}  // namespace vibratory_alignment
