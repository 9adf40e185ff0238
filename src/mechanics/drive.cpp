#include "mechanics/drive.h"

#include <cmath>
#include <limits>

namespace vibratory_alignment {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kTwoPiHigh = 6.283185307179586477;
constexpr double kTwoPiLow = 2.449293598294706414e-16;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Unevaluated sum of two doubles.
struct Double2 {
  double high, low;
};

Double2 product(double a, Double2 b) {
  const double p = a * b.high;
  return {p, std::fma(a, b.high, -p) + a * b.low};
}

Double2 product(Double2 a, Double2 b) {
  const double p = a.high * b.high;
  return {p, std::fma(a.high, b.high, -p) + (a.high * b.low + a.low * b.high)};
}

/// The angle modulo 2 pi, between -pi and pi.
double reduce(Double2 angle) {
  const double turns = std::nearbyint(angle.high / kTwoPiHigh);
  return (std::fma(-turns, kTwoPiHigh, angle.high) - turns * kTwoPiLow) + angle.low;
}

Double2 elapsed(const Instant& from, const Instant& to) {
  const double high = to.high - from.high;
  const double part = high - to.high;
  const double error = (to.high - (high - part)) + (-from.high - part);
  return {high, error + (to.low - from.low)};
}

/// The angle in [0, 2 pi).
double wrap(double angle) {
  if (!(std::abs(angle) < kTwoPiHigh)) angle = std::fmod(angle, kTwoPiHigh);
  return angle < 0.0 ? angle + kTwoPiHigh : angle;
}

/// Sine or cosine of a phase, zero where the last digit of the phase makes it so: a force that begins at its peak has
/// no slope.
double zero_within_rounding(double value, double theta) {
  constexpr double kHalfDigit = 1.2e-16;
  return std::abs(value) <= kHalfDigit * theta ? 0.0 : value;
}

}  // namespace

bool same_sweep(const Excitation& a, const Excitation& b) {
  return a.waveform == Waveform::chirp && b.waveform == Waveform::chirp && a.frequency == b.frequency &&
         a.end_frequency == b.end_frequency && a.sweep_time == b.sweep_time;
}

Drive::Drive(const Excitation& excitation, const Instant& now)
    : excitation_(excitation), reference_(now), reference_phase_(wrap(excitation.phase)) {
  choose_branch(now);
}

double Drive::phase_at(const Instant& t) const {
  const Double2 dt = elapsed(reference_, t);
  double angle = 0.0;
  if (excitation_.waveform == Waveform::chirp && excitation_.sweep_time > 0.0) {
    // during the sweep nu t + r t^2/2, after it the same up to its end and the end frequency from there
    const double rate = (excitation_.end_frequency - excitation_.frequency) / excitation_.sweep_time;
    if (branch_ == 0) {
      angle = reduce(product(excitation_.frequency, dt)) + reduce(product(0.5 * rate, product(dt, dt)));
    } else {
      const Double2 swept{excitation_.sweep_time, 0.0}, after = elapsed(reference_ + excitation_.sweep_time, t);
      const double at_end =
          reduce(product(excitation_.frequency, swept)) + reduce(product(0.5 * rate, product(swept, swept)));
      angle = at_end + reduce(product(excitation_.end_frequency, after));
    }
  } else {
    angle = reduce(product(excitation_.frequency, dt));
  }
  return wrap(reference_phase_ + angle);
}

void Drive::choose_branch(const Instant& now) {
  const double theta = phase_at(now);
  branch_ = 0;
  if (excitation_.waveform == Waveform::square) branch_ = theta < kPi ? 0 : 1;
  if (excitation_.waveform == Waveform::triangle) branch_ = theta >= 0.5 * kPi && theta < 1.5 * kPi ? 1 : 0;
}

DriveForm Drive::form_at(const Instant& t) const {
  DriveForm form;
  const double amplitude = excitation_.amplitude;
  const double theta = phase_at(t);
  switch (excitation_.waveform) {
    case Waveform::square: form.constant = branch_ == 0 ? amplitude : -amplitude; break;
    case Waveform::triangle: {
      // rising through 0 at theta = 0 (2 pi), falling through 0 at theta = pi
      const double slope = amplitude * 2.0 / kPi;
      if (branch_ == 0) {
        form.constant = slope * (theta > kPi ? theta - kTwoPiHigh : theta);
        form.slope = slope * excitation_.frequency;
      } else {
        form.constant = slope * (kPi - theta);
        form.slope = -slope * excitation_.frequency;
      }
      break;
    }
    case Waveform::chirp: {
      const double rate = (excitation_.end_frequency - excitation_.frequency) / excitation_.sweep_time;
      form.frequency = branch_ == 0 ? excitation_.frequency + rate * (t - reference_) : excitation_.end_frequency;
      form.rate = branch_ == 0 ? rate : 0.0;
      form.amplitude = amplitude;
      break;
    }
    case Waveform::sine:
      form.frequency = excitation_.frequency;
      form.amplitude = amplitude;
      break;
  }
  if (form.amplitude != 0.0) {
    form.sin_phase = zero_within_rounding(std::sin(theta), theta);
    form.cos_phase = zero_within_rounding(std::cos(theta), theta);
  }
  return form;
}

double Drive::time_to_kink(const Instant& t) const {
  if (excitation_.amplitude == 0.0) return kInfinity;
  double target = 0.0;
  switch (excitation_.waveform) {
    case Waveform::square: target = branch_ == 0 ? kPi : kTwoPiHigh; break;
    case Waveform::triangle: target = branch_ == 0 ? 0.5 * kPi : 1.5 * kPi; break;
    case Waveform::chirp: return branch_ == 0 ? std::max(0.0, excitation_.sweep_time - (t - reference_)) : kInfinity;
    case Waveform::sine: return kInfinity;
  }
  // the way to go, at most half a turn; just before or after the target it may come out as minus nothing
  double way = wrap(target - phase_at(t));
  if (way > 1.5 * kPi) way = 0.0;
  return way / excitation_.frequency;
}

void Drive::pass_kink() { branch_ = 1 - branch_; }

void Drive::change(const Excitation& excitation, const Instant& now) {
  const double shift = excitation.phase - excitation_.phase;
  // without amplitude nobody asked for the end of the sweep
  if (excitation_.waveform == Waveform::chirp && now - reference_ >= excitation_.sweep_time) branch_ = 1;
  if (same_sweep(excitation, excitation_)) {
    excitation_ = excitation;
    reference_phase_ = wrap(reference_phase_ + shift);
    return;
  }
  // at a kink the last digit of the phase does not tell which law holds: that of before it goes on
  const bool goes_on = excitation.waveform == excitation_.waveform && excitation.waveform != Waveform::chirp &&
                       shift == 0.0 && excitation_.amplitude != 0.0;
  const double theta = phase_at(now);
  excitation_ = excitation;
  reference_ = now;
  reference_phase_ = wrap(theta + shift);
  if (!goes_on) choose_branch(now);
}

}  // namespace vibratory_alignment
