#include "mechanics/free_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/rough_log2.h"

namespace vibratory_alignment {
namespace {

/// Loss of digits through cancelling terms that the closed form is allowed before the series take over.
constexpr double kLargestGain = 1e3;

/// Near critical damping, |square| below the square of this part of the decay, the terms of the two modes nearly
/// cancel.
constexpr double kApart = 0.8;

/// A mode has decayed when its velocity and third derivative are below these, relative to motions of order one.
constexpr double kNoVelocity = 1e-18, kNoThird = 1e-6;

/// Size of a vector of moderate numbers.
double length(double x, double y) { return std::sqrt(x * x + y * y); }

}  // namespace

void FreeMotion::begin(const Axis& axis, double q, double v, double constant_force) {
  axis_ = axis;
  start_q_ = q;
  if (!axis_.moves) return;
  start_v_ = v;
  constant_ = constant_force;
  slope_ = 0.0;
  exact_ = true;
  sines_.clear();
  p0_ = p1_ = p2_ = p3_ = 0.0;
  driven_ = {};
  driven_rate_ = own_rate_ = 0.0;
  fading_ = {};
  const double m = axis_.inertia, h = axis_.damping, k = axis_.stiffness;
  decay_ = 0.5 * h / m;
  // (a - w)(a + w) loses no digits near critical damping
  pull_ = k / m;
  frequency_ = std::sqrt(pull_);
  square_ = (decay_ - frequency_) * (decay_ + frequency_);
  root_ = std::sqrt(std::abs(square_));
}

void FreeMotion::add(const DriveForm& form) {
  if (!axis_.moves) return;
  constant_ += form.constant;
  slope_ += form.slope;
  if (form.amplitude == 0.0) return;
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
  if (!(length(sines_.back().sin_amplitude, sines_.back().cos_amplitude) < kLargestGain)) exact_ = false;
}

void FreeMotion::settle(Waves& waves) {
  if (!axis_.moves) return;
  own_rate_ = square_ > 0.0 ? decay_ + root_ : frequency_;
  fading_[0] = {own_rate_, std::numeric_limits<double>::infinity()};
  for (const Sine& sine : sines_) driven_rate_ = std::max(driven_rate_, sine.frequency);
  if (!exact_) return;
  const double m = axis_.inertia, h = axis_.damping, k = axis_.stiffness;
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
  c_factor_ = start_q_ - p0_;
  s_factor_ = start_v_ - p1_;
  for (const Sine& sine : sines_) {
    c_factor_ -= sine.cos_amplitude;
    s_factor_ -= sine.frequency * sine.sin_amplitude;
  }
  if (square_ < 0.0) oscillation_ = waves.add_oscillation(root_);
  for (Sine& sine : sines_) sine.wave = waves.add_oscillation(sine.frequency);
  // overdamped: the slow rate without cancellation, and how far apart the two are
  fall_ = waves.add_decay(square_ > 0.0 ? slow_rate() : decay_);
  if (square_ > 0.0) ratio_ = waves.add_decay(2.0 * root_);
  find_modes();
}

double FreeMotion::slow_rate() const { return pull_ / (decay_ + root_); }

/// All in closed form. Forces of a stiff or light axis are large and cancel: their rounding, over the time in which it
/// moves once its fast motion has decayed, would be more than the bounds know of.
FreeMotion::Outlook FreeMotion::moving_outlook(double t, double end, const Waves::Values& waves) const {
  Outlook outlook{2.0 * p2_ + 6.0 * p3_ * t, driven_};
  const double p2 = std::abs(p2_), p3 = std::abs(p3_);
  outlook.bounds.rate += std::abs(p1_) + (2.0 * p2 + 3.0 * p3 * end) * end;
  outlook.bounds.second += 2.0 * p2 + 6.0 * p3 * end;
  outlook.bounds.third += 6.0 * p3;
  for (const Sine& sine : sines_)
    outlook.acceleration -= sine.frequency * sine.frequency *
                            (sine.sin_amplitude * waves.sin(sine.wave) + sine.cos_amplitude * waves.cos(sine.wave));
  if (apart_ && square_ > 0.0)
    add_modes(waves, outlook);
  else
    add_free(t, waves, outlook);
  return outlook;
}

/// Two exponentials, each of which falls: what bounds it at one time bounds it ever after.
void FreeMotion::add_modes(const Waves::Values& waves, Outlook& outlook) const {
  const double slow = slow_rate(), fast = decay_ + root_;
  const double slow_left = slow_ * waves.left[fall_], fast_left = fast_ * waves.left[fall_] * waves.left[ratio_];
  outlook.acceleration += slow_left * slow * slow + fast_left * fast * fast;
  outlook.bounds.add(std::abs(slow_left), slow);
  outlook.bounds.add(std::abs(fast_left), fast);
}

/// c C + s S, with C and S as homogeneous() has them, but C itself: what is left of it keeps its digits.
void FreeMotion::add_free(double t, const Waves::Values& waves, Outlook& outlook) const {
  const double left = waves.left[fall_];
  double slope = 0.0, sine = 0.0;  // S' and S
  if (square_ < 0.0) {
    sine = left * waves.sin(oscillation_) / root_;
    slope = left * waves.cos(oscillation_) - decay_ * sine;
  } else if (square_ > 0.0) {
    sine = left * -waves.change[ratio_] / (2.0 * root_);
    slope = left - (decay_ + root_) * sine;
  } else {
    sine = t * left;
    slope = left - decay_ * sine;
  }
  const double first = s_factor_ * slope - c_factor_ * pull_ * sine;
  const double q = c_factor_ * (slope + 2.0 * decay_ * sine) + s_factor_ * sine;
  const double second = -pull_ * q - 2.0 * decay_ * first;
  outlook.acceleration += second;
  Bounds& bounds = outlook.bounds;
  if (apart_) {
    bounds.add(swing_ * left, frequency_);
    return;
  }
  // derivative n after a time s: exp(-a s) (q_n cosh(r s) + (q_n+1 + a q_n) sinh(r s)/r), the last below 1/2a
  const double third = -pull_ * first - 2.0 * decay_ * second, fourth = -pull_ * second - 2.0 * decay_ * third;
  const double most = decay_ > 0.0 ? 0.5 / decay_ : 0.0;
  bounds.rate += std::abs(first) + std::abs(second + decay_ * first) * most;
  bounds.second += std::abs(second) + std::abs(third + decay_ * second) * most;
  bounds.third += std::abs(third) + std::abs(fourth + decay_ * third) * most;
}

/// Change of the particular solution since t = 0.
void FreeMotion::add_particular(double t, const Waves::Values& waves, double& q, double& v) const {
  q += t * (p1_ + t * (p2_ + t * p3_));
  v += t * (2.0 * p2_ + t * 3.0 * p3_);
  for (const Sine& sine : sines_) {
    const double half_s = waves.half_sin[sine.wave], half_c = waves.half_cos[sine.wave];
    const double s = 2.0 * half_s * half_c, c_change = -2.0 * half_s * half_s;
    q += sine.sin_amplitude * s + sine.cos_amplitude * c_change;
    v += sine.frequency * (sine.sin_amplitude * c_change - sine.cos_amplitude * s);
  }
}

/// C - 1 and S: S solves the free equation with S(0) = 0, S'(0) = 1; C = S' + 2a S has C(0) = 1, C'(0) = 0.
void FreeMotion::homogeneous(double t, const Waves::Values& waves, double& c_change, double& s) const {
  const double fall = waves.change[fall_], envelope = waves.left[fall_];
  if (square_ < 0.0) {
    const double half_s = waves.half_sin[oscillation_], half_c = waves.half_cos[oscillation_];
    s = envelope * 2.0 * half_s * half_c / root_;
    c_change = -2.0 * envelope * half_s * half_s + fall + decay_ * s;
  } else if (square_ > 0.0) {
    // rates a -+ root: the slow one, and their ratio
    s = envelope * -waves.change[ratio_] / (2.0 * root_);
    c_change = fall + slow_rate() * s;
  } else {
    s = t * envelope;
    c_change = fall + decay_ * s;
  }
}

/// Amplitudes of the modes, and when they have decayed.
void FreeMotion::find_modes() {
  for (const Sine& sine : sines_) driven_.add(length(sine.sin_amplitude, sine.cos_amplitude), sine.frequency);
  const double c = c_factor_, s = s_factor_, slow = square_ > 0.0 ? slow_rate() : decay_;
  apart_ = root_ > kApart * decay_;
  if (!apart_) {
    // t exp(-slow t) falls below exp(-slow t / 2) / slow
    if (slow > 0.0) fading_[0] = fading(std::abs(c) + std::abs(s + decay_ * c) / slow, own_rate_, 0.5 * slow);
  } else if (square_ < 0.0) {
    swing_ = length(c, (s + decay_ * c) / root_);
    fading_[0] = fading(swing_, own_rate_, decay_);
  } else {
    slow_ = (c * (decay_ + root_) + s) / (2.0 * root_);
    fast_ = -(c * slow + s) / (2.0 * root_);
    fading_ = {fading(std::abs(fast_), own_rate_, own_rate_), fading(std::abs(slow_), slow, slow)};
  }
}

FreeMotion::Fading FreeMotion::fading(double amplitude, double rate, double decay) {
  const double velocity = amplitude * rate, third = velocity * rate * rate;
  const double excess = std::max({velocity / kNoVelocity, third / kNoThird, 1.0});
  constexpr double kLn2 = 0.6931471805599453;
  return {rate, decay > 0.0 ? kLn2 * rough_log2(excess) / decay : std::numeric_limits<double>::infinity()};
}

double FreeMotion::moving_rate(double t) const {
  double rate = driven_rate_;
  for (const Fading& part : fading_)
    if (t < part.until) rate = std::max(rate, part.rate);
  return rate;
}

/// Position and velocity of an axis that moves.
void FreeMotion::move(double t, const Waves::Values& waves, double& q, double& v) const {
  // all as changes since the start: what is far larger than the motion cancels in them
  double c_change = 0.0, s = 0.0;
  homogeneous(t, waves, c_change, s);
  q = start_q_ + c_factor_ * c_change + s_factor_ * s;
  v = start_v_ - c_factor_ * pull_ * s + s_factor_ * (c_change - 2.0 * decay_ * s);
  add_particular(t, waves, q, v);
}

}  // namespace vibratory_alignment
