// A flight in closed form at one of its times: all as changes since the start, as what is far larger than the motion
// cancels in them.
#include "mechanics/free_motion.h"
#include "mechanics/quad_functions.h"

namespace vibratory_alignment {
namespace {

/// Adds the absolute value of `of` times `factor`.
VIBRATORY_ALIGNMENT_INLINE void add_size(const Quad& of, const Quad& factor, Quad& to) {
  to += (of < 0.0 ? -of : of) * factor;
}

/// Adds bounds on the first three derivatives of an oscillation, or of a decay, at this rate.
VIBRATORY_ALIGNMENT_INLINE void add_bounds(const Quad& amplitude, const Quad& rate, FreeMotion::Outlook& outlook) {
  const Quad velocity = (amplitude < 0.0 ? -amplitude : amplitude) * rate;
  outlook.rate += velocity;
  outlook.second += velocity * rate;
  outlook.third += velocity * rate * rate;
}

}  // namespace

VIBRATORY_ALIGNMENT_INLINE void FreeMotion::own_at(double t, Own& own) const {
  Quad change;
  exp_change(free_axes_.fall * -t, change, own.left);
  Quad swing = free_axes_.critical * t;  // S without its fall
  Quad swing_change{};                   // cos - 1
  if (free_axes_.any_underdamped) {
    Quad half_sin, half_cos;
    sin_cos_of_any(free_axes_.half_root * t, free_axes_.largest_half_root * t, half_sin, half_cos);
    swing += 2.0 * half_sin * half_cos * free_axes_.inverse_root;
    swing_change = -2.0 * half_sin * half_sin;
  }
  if (free_axes_.any_overdamped) {
    Quad apart_change;
    exp_change(free_axes_.between * -t, apart_change, own.left_between);
    swing -= apart_change * free_axes_.inverse_between;
  }
  own.s = own.left * swing;
  own.c_change = own.left * swing_change + change + free_axes_.fall * own.s;
  own.cosine = 1.0 + swing_change;
}

VIBRATORY_ALIGNMENT_INLINE void FreeMotion::move(double t, const Own& own, Motion& motion) const {
  motion.q = start_q_ + c_factor_ * own.c_change + s_factor_ * own.s;
  motion.v =
      start_v_ - c_factor_ * free_axes_.pull * own.s + s_factor_ * (own.c_change - 2.0 * free_axes_.decay * own.s);
  motion.q += t * (p1_ + t * (p2_ + t * p3_));
  motion.v += t * (2.0 * p2_ + t * 3.0 * p3_);
  motion.driven_acceleration = 2.0 * p2_ + 6.0 * p3_ * t;
  for (const Sines& sines : sines_) {
    Quad half_sin, half_cos;
    sin_cos_of_any(sines.half_frequency * t, 0.5 * driven_rate_ * t, half_sin, half_cos);
    const Quad sin = 2.0 * half_sin * half_cos, cos_change = -2.0 * half_sin * half_sin;
    motion.q += sines.sin_amplitude * sin + sines.cos_amplitude * cos_change;
    motion.v += sines.frequency * (sines.sin_amplitude * cos_change - sines.cos_amplitude * sin);
    motion.driven_acceleration -=
        sines.frequency * sines.frequency * (sines.sin_amplitude * sin + sines.cos_amplitude * (1.0 + cos_change));
  }
}

/// All in closed form. Forces of a stiff or light axis are large and cancel: their rounding, over the time in which it
/// moves once its fast motion has decayed, would be more than the bounds know of.
VIBRATORY_ALIGNMENT_INLINE void FreeMotion::look(double end, const Own& own, const Motion& motion,
                                                 Outlook& outlook) const {
  // S' = exp(-a t) cos(r t) - a S and the like, and C itself: what is left of the motion keeps its digits
  const Quad slope = own.left * own.cosine - free_axes_.slope_rate * own.s;
  const Quad first = s_factor_ * slope - c_factor_ * free_axes_.pull * own.s;
  const Quad q = c_factor_ * (slope + 2.0 * free_axes_.decay * own.s) + s_factor_ * own.s;
  const Quad second = -free_axes_.pull * q - 2.0 * free_axes_.decay * first;
  outlook.acceleration = second;
  outlook.rate = least_rate_;
  outlook.second = least_second_;
  outlook.third = least_third_;
  add_size(p2_, Quad{} + 2.0 * end, outlook.rate);
  add_size(p3_, Quad{} + 3.0 * end * end, outlook.rate);
  add_size(p3_, Quad{} + 6.0 * end, outlook.second);
  const Quad mode = mode_ * own.left;
  add_bounds(mode, free_axes_.mode_rate, outlook);
  if (free_axes_.any_overdamped) {
    // two exponentials, each of which falls: what bounds it at one time bounds it ever after
    const Quad fast_mode = fast_mode_ * own.left * own.left_between;
    add_bounds(fast_mode, free_axes_.fast_mode_rate, outlook);
    const Quad acceleration = mode * free_axes_.mode_rate * free_axes_.mode_rate +
                              fast_mode * free_axes_.fast_mode_rate * free_axes_.fast_mode_rate;
    outlook.acceleration = free_axes_.modes ? acceleration : second;
  }
  outlook.acceleration += motion.driven_acceleration;
  if (free_axes_.any_near) {
    // derivative n after a time s: exp(-a s) (q_n cosh(r s) + (q_n+1 + a q_n) sinh(r s)/r), the last below 1/2a
    const Quad third = -free_axes_.pull * first - 2.0 * free_axes_.decay * second,
               fourth = -free_axes_.pull * second - 2.0 * free_axes_.decay * third;
    add_size(first, free_axes_.near, outlook.rate);
    add_size(second + free_axes_.decay * first, free_axes_.near_most, outlook.rate);
    add_size(second, free_axes_.near, outlook.second);
    add_size(third + free_axes_.decay * second, free_axes_.near_most, outlook.second);
    add_size(third, free_axes_.near, outlook.third);
    add_size(fourth + free_axes_.decay * third, free_axes_.near_most, outlook.third);
  }
}

VIBRATORY_ALIGNMENT_INLINE void FreeMotion::put(const Motion& motion, State& state) const {
  if (axis_exact_[FreeAxes::kX]) {
    state.x = motion.q[FreeAxes::kX];
    state.vx = motion.v[FreeAxes::kX];
  }
  if (axis_exact_[FreeAxes::kY]) {
    state.y = motion.q[FreeAxes::kY];
    state.vy = motion.v[FreeAxes::kY];
  }
  if (axis_exact_[FreeAxes::kPhi]) {
    state.phi = motion.q[FreeAxes::kPhi];
    state.omega = motion.v[FreeAxes::kPhi];
  }
}

/// One function for both, as the compiler may round either product of a b + c d: it makes the same choice once.
void FreeMotion::evaluate(double t, double end, State& state, Outlook* outlook) const {
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    Own own;
    Motion motion;
    own_at(t, own);
    move(t, own, motion);
    put(motion, state);
    if (outlook != nullptr) look(end, own, motion, *outlook);
  });
}

}  // namespace vibratory_alignment
