// Part of EventSolver: how a step in contact is taken, by power series, by an implicit step, or by whichever goes
// further for its cost (docs/hybrid_step.md "Contact", docs/implicit_steps.md, docs/automatic.md).
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/event_solver.h"
#include "solver/fast_motion.h"
#include "solver/held_state.h"
#include "solver/series_noise.h"
#include "solver/step_size.h"

namespace vibratory_alignment {
namespace {

/// Order of the series of motions so fast that their high powers overflow.
constexpr int kLowOrder = 8;

/// From so many on the polynomials of an implicit step contradict what the series have decided: these go on.
constexpr int kContradiction = 4;

/// An implicit step that was taken again to end at an event may have it this much later, as a share of the step; it is
/// taken again until it has it within the second of these, so often at most.
constexpr double kMostDelay = 1e-3, kMostShift = 1e-6;
constexpr int kMostRetakes = 8;

/// A correction that is not this much smaller than the one before is not worth one more.
constexpr double kSlowShift = 0.5;

/// Steps this short, relative to the time, change the state by hardly more than its last digits.
constexpr double kMinute = 1e-12;

/// Lengths that are tried, each half of the one before, where a shorter step does not converge.
constexpr int kMostShorter = 6;

/// Events that are not there in a step that ends at them, which is so much shorter than the one that found them, were
/// its error.
constexpr double kMuchShorter = 1e-3;

/// Friction beyond its limit, relative to it: where it is decided anew, and where that has found no answer.
constexpr double kExcessFriction = 1e-8, kTooMuchFriction = 1e-3;

/// Factor on rounding beyond which sticking contacts have to move apart, and on what friction has left of their V'.
constexpr double kPartAllowance = 10.0, kLeftAgain = 2.0;

/// Where powers of a normal force beyond the first change it by this share within a radian of the fastest motion, more
/// may ring than the last terms show.
constexpr double kQuiet = 0.02;

/// Length that is worth an implicit step, in steps of the series.
constexpr double kWorthwhile = 4.0;

}  // namespace

double EventSolver::last_terms(const Segment& s) {
  double sum = s.vx[s.order] + s.vy[s.order] + s.omega[s.order];
  for (int i = 0; i < s.loaded_count; ++i)
    sum += s.loaded[i].normal_force[s.order] + s.loaded[i].tangential_force[s.order];
  return std::abs(sum);
}

/// True when the sticking contacts hold the same motion now but would have to move apart.
bool EventSolver::must_part() const {
  const double left = series_.not_held_within(segment_.duration);
  if (!(left > 0.0)) return false;
  const SeriesNoise noise = series_noise(system_, segment_, segment_.duration, kPartAllowance);
  return left > std::max(noise.held_slip_rate, kLeftAgain * mode_.unheld_slip_rate);
}

/// Expands the motion in contact for a step of at most `longest`; the length that its truncation error allows.
double EventSolver::expand_contact(double longest, const DriveForms& drives) {
  reach_.begin(longest);
  series_.expand_contact(state_, drives, contact_order_, segment_, &reach_);
  if (last_terms(segment_) < kNearOverflow) {
    choice_.note_powers(segment_.order - contact_order_);
    return reach_.last_time();
  }
  // rates so high that their powers overflow
  series_.expand_contact(state_, drives, kLowOrder, segment_);
  choice_.note_powers(0);
  return reach_.time(segment_);
}

/// The same, once friction holds what is said to stick.
double EventSolver::series_contact_step(double longest, const DriveForms& drives) {
  series_step_ = expand_contact(longest, drives);
  if (excess_friction(system_, segment_, series_step_) <= kExcessFriction) return series_step_;
  segment_.duration = 0.0;
  segment_.end = state_;
  for (std::size_t i = 0; i < kSiteCount; ++i)
    if (mode_.contacts[i].slip == Slip::stick) mode_.pins[i].hold_plus = mode_.pins[i].hold_minus = 0;
  decide_friction_anew(system_, segment_, drives, {}, friction_, mode_);
  for (std::size_t i = 0; i < kSiteCount; ++i) segment_.contacts[i].slip = mode_.contacts[i].slip;
  segment_.begin = state_ = hold_sticking(system_, state_, mode_.contacts);
  series_step_ = expand_contact(longest, drives);
  if (excess_friction(system_, segment_, series_step_) > kTooMuchFriction)
    throw SolverFailure("no contact state is consistent");
  return series_step_;
}

/// Longest part of a step over which the series of cos phi and sin phi hold, and those of points that turn with them.
/// The last terms of a power series show what is cut off. Where phi is the polynomial of an implicit step they are
/// exact, and what is cut off of cos phi and sin phi is smaller than they are by the sum of the terms of phi beyond the
/// first.
double EventSolver::direction_step(double step, double point_tolerance) {
  const PairSeries& direction = series_.direction(segment_);
  const int order = segment_.order;
  if (!implicit_now_) return pair_step(direction, order, point_tolerance);
  double turn = 0.0;
  for (int k = order; k > 0; --k) turn = (turn + std::abs(segment_.phi[k])) * step;
  step = std::min(step, pair_step(direction, order, turn > point_tolerance ? point_tolerance / turn : 1.0));
  const double size = system_.half_width + system_.base_distance;
  return turned_place_step(segment_, direction, step, point_tolerance * size);
}

/// One step in contact of at most `longest`, by the method that is due.
double EventSolver::contact_step(double longest, const DriveForms& drives) {
  // to a kink or limit that is here already, when rounding left nothing on the way, the series go
  if (method_ == ContactMethod::series || longest == 0.0) return series_contact_step(longest, drives);
  if (contradicted()) {
    believe_state();
    if (method_ == ContactMethod::automatic) {
      choice_.distrust();
      choice_.earn();
    }
    return series_contact_step(longest, drives);
  }
  if (method_ == ContactMethod::automatic) return chosen_contact_step(longest, drives);
  if (method_ == ContactMethod::implicit_alone) return lone_implicit_step(longest, drives);
  return implicit_or_ring_step(longest, drives);
}

/// Implicit alone: an implicit step, if need be one that follows the base; by the series where no length does.
double EventSolver::lone_implicit_step(double longest, const DriveForms& drives) {
  double step = implicit_contact_step({longest}, drives);
  if (step == 0.0) {
    implicit_->follow_base();
    step = implicit_contact_step({longest}, drives);
  }
  return step > 0.0 ? step : series_contact_step(longest, drives);
}

/// Implicit: one by the series while the base rings, else an implicit one.
double EventSolver::implicit_or_ring_step(double longest, const DriveForms& drives) {
  if (!ring_watch_.series_follow()) {
    const double step = implicit_contact_step(ring_watch_.bounds(longest), drives);
    if (step > 0.0) {
      ring_watch_.settle_implicit(step < longest && implicit_->follows_base(step, drives));
      return step;
    }
    if (implicit_->event_rings())
      ring_watch_.ring();
    else
      ring_watch_.give_up_implicit();
  }
  const double step = series_contact_step(longest, drives);
  if (!ring_watch_.asks(step)) return step;
  const double length = length_over_ring(0.0, longest, drives);
  if (length > 0.0) {
    ring_watch_.pass_over();
    implicit_->suggest(length);
  }
  return step;
}

/// Length of an implicit step that passes over what the last step, one of the series, shows to ring; 0 when there is
/// none. One of `least` is worth it, however short the last implicit step had to be.
double EventSolver::length_over_ring(double least, double longest, const DriveForms& drives) {
  const FastMotion motion = fast_motion(system_, segment_);
  const double radian = motion.rate > 0.0 ? 1.0 / motion.rate : 0.0;
  if (normal_force_change(segment_, radian, 2) >= kQuiet) return 0.0;
  return implicit_->length_over(motion, std::max(least, kWorthwhile * series_step_), longest, drives, segment_);
}

/// The normal forces jump: the base rings.
void EventSolver::ring() {
  ring_watch_.ring();
  choice_.ring();
}

/// How far the series of the last step would hold with the usual number of powers.
double EventSolver::usual_reach() {
  const int order = segment_.order;
  segment_.order = std::min(order, contact_order_);
  const double reach = reach_.time(segment_);
  segment_.order = order;
  return reach;
}

/// True when the series of a contact step have an event within `step`: those found stay, for a step that ends there.
bool EventSolver::has_event(double step, const DriveForms& drives) {
  segment_.duration = searched_ = step;
  segment_.coarse = false;
  find_events(system_, series_, segment_, mode_.pins, mode_.recoveries, outcomes_, drives, tolerance_, found_);
  return found_.count > 0;
}

/// Automatic: one by the method that is chosen.
double EventSolver::chosen_contact_step(double longest, const DriveForms& drives) {
  choice_.look_at(segment_.contacts);
  const double longest_implicit = ImplicitStep::longest_step(longest, drives);
  if (choice_.may_pass_over()) {
    const double step = series_contact_step(longest, drives), usual_step = usual_reach();
    const double change = normal_force_change(segment_, std::min(usual_step, longest));
    if (!choice_.passing_over_pays(usual_step, longest_implicit, change) ||
        has_event(std::min(step, longest), drives)) {
      choice_.earn();
      return step;
    }
    choice_.start_passing_over(step, longest_implicit, change);
  } else if (choice_.shortest_start() < longest_implicit) {
    const double resumed = choice_.shortest_resumed();
    const double length = length_over_ring(resumed < longest_implicit ? resumed : 0.0, longest, drives);
    if (choice_.starts(length, longest)) implicit_->suggest(std::min(length, choice_.trial_length()));
  } else if (choice_.asks_series()) {
    choice_.learn_pace(expand_contact(0.0, drives));
    counts_.rhs_evaluations += segment_.order;
  }
  if (choice_.implicit()) {
    cost_before_ = implicit_->cost();
    const double step = implicit_contact_step(choice_.bounds(longest), drives);
    follows_base_ = step < longest && implicit_->follows_base(step, drives);
    if (step > 0.0) return step;
    if (implicit_->event_rings())
      choice_.leave_to_ring(spent());
    else
      choice_.give_up_implicit(spent(), implicit_->given_up_at());
  }
  choice_.earn();
  return series_contact_step(longest, drives);
}

/// An implicit step; 0 when there is none within the bounds.
double EventSolver::implicit_contact_step(const StepBounds& bounds, const DriveForms& drives) {
  const double step = implicit_->take(state_, drives, bounds, segment_, counts_);
  if (step == 0.0 || excess_friction(system_, segment_, 0.0) > kExcessFriction) {
    implicit_->forget();
    return 0.0;
  }
  implicit_now_ = true;
  searched_ = 0.0;
  implicit_length_ = step;
  series_.adopt(segment_);
  return step;
}

/// The series go instead of the implicit step that was taken.
void EventSolver::leave_implicit_step() {
  implicit_->forget();
  implicit_now_ = false;
  found_.clear();
  if (method_ == ContactMethod::automatic) {
    choice_.give_up_implicit(spent(), 0.0);
    choice_.earn();
  } else {
    doubt_implicit_steps();
  }
}

/// The next steps are those of the series, or short.
void EventSolver::doubt_implicit_steps() {
  if (method_ == ContactMethod::automatic)
    choice_.doubt();
  else if (method_ == ContactMethod::implicit)
    ring_watch_.give_up_implicit();
  else if (method_ == ContactMethod::implicit_alone)
    implicit_->follow_base();
}

/// Takes the implicit step again with the length `step`, or where that does not converge with half of it, and so on.
/// Returns its length; 0 when none converges: the polynomials of the longer one stay, whose state there only they know.
double EventSolver::shorten_implicit_step(double step) {
  for (int i = 0; i < kMostShorter; ++i, step *= 0.5) {
    if (!implicit_->retake(step, segment_, counts_)) continue;
    series_.adopt(segment_);
    return implicit_length_ = step;
  }
  implicit_length_ = std::numeric_limits<double>::infinity();
  return 0.0;
}

/// Takes the implicit step again to the events found in it, until they are where the shorter step, which is the more
/// exact one, has them. None are left where that has none, unless it is so short that rounding holds the state, or
/// where only a step that ends before them converges. Where a much shorter step has none, the error of the long one
/// made them, and would again from there.
void EventSolver::retake_to_events(const DriveForms& drives, FoundEvents& found) {
  double shift_before = std::numeric_limits<double>::infinity();
  const double whole = implicit_length_;
  for (int i = 0; i < kMostRetakes && found.time > kHardly * now_.high; ++i) {
    const double length = shorten_implicit_step(found.time);
    if (length == 0.0) return;
    const FoundEvents before = found;
    found.clear();
    segment_.duration = (1.0 + kMostDelay) * length;
    find_events(system_, series_, segment_, mode_.pins, mode_.recoveries, outcomes_, drives, tolerance_, found);
    if (found.count == 0 && length <= kMinute * now_.high) found = before;
    if (found.time > 0.0 && !system_.recovery) found.time = first_crossing(found);
    if (found.count == 0) {
      if (length < kMuchShorter * whole) doubt_implicit_steps();
      return;
    }
    const double shift = std::abs(found.time - length);
    if (shift > kMostShift * length) {
      if (shift > kSlowShift * shift_before) return;  // rounding is all that moves it
      shift_before = shift;
      continue;
    }
    // what coincided before does so to within the error of the step
    if (found.count < before.count) {
      const double time = found.time;
      found = before;
      found.time = time;
    }
    return;
  }
}

/// True when events have followed each other at the present time, one undoing the other, and implicit steps led there.
bool EventSolver::contradicted() const { return by_implicit_step_ && events_without_progress_ >= kContradiction; }

/// The end of an implicit step that was cut short at V = 0 has another V, by the error of the step: what slides as that
/// says does so. Where V says the contrary of what friction has decided, and that goes on, V' is such an error as well.
void EventSolver::believe_state() {
  for (std::size_t i = 0; i < kSiteCount; ++i) {
    const ContactState& contact = mode_.contacts[i];
    if (contact.phase != Phase::loaded || (contact.slip != Slip::plus && contact.slip != Slip::minus)) continue;
    const double v = contact_kinematics(system_, state_, static_cast<Site>(i), contact.face).slip_velocity;
    const double along = contact.slip == Slip::plus ? v : -v;
    if (along > 0.0) mode_.pins[i].slip = 0;
    if (along < 0.0 && events_without_progress_ >= 2 * kContradiction)
      mode_.pins[i].slip = std::max(mode_.pins[i].slip, 2);
  }
}

/// Evaluations of the forces that the present implicit step has taken, also in attempts that were given up.
long EventSolver::spent() const { return implicit_->cost() - cost_before_; }

/// Automatic: settles a step of the length `gone` once its end is known; an event cuts it short, and the way to there
/// is gone again.
void EventSolver::settle(double gone, double longest) {
  if (implicit_now_)
    choice_.settle_implicit(gone, longest, spent(), follows_base_);
  else
    choice_.settle_series(gone, longest, found_.count > 0);
}

}  // namespace vibratory_alignment
