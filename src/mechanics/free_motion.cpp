// What a flight begins with: the constants of the closed form. (Its values at one time: free_motion_at.cpp.)
#include "mechanics/free_motion.h"

#include <cmath>
#include <limits>

#include "mechanics/rough_log2.h"

namespace vibratory_alignment {
namespace {

/// Loss of digits through cancelling terms that the closed form is allowed before the series take over.
constexpr double kLargestGain = 1e3;

/// A mode has decayed when its velocity and third derivative are below these, relative to motions of order one.
constexpr double kNoVelocity = 1e-18, kNoThird = 1e-6;

/// Size of a vector of moderate numbers.
double length(double x, double y) { return std::sqrt(x * x + y * y); }

}  // namespace

FreeMotion::FreeMotion(const System& system, std::size_t drive_count)
    : system_(system), axis_{&system.x, &system.y, &system.phi}, free_axes_(system) {
  sines_.reserve(drive_count);
}

void FreeMotion::begin(const State& state) {
  start_q_ = Quad{state.x, state.y, state.phi, 0.0};
  constant_ = {0.0, -system_.weight, 0.0};
  slope_ = {};
  axis_exact_.fill(true);
  sines_.clear();
  sine_count_ = {};
  driven_rate_ = 0.0;
  const double velocity[] = {state.vx, state.vy, state.omega};
  for (int i = 0; i < FreeAxes::kCount; ++i) start_v_[i] = axis_[i]->moves ? velocity[i] : 0.0;
}

void FreeMotion::add(Direction direction, const DriveForm& form) {
  const auto i = static_cast<int>(direction);
  const Axis& axis = *axis_[i];
  if (!axis.moves) return;
  constant_[i] += form.constant;
  slope_[i] += form.slope;
  if (form.amplitude == 0.0) return;
  // steady response: (k - m nu^2) and h nu act on sin and cos
  const double nu = form.frequency;
  const double elastic = axis.stiffness - axis.inertia * nu * nu, viscous = axis.damping * nu;
  const double norm = elastic * elastic + viscous * viscous;
  const double size = axis.stiffness + axis.inertia * nu * nu;
  const double s = form.amplitude * form.cos_phase, c = form.amplitude * form.sin_phase;
  const double sin_amplitude = (elastic * s + viscous * c) / norm, cos_amplitude = (elastic * c - viscous * s) / norm;
  // a response far larger than the motion cancels against the start
  axis_exact_[i] = axis_exact_[i] && form.rate == 0.0 && norm * kLargestGain * kLargestGain > size * size &&
                   length(sin_amplitude, cos_amplitude) < kLargestGain;
  if (sine_count_[i] == sines_.size()) sines_.emplace_back();
  Sines& sines = sines_[sine_count_[i]++];
  sines.frequency[i] = nu;
  sines.half_frequency[i] = 0.5 * nu;
  sines.sin_amplitude[i] = sin_amplitude;
  sines.cos_amplitude[i] = cos_amplitude;
  driven_rate_ = std::max(driven_rate_, nu);
}

void FreeMotion::settle() {
  c_factor_ = s_factor_ = p1_ = p2_ = p3_ = Quad{};
  mode_ = fast_mode_ = least_rate_ = least_second_ = least_third_ = Quad{};
  fading_ = {};
  series_rate_ = std::max(free_axes_.fastest, driven_rate_);
  for (int i = 0; i < FreeAxes::kCount; ++i)
    if (axis_[i]->moves) settle_axis(i);
  exact_ = axis_exact_[FreeAxes::kX] && axis_exact_[FreeAxes::kY] && axis_exact_[FreeAxes::kPhi];
}

void FreeMotion::settle_axis(int i) {
  const double m = axis_[i]->inertia, h = axis_[i]->damping, k = axis_[i]->stiffness;
  const double constant = constant_[i], slope = slope_[i];
  bool exact = axis_exact_[i];
  double p0 = 0.0, p1 = 0.0, p2 = 0.0, p3 = 0.0;
  if (k > 0.0) {
    p1 = slope / k;
    p0 = axis_[i]->anchor + (constant - h * p1) / k;
    // a soft spring's far equilibrium: the long way to it cancels against the start
    exact = exact && !(std::abs(p0 - start_q_[i]) > kLargestGain || std::abs(p1) > kLargestGain);
  } else if (h > 0.0) {
    p2 = 0.5 * slope / h;
    p1 = (constant - 2.0 * m * p2) / h;
    const bool pulled = constant != 0.0 || slope != 0.0;
    exact = exact && !((pulled && free_axes_.constants[i].decay < 1.0 / kLargestGain) || std::abs(p1) > kLargestGain);
  } else {
    p2 = 0.5 * constant / m;
    p3 = slope / (6.0 * m);
  }
  axis_exact_[i] = exact;
  if (!exact) {
    fading_[0].rate[i] = free_axes_.constants[i].own_rate;
    fading_[0].until[i] = std::numeric_limits<double>::infinity();
    return;
  }
  double c_factor = start_q_[i] - p0, s_factor = start_v_[i] - p1;
  double rate = std::abs(p1), second = 2.0 * std::abs(p2), third = 6.0 * std::abs(p3);
  for (std::size_t n = 0; n < sine_count_[i]; ++n) {
    const Sines& sines = sines_[n];
    const double nu = sines.frequency[i], s = sines.sin_amplitude[i], c = sines.cos_amplitude[i];
    c_factor -= c;
    s_factor -= nu * s;
    const double amplitude = length(s, c);
    rate += amplitude * nu;
    second += amplitude * nu * nu;
    third += amplitude * nu * nu * nu;
  }
  p1_[i] = p1;
  p2_[i] = p2;
  p3_[i] = p3;
  c_factor_[i] = c_factor;
  s_factor_[i] = s_factor;
  least_rate_[i] = rate;
  least_second_[i] = second;
  least_third_[i] = third;
  find_modes(i, c_factor, s_factor);
}

/// Amplitudes of the modes, and when they have decayed.
void FreeMotion::find_modes(int i, double c, double s) {
  const auto& [pull, frequency, decay, square, root, slow, fast, own_rate, apart] = free_axes_.constants[i];
  if (!apart) {
    // t exp(-slow t) falls below exp(-slow t / 2) / slow
    fading_[0].set(i, own_rate, slow > 0.0 ? std::abs(c) + std::abs(s + decay * c) / slow : 0.0, 0.5 * slow);
  } else if (square < 0.0) {
    mode_[i] = length(c, (s + decay * c) / root);
    fading_[0].set(i, own_rate, mode_[i], decay);
  } else {
    mode_[i] = (c * fast + s) / (2.0 * root);
    fast_mode_[i] = -(c * slow + s) / (2.0 * root);
    fading_[0].set(i, fast, std::abs(fast_mode_[i]), fast);
    fading_[1].set(i, slow, std::abs(mode_[i]), slow);
  }
}

void FreeMotion::Fading::set(int i, double its_rate, double amplitude, double decay) {
  const double velocity = amplitude * its_rate, third = velocity * its_rate * its_rate;
  const double excess = std::max({velocity / kNoVelocity, third / kNoThird, 1.0});
  constexpr double kLn2 = 0.6931471805599453;
  rate[i] = its_rate;
  until[i] = decay > 0.0 ? kLn2 * rough_log2(excess) / decay : std::numeric_limits<double>::infinity();
}

}  // namespace vibratory_alignment
