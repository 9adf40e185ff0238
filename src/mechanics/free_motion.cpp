#include "mechanics/free_motion.h"

#include <algorithm>
#include <cmath>

namespace vibratory_alignment {
namespace {

/// Loss of digits through cancelling terms that the closed form is allowed before the series take over.
constexpr double kLargestGain = 1e3;

}  // namespace

void FreeMotion::begin(const Axis& axis, double q, double v, double constant_force) {
  axis_ = axis;
  start_q_ = q;
  start_v_ = v;
  constant_ = constant_force;
  slope_ = 0.0;
  exact_ = true;
  sines_.clear();
  if (!axis_.moves) return;
  const double m = axis_.inertia, h = axis_.damping, k = axis_.stiffness;
  decay_ = 0.5 * h / m;
  // (a - w)(a + w) loses no digits near critical damping
  const double frequency = std::sqrt(k / m);
  square_ = (decay_ - frequency) * (decay_ + frequency);
  root_ = std::sqrt(std::abs(square_));
}

void FreeMotion::add(const DriveForm& form) {
  constant_ += form.constant;
  slope_ += form.slope;
  if (form.amplitude == 0.0 || !axis_.moves) return;
  if (form.rate != 0.0) exact_ = false;
  // steady response: (k - m nu^2) and h nu act on sin and cos
  const double nu = form.frequency;
  const double elastic = axis_.stiffness - axis_.inertia * nu * nu, viscous = axis_.damping * nu;
  const double norm = elastic * elastic + viscous * viscous;
  const double size = axis_.stiffness + axis_.inertia * nu * nu;
  if (!(norm * kLargestGain * kLargestGain > size * size)) exact_ = false;
  const double s = form.amplitude * form.cos_phase, c = form.amplitude * form.sin_phase;
  sines_.push_back({nu, (elastic * s + viscous * c) / norm, (elastic * c - viscous * s) / norm});
  // a response far larger than the motion cancels against the start
  if (!(std::hypot(sines_.back().sin_amplitude, sines_.back().cos_amplitude) < kLargestGain)) exact_ = false;
}

void FreeMotion::settle() {
  if (!axis_.moves || !exact_) return;
  const double m = axis_.inertia, h = axis_.damping, k = axis_.stiffness;
  p0_ = p1_ = p2_ = p3_ = 0.0;
  if (k > 0.0) {
    p1_ = slope_ / k;
    p0_ = axis_.anchor + (constant_ - h * p1_) / k;
    // a soft spring's far equilibrium: the long way to it cancels against the start
    if (std::abs(p0_ - start_q_) > kLargestGain || std::abs(p1_) > kLargestGain) exact_ = false;
  } else if (h > 0.0) {
    p2_ = 0.5 * slope_ / h;
    p1_ = (constant_ - 2.0 * m * p2_) / h;
    if ((constant_ != 0.0 || slope_ != 0.0) && decay_ < 1.0 / kLargestGain) exact_ = false;
    if (std::abs(p1_) > kLargestGain) exact_ = false;
  } else {
    p2_ = 0.5 * constant_ / m;
    p3_ = slope_ / (6.0 * m);
  }
  double q = 0.0, v = 0.0;
  particular(0.0, q, v);
  c_factor_ = start_q_ - q;
  s_factor_ = start_v_ - v;
}

void FreeMotion::particular(double t, double& q, double& v) const {
  q = p0_ + t * (p1_ + t * (p2_ + t * p3_));
  v = p1_ + t * (2.0 * p2_ + t * 3.0 * p3_);
  for (const Sine& sine : sines_) {
    const double s = std::sin(sine.frequency * t), c = std::cos(sine.frequency * t);
    q += sine.sin_amplitude * s + sine.cos_amplitude * c;
    v += sine.frequency * (sine.sin_amplitude * c - sine.cos_amplitude * s);
  }
}

void FreeMotion::homogeneous(double t, double& c, double& s, double& c_rate, double& s_rate) const {
  // S solves the free equation with S(0) = 0, S'(0) = 1; C = S' + 2a S has C(0) = 1, C'(0) = 0; C' = -(k/m) S
  if (square_ < 0.0) {
    const double envelope = std::exp(-decay_ * t);
    s = envelope * std::sin(root_ * t) / root_;
    s_rate = envelope * std::cos(root_ * t) - decay_ * s;
  } else if (square_ > 0.0) {
    // rates a -+ root; the slow one without cancellation
    const double fast = decay_ + root_, slow = axis_.stiffness / axis_.inertia / fast;
    const double slow_part = std::exp(-slow * t), ratio = -std::expm1(-2.0 * root_ * t);
    s = slow_part * ratio / (2.0 * root_);
    s_rate = slow_part * (1.0 - ratio) - slow * s;
  } else {
    const double envelope = std::exp(-decay_ * t);
    s = t * envelope;
    s_rate = envelope - decay_ * s;
  }
  c = s_rate + 2.0 * decay_ * s;
  c_rate = -axis_.stiffness / axis_.inertia * s;
}

FreeMotion::Bounds FreeMotion::bounds(double end) const {
  Bounds b;
  if (!axis_.moves) return b;
  const double c = c_factor_, s = s_factor_;
  const auto add = [&b](double amplitude, double rate) {
    b.rate += amplitude * rate;
    b.second += amplitude * rate * rate;
    b.third += amplitude * rate * rate * rate;
  };
  if (square_ < 0.0) {
    add(std::hypot(c, (s + decay_ * c) / root_), std::hypot(decay_, root_));
  } else if (square_ > 0.0) {
    // the two decaying exponentials
    const double fast = decay_ + root_, slow = axis_.stiffness / axis_.inertia / fast;
    add(std::abs(c * fast + s) / (2.0 * root_), slow);
    add(std::abs(c * slow + s) / (2.0 * root_), fast);
  } else {
    // (c + g t) exp(-a t): derivative n is at most a^n |c| + a^(n-1) |g| (n + 1/e)
    const double g = std::abs(s + decay_ * c);
    add(std::abs(c), decay_);
    b.rate += 1.37 * g;
    b.second += 2.37 * g * decay_;
    b.third += 3.37 * g * decay_ * decay_;
  }
  for (const Sine& sine : sines_) add(std::hypot(sine.sin_amplitude, sine.cos_amplitude), sine.frequency);
  const double p2 = std::abs(p2_), p3 = std::abs(p3_);
  b.rate += std::abs(p1_) + (2.0 * p2 + 3.0 * p3 * end) * end;
  b.second += 2.0 * p2 + 6.0 * p3 * end;
  b.third += 6.0 * p3;
  return b;
}

double FreeMotion::rate() const {
  if (!axis_.moves) return 0.0;
  double fastest = square_ > 0.0 ? decay_ + root_ : std::hypot(decay_, root_);
  for (const Sine& sine : sines_) fastest = std::max(fastest, sine.frequency);
  return fastest;
}

void FreeMotion::at(double t, double& q, double& v) const {
  if (!axis_.moves) {
    q = start_q_;
    v = 0.0;
    return;
  }
  double c, s, c_rate, s_rate;
  homogeneous(t, c, s, c_rate, s_rate);
  particular(t, q, v);
  q += c_factor_ * c + s_factor_ * s;
  v += c_factor_ * c_rate + s_factor_ * s_rate;
}

}  // namespace vibratory_alignment
