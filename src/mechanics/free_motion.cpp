#include "mechanics/free_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vibratory_alignment {
namespace {

/// Loss of digits through cancelling terms that the closed form is allowed before the series take over.
constexpr double kLargestGain = 1e3;

/// A mode has decayed when its velocity and third derivative are below these, relative to motions of order one.
constexpr double kNoVelocity = 1e-18, kNoThird = 1e-6;

}  // namespace

void FreeMotion::begin(const Axis& axis, double q, double v, double constant_force) {
  axis_ = axis;
  start_q_ = q;
  start_v_ = v;
  constant_ = constant_force;
  slope_ = 0.0;
  exact_ = true;
  sines_.clear();
  p0_ = p1_ = p2_ = p3_ = 0.0;
  early_ = late_ = {};
  slow_ = {};
  slow_pull_ = 0.0;
  early_rate_ = late_rate_ = 0.0;
  decayed_ = std::numeric_limits<double>::infinity();
  if (!axis_.moves) return;
  const double m = axis_.inertia, h = axis_.damping, k = axis_.stiffness;
  decay_ = 0.5 * h / m;
  // (a - w)(a + w) loses no digits near critical damping
  pull_ = k / m;
  frequency_ = std::sqrt(pull_);
  square_ = (decay_ - frequency_) * (decay_ + frequency_);
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
  sines_.push_back({nu, (elastic * s + viscous * c) / norm, (elastic * c - viscous * s) / norm, s, c});
  // a response far larger than the motion cancels against the start
  if (!(std::hypot(sines_.back().sin_amplitude, sines_.back().cos_amplitude) < kLargestGain)) exact_ = false;
}

void FreeMotion::settle(Waves& waves) {
  if (!axis_.moves) return;
  early_rate_ = square_ > 0.0 ? decay_ + root_ : frequency_;
  for (const Sine& sine : sines_) late_rate_ = std::max(late_rate_, sine.frequency);
  early_rate_ = std::max(early_rate_, late_rate_);
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
  find_bounds();
}

double FreeMotion::slow_rate() const { return pull_ / (decay_ + root_); }

double FreeMotion::moving_acceleration(double t, const Waves::Values& waves, double q, double v) const {
  return t < decayed_ ? acceleration_by_forces(t, waves, q, v) : late_acceleration(t, waves);
}

/// What is left once the fastest mode has decayed. The forces of such an axis are large and cancel: their rounding,
/// over the time in which it now moves, would be more than the bounds on the motion know of.
double FreeMotion::late_acceleration(double t, const Waves::Values& waves) const {
  double sum = 2.0 * p2_ + 6.0 * p3_ * t;
  if (square_ > 0.0) sum += slow_pull_ * waves.left[fall_];
  for (const Sine& sine : sines_) {
    sum -= sine.frequency * sine.frequency *
           (sine.sin_amplitude * waves.sin(sine.wave) + sine.cos_amplitude * waves.cos(sine.wave));
  }
  return sum;
}

double FreeMotion::acceleration_by_forces(double t, const Waves::Values& waves, double q, double v) const {
  double force = constant_ + slope_ * t;
  for (const Sine& sine : sines_) {
    force += sine.sin_force * waves.sin(sine.wave) + sine.cos_force * waves.cos(sine.wave);
  }
  return axis_.inverse_inertia * (force - axis_.damping * v - axis_.stiffness * (q - axis_.anchor));
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

FreeMotion::Bounds FreeMotion::moving_bounds(double begin, double end) const {
  Bounds b = begin < decayed_ ? early_ : late_;
  const double left = slow_.amplitude > 0.0 ? slow_.amplitude * std::exp(-slow_.decay * begin) : 0.0;
  b.rate += left * slow_.rate;
  b.second += left * slow_.rate * slow_.rate;
  b.third += left * slow_.rate * slow_.rate * slow_.rate;
  const double p2 = std::abs(p2_), p3 = std::abs(p3_);
  b.rate += std::abs(p1_) + (2.0 * p2 + 3.0 * p3 * end) * end;
  b.second += 2.0 * p2 + 6.0 * p3 * end;
  b.third += 6.0 * p3;
  return b;
}

/// Bounds of all but the polynomial part.
void FreeMotion::find_bounds() {
  const double c = c_factor_, s = s_factor_;
  const auto add = [this](double amplitude, double rate) {
    for (Bounds* b : {&early_, &late_}) {
      b->rate += amplitude * rate;
      b->second += amplitude * rate * rate;
      b->third += amplitude * rate * rate * rate;
    }
  };
  for (const Sine& sine : sines_) add(std::hypot(sine.sin_amplitude, sine.cos_amplitude), sine.frequency);
  if (square_ < 0.0) {
    fade({std::hypot(c, (s + decay_ * c) / root_), frequency_, decay_});
  } else if (square_ > 0.0) {
    // the two decaying exponentials
    const double fast = decay_ + root_, slow = slow_rate();
    const double slow_amplitude = (c * fast + s) / (2.0 * root_);
    slow_ = {std::abs(slow_amplitude), slow, slow};
    slow_pull_ = slow_amplitude * slow * slow;
    late_rate_ = std::max(late_rate_, slow);
    fade({std::abs(c * slow + s) / (2.0 * root_), fast, fast});
  } else {
    // (c + g t) exp(-a t): derivative n is at most a^n |c| + a^(n-1) |g| n
    const double g = std::abs(s + decay_ * c);
    add(std::abs(c), decay_);
    early_.rate += g;
    early_.second += 2.0 * g * decay_;
    early_.third += 3.0 * g * decay_ * decay_;
  }
}

/// Adds the fastest mode to the bounds, to the late ones what is left of it once it has decayed. It falls
/// monotonically: what bounds it at one time bounds it ever after.
void FreeMotion::fade(const Mode& fastest) {
  const double rate = fastest.rate, velocity = fastest.amplitude * rate, third = velocity * rate * rate;
  const double excess = std::max({velocity / kNoVelocity, third / kNoThird, 1.0});
  if (fastest.decay > 0.0) decayed_ = std::log(excess) / fastest.decay;
  early_.rate += velocity;
  early_.second += velocity * rate;
  early_.third += third;
  late_.rate += velocity / excess;
  late_.second += velocity * rate / excess;
  late_.third += third / excess;
}

double FreeMotion::moving_rate(double t) const { return t < decayed_ ? early_rate_ : late_rate_; }

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
