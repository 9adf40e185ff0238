#include "solver/event_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/tilt.h"
#include "solver/base_recovery.h"
#include "solver/flight_search.h"
#include "solver/held_state.h"
#include "solver/series_noise.h"
#include "solver/step_size.h"

namespace vibratory_alignment {
namespace {

/// Flight without exact closed form: order of the series and their truncation error relative to the motion.
constexpr int kFlightOrder = 18;
constexpr double kFlightTolerance = 1e-15;

/// Flight in closed form: truncation error of the series in which events are sought, as a share of that of a contact
/// step, and their order for so many digits: a step spans about 2.5 rad.
constexpr double kSearchShare = 1e-2;
constexpr int kSearchOrder = 9;

/// Coefficients this large leave no room for what is computed from them.
constexpr double kNearOverflow = 1e250;

/// Order of the series of motions so fast that their high powers overflow.
constexpr int kLowOrder = 8;

/// Shortest flight that is worth a segment of its own without an event at its end, in radians of what a series would
/// have to follow.
constexpr double kShortestFlight = 1.0;

/// Largest correction of the time of a crossing, as a share of the step in which it was found.
constexpr double kMostCrossingCorrection = 0.1;

/// Longest segment in flight, in radians of its fastest motion.
constexpr double kLongestFlightSegment = 20.0;

/// Longest flight in one closed form, in radians of its fastest motion.
constexpr double kLongestFlight = 6000.0;

/// Truncation error below which rounding is all that is left.
constexpr double kSmallestTolerance = 1e-16;

/// Truncation error of a contact step as a share of the tolerance asked for: what a step leaves behind is amplified by
/// the impacts after it and adds up in the energy.
constexpr double kStepShare = 1e-3;

/// Truncation error of friction forces in the tanh layer, as a share of the tolerance asked for: what of it moves the
/// part is below that of a step.
constexpr double kForceShare = 0.1;

/// Events in a row that advance time by nothing: more than this is no motion but a contradiction.
constexpr int kMaxEventsWithoutProgress = 100;

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

/// Implicit steps to events no later than this, relative to the time, are no progress.
constexpr double kHardly = 1e-15;

/// Error of an implicit step as a share of the tolerance asked for.
constexpr double kImplicitShare = 1e-2;

/// Halvings of a step within which sticking contacts have to move apart.
constexpr int kMostHalvings = 50;

/// Friction beyond its limit, relative to it: where it is decided anew, and where that has found no answer.
constexpr double kExcessFriction = 1e-8, kTooMuchFriction = 1e-3;

/// Factor on rounding beyond which sticking contacts have to move apart, and on what friction has left of their V'.
constexpr double kPartAllowance = 10.0, kLeftAgain = 2.0;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void set_forms(const std::vector<Drive>& drives, const Instant& t, DriveForms& forms) {
  forms.count = 0;
  for (const Drive& drive : drives) {
    forms.direction[static_cast<std::size_t>(forms.count)] = drive.direction();
    forms.form[static_cast<std::size_t>(forms.count++)] = drive.form_at(t);
  }
}

double time_to_kink(const std::vector<Drive>& drives, const Instant& t) {
  double least = kInfinity;
  for (const Drive& drive : drives) least = std::min(least, drive.time_to_kink(t));
  return least;
}

/// Events at which a point crosses a face.
bool is_crossing(EventKind kind) {
  return kind == EventKind::touch || kind == EventKind::close || kind == EventKind::enter || kind == EventKind::leave ||
         kind == EventKind::run_off;
}

/// Events at which normal forces jump, or start anew: the base rings.
bool rings_base(EventKind kind) {
  return kind == EventKind::touch || kind == EventKind::reload || kind == EventKind::run_off ||
         kind == EventKind::drive_kink;
}

bool any_loaded(const ContactStates& contacts) {
  return std::any_of(contacts.begin(), contacts.end(), [](const ContactState& c) { return c.phase == Phase::loaded; });
}

/// Bound of the change of a normal force over the time t, as a share of that force: the largest of the contacts.
double normal_force_change(const Segment& segment, double t) {
  double most = 0.0;
  for (int i = 0; i < segment.loaded_count; ++i) {
    const Series& force = segment.loaded[i].normal_force;
    double change = 0.0;
    for (int k = segment.order; k > 0; --k) change = (change + std::abs(force[k])) * t;
    most = std::max(most, change / force[0]);
  }
  return most;
}

Site first_sticking(const ContactStates& contacts) {
  std::size_t i = 0;
  while (contacts[i].slip != Slip::stick) ++i;
  return static_cast<Site>(i);
}

/// tanh z is 1 but for 2 exp(-2 z).
System saturated(System system, double tolerance) {
  system.tanh_saturation = std::min(system.tanh_saturation, 0.5 * std::log(2.0 / tolerance));
  return system;
}

/// Not finite where any coefficient is not: the last ones are made of all others.
double last_terms(const Segment& s) {
  double sum = s.vx[s.order] + s.vy[s.order] + s.omega[s.order];
  for (int i = 0; i < s.loaded_count; ++i)
    sum += s.loaded[i].normal_force[s.order] + s.loaded[i].tangential_force[s.order];
  return std::abs(sum);
}

/// What is left of the deformations of a base at the segment's end.
void recover(const System& system, const Segment& segment, Recoveries& recoveries) {
  const Tilt tilt = tilt_of(segment.end.phi);
  for (Recovery& recovery : recoveries) {
    if (recovery.deformation == 0.0) continue;
    recovery.deformation = Relaxation(system, segment, recovery).deformation_at(segment.duration);
    const bool at_once = recovers_at_once(system, recovery.face, tilt.cos, tilt.sin);
    if (at_once || recovery.deformation < kNoDeformation) recovery = {};
  }
}

/// True when a leap in flight knows what is left of all deformations at its end.
bool all_recover_evenly(const System& system, const Recoveries& recoveries) {
  return std::all_of(recoveries.begin(), recoveries.end(), [&](const Recovery& recovery) {
    return recovery.deformation == 0.0 || recovers_evenly(system, recovery.face);
  });
}

bool is_finite(const Segment& s) { return std::isfinite(last_terms(s)); }

bool is_finite(const State& s) { return std::isfinite(s.x + s.y + s.phi + s.vx + s.vy + s.omega); }

}  // namespace

EventSolver::EventSolver(const System& system, const std::vector<Excitation>& excitations, double tolerance,
                         long step_limit, ContactMethod method)
    : system_(saturated(system, std::max(kStepShare * tolerance, kSmallestTolerance))),
      tolerance_(std::max(kStepShare * tolerance, kSmallestTolerance)),
      contact_order_(series_order(tolerance_)),
      search_tolerance_(std::max(kSearchShare * tolerance_, kFlightTolerance)),
      search_order_(std::min(kSearchOrder + static_cast<int>(-std::log10(search_tolerance_)), kMaxOrder)),
      step_limit_(step_limit),
      method_(method),
      series_(system_),
      reach_(system_, tolerance_, std::max(kForceShare * tolerance, kSmallestTolerance)),
      friction_(system_, tolerance_),
      implicit_(system_, std::max(kImplicitShare * tolerance, kSmallestTolerance)),
      flight_(excitations.size()) {
  if (method_ != ContactMethod::series) collocation();  // made now, not in the first step
  if (excitations.size() > DriveForms::kMax)
    throw std::invalid_argument("at most " + std::to_string(DriveForms::kMax) + " excitations are simulated");
  for (const Excitation& excitation : excitations) drives_.emplace_back(excitation, now_);
  next_drives_ = drives_;
  state_ = system_.start;
  outcomes_.aligned = true;
  outcomes_.inserted = system_.has_inserted_depth;
}

/// State in flight at `duration` after the segment's start: closed form from the start of the flight, or the series
/// where that is more exact.
State EventSolver::flight_state(double duration) const {
  State state;
  if (!flight_.exact()) state = state_at(segment_, duration);
  flight_.at(segment_.flight_time + duration, state);
  return state;
}

/// The time of a crossing, found in the series of the points to their truncation error, in the closed form of a flight
/// or the polynomials of an implicit step: one step of Newton's method leaves the square of that error.
double EventSolver::crossing_time(double found, const Event& event) const {
  const auto point_at = [&](double time) {
    const State state = implicit_now_ ? state_at(segment_, time) : flight_state(time);
    return contact_kinematics(system_, state, event.site, event.face);
  };
  const ContactKinematics k = point_at(found);
  const double correction = -k.depth / k.depth_rate;
  // a graze has no rate to divide by, or one of rounding, which leads away
  if (!(std::abs(correction) <= kMostCrossingCorrection * segment_.duration)) return found;
  const double corrected = std::clamp(found + correction, 0.0, segment_.duration);
  return std::abs(point_at(corrected).depth) <= std::abs(k.depth) ? corrected : found;
}

/// True when the sticking contacts hold the same motion now but would have to move apart.
bool EventSolver::must_part() const {
  const double left = series_.not_held_within(segment_.duration);
  if (!(left > 0.0)) return false;
  const SeriesNoise noise = series_noise(system_, segment_, segment_.duration, kPartAllowance);
  return left > std::max(noise.held_slip_rate, kLeftAgain * mode_.unheld_slip_rate);
}

/// The least of the corrected times of the crossings among coinciding events: the mirror image names them in another
/// order.
double EventSolver::first_crossing(const FoundEvents& found) const {
  double first = kInfinity;
  for (int i = 0; i < found.count; ++i) {
    const Event& event = found.events[static_cast<std::size_t>(i)];
    if (is_crossing(event.kind)) first = std::min(first, crossing_time(found.time, event));
  }
  return first < kInfinity ? first : found.time;
}

void EventSolver::go_to_end() {
  const Instant end = segment_.start + segment_.duration;
  // events may coincide, but not for ever
  const bool hardly = implicit_now_ && segment_.duration <= kHardly * end.high;
  const bool progress = (end.high != now_.high || end.low != now_.low) && !hardly;
  events_without_progress_ = progress ? 0 : events_without_progress_ + 1;
  if (progress) implicit_.leave_start();
  by_implicit_step_ = implicit_now_ || (by_implicit_step_ && !progress);
  now_ = end;
  if (events_without_progress_ > kMaxEventsWithoutProgress) throw SolverFailure("no contact state is consistent");
  state_ = segment_.end;
  if (mode_changes_) {
    mode_ = next_mode_;
  } else if (segment_.duration > 0.0) {
    mode_.pins.fill(SitePins{});
  }
  if (drives_change_) drives_ = next_drives_;
  drives_change_ = false;
  counts_.events += segment_.event_count;
  bool rings = false;
  for (int i = 0; i < segment_.event_count; ++i) {
    const EventKind kind = segment_.events[static_cast<std::size_t>(i)].kind;
    if (kind == EventKind::drive_kink) in_flight_ = false;
    if (kind == EventKind::aligned) outcomes_.aligned = false;
    if (kind == EventKind::inserted) outcomes_.inserted = false;
    rings = rings || rings_base(kind);
  }
  if (segment_.event_count > 0) implicit_.restart(rings);
  if (rings) choice_.ring();
}

/// Flies in one segment in closed form, without series, to the next event if that is certain, or as far as nothing can
/// happen. False when that is too short to be worth it.
bool EventSolver::leap(double longest, FoundEvents& found) {
  if (!flight_.exact() || (system_.recovery && !all_recover_evenly(system_, mode_.recoveries))) return false;
  const double rate = flight_.rate(segment_.flight_time), series_rate = flight_.series_rate();
  const FlightOutlook outlook =
      look_ahead(system_, flight_, segment_.flight_time, state_, mode_.contacts, mode_.pins, mode_.recoveries,
                 outcomes_, std::min(longest, kLongestFlightSegment / rate));
  if (!outlook.lands && outlook.time < longest && outlook.time * series_rate < kShortestFlight) return false;
  segment_.flight = &flight_;
  segment_.order = 0;
  segment_.loaded_count = 0;
  segment_.duration = outlook.time;
  segment_.end = outlook.end;
  if (outlook.lands) {
    found.time = outlook.time;
    found.count = 1;
    found.events[0] = outlook.event;
  }
  ++counts_.rhs_evaluations;
  return true;
}

/// Expands the motion in contact for a step of at most `longest`; the length that its truncation error allows.
double EventSolver::expand_contact(double longest, const DriveForms& drives) {
  reach_.begin(longest);
  series_.expand_contact(state_, drives, contact_order_, segment_, &reach_);
  if (last_terms(segment_) < kNearOverflow) return reach_.last_time();
  // rates so high that their powers overflow
  series_.expand_contact(state_, drives, kLowOrder, segment_);
  return reach_.time(segment_);
}

/// The same, once friction holds what is said to stick.
double EventSolver::series_contact_step(double longest, const DriveForms& drives) {
  const double step = expand_contact(longest, drives);
  if (excess_friction(system_, segment_, step) <= kExcessFriction) return step;
  segment_.duration = 0.0;
  segment_.end = state_;
  for (std::size_t i = 0; i < kSiteCount; ++i)
    if (mode_.contacts[i].slip == Slip::stick) mode_.pins[i].hold_plus = mode_.pins[i].hold_minus = 0;
  decide_friction_anew(system_, segment_, drives, friction_, mode_);
  for (std::size_t i = 0; i < kSiteCount; ++i) segment_.contacts[i].slip = mode_.contacts[i].slip;
  segment_.begin = state_ = hold_sticking(system_, state_, mode_.contacts);
  const double new_step = expand_contact(longest, drives);
  if (excess_friction(system_, segment_, new_step) > kTooMuchFriction) throw SolverFailure("no contact state is consistent");
  return new_step;
}

/// Longest part of a step over which the series of cos phi and sin phi hold. The last terms of a power series show what
/// is cut off; where phi is the polynomial of an implicit step they are exact, and what is cut off is smaller than they
/// are by the angle through which the part turns.
double EventSolver::direction_step(double step, double point_tolerance) {
  const double turn = implicit_now_ ? std::abs(value_at(segment_.phi, segment_.order, step) - segment_.phi[0]) : 1.0;
  const double tolerance = turn > point_tolerance ? point_tolerance / turn : 1.0;
  return pair_step(series_.direction(segment_), segment_.order, tolerance);
}

/// One step in contact of at most `longest`, by the method that is due.
double EventSolver::contact_step(double longest, const DriveForms& drives) {
  // to a kink or limit that is here already, when rounding left nothing on the way, the series go
  if (method_ == ContactMethod::series || longest == 0.0) return series_contact_step(longest, drives);
  if (contradicted()) {
    believe_state();
    return series_contact_step(longest, drives);
  }
  if (method_ == ContactMethod::automatic) return chosen_contact_step(longest, drives);
  const double step = implicit_contact_step({longest}, drives);
  return step > 0.0 ? step : series_contact_step(longest, drives);
}

/// True when the series of a contact step have an event within `step`.
bool EventSolver::has_event(double step, const DriveForms& drives) {
  FoundEvents found;
  segment_.duration = step;
  find_events(system_, series_, segment_, mode_.pins, mode_.recoveries, outcomes_, drives, found);
  return found.count > 0;
}

/// Automatic: one by the method that is chosen.
double EventSolver::chosen_contact_step(double longest, const DriveForms& drives) {
  choice_.look_at(segment_.contacts);
  if (choice_.may_pass_over()) {
    const double step = series_contact_step(longest, drives);
    const double change = normal_force_change(segment_, std::min(step, longest));
    if (!choice_.passing_over_pays(step, longest, change) || has_event(std::min(step, longest), drives)) {
      choice_.earn();
      return step;
    }
    choice_.start_passing_over(step);
  } else if (choice_.starts_trial(longest)) {
    implicit_.suggest(choice_.trial_length());
  } else if (choice_.asks_series()) {
    choice_.learn_pace(expand_contact(0.0, drives));
    counts_.rhs_evaluations += segment_.order;
  }
  if (choice_.implicit()) {
    effort_before_ = effort();
    const double step = implicit_contact_step(choice_.bounds(longest), drives);
    if (step > 0.0) return step;
    choice_.give_up_implicit(spent());
  }
  choice_.earn();
  return series_contact_step(longest, drives);
}

/// An implicit step; 0 when there is none within the bounds.
double EventSolver::implicit_contact_step(const StepBounds& bounds, const DriveForms& drives) {
  const double step = implicit_.take(state_, drives, bounds, segment_, counts_);
  if (step == 0.0 || excess_friction(system_, segment_, 0.0) > kExcessFriction) return 0.0;
  implicit_now_ = true;
  implicit_length_ = step;
  series_.adopt(segment_);
  return step;
}

/// Takes the implicit step again with the length `step`, or where that does not converge with half of it, and so on.
/// Returns its length; 0 when none converges: the polynomials of the longer one stay, whose state there only they know.
double EventSolver::shorten_implicit_step(double step) {
  for (int i = 0; i < kMostShorter; ++i, step *= 0.5) {
    if (!implicit_.retake(step, segment_, counts_)) continue;
    series_.adopt(segment_);
    return implicit_length_ = step;
  }
  implicit_length_ = kInfinity;
  return 0.0;
}

/// Takes the implicit step again to the events found in it, until they are where the shorter step, which is the more
/// exact one, has them. None are left where that has none, unless it is so short that rounding holds the state, or
/// where only a step that ends before them converges.
void EventSolver::retake_to_events(const DriveForms& drives, FoundEvents& found) {
  double shift_before = kInfinity;
  for (int i = 0; i < kMostRetakes && found.time > kHardly * now_.high; ++i) {
    const double length = shorten_implicit_step(found.time);
    if (length == 0.0) return;
    const FoundEvents before = found;
    found.clear();
    segment_.duration = (1.0 + kMostDelay) * length;
    find_events(system_, series_, segment_, mode_.pins, mode_.recoveries, outcomes_, drives, found);
    if (found.count == 0 && length <= kMinute * now_.high) found = before;
    if (found.time > 0.0 && !system_.recovery) found.time = first_crossing(found);
    if (found.count == 0) return;
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

/// Evaluations and factorizations until now.
StepEffort EventSolver::effort() const { return {counts_.rhs_evaluations, implicit_.factorizations()}; }

/// What the present implicit step has taken.
StepEffort EventSolver::spent() const {
  const StepEffort now = effort();
  return {now.evaluations - effort_before_.evaluations, now.factorizations - effort_before_.factorizations};
}

/// Automatic: settles a step of the length `gone` once its end is known; an event cuts it short, and the way to there
/// is gone again.
void EventSolver::settle(double gone, double longest) {
  if (choice_.implicit())
    choice_.settle_implicit(gone, longest, spent());
  else
    choice_.settle_series(gone, longest);
}

const Segment& EventSolver::advance(double limit) {
  if (started_) {
    go_to_end();
  } else {
    set_forms(drives_, now_, forms_);
    forms_known_ = true;
    mode_ = start_mode(system_, state_, forms_, friction_);
    started_ = true;
  }
  if (++counts_.steps > step_limit_) throw SolverFailure("step limit of " + std::to_string(step_limit_) + " reached");

  if (!forms_known_) set_forms(drives_, now_, forms_);
  forms_known_ = false;
  const DriveForms& drives = forms_;
  const double to_limit = std::max(0.0, limit - now_);
  const double to_kink = time_to_kink(drives_, now_);
  segment_.start = now_;
  segment_.contacts = mode_.contacts;
  if (system_.recovery) segment_.recoveries = mode_.recoveries;
  const bool contact = any_loaded(mode_.contacts);
  if (contact) state_ = hold_sticking(system_, state_, mode_.contacts);
  segment_.begin = state_;
  segment_.flight = nullptr;
  if (contact) {
    in_flight_ = false;
  } else {
    if (method_ == ContactMethod::automatic) choice_.leave_contact();
    // a flight without end begins anew now and then: its phases are exact at the start and rounded after it
    const double flown = in_flight_ ? now_ - flight_.start() : 0.0;
    const bool long_ago = in_flight_ && flown * flight_.rate(flown) > kLongestFlight;
    if (!in_flight_ || long_ago) flight_.begin(system_, state_, drives, now_);
    in_flight_ = true;
    segment_.flight_time = now_ - flight_.start();
  }

  implicit_now_ = false;
  FoundEvents& found = found_;
  found.clear();
  const double end = std::min(to_limit, to_kink);
  const bool leaps = !contact && leap(end, found);
  if (!leaps) {
    // power series, to the first of: end of the step, limit, kink of an excitation, event
    double step = 0.0, point_tolerance = tolerance_;
    // in flight events are only sought in the series, and their times corrected in the closed form
    const bool corrects = !contact && flight_.exact() && !system_.recovery;
    if (contact) {
      step = contact_step(end, drives);
    } else {
      point_tolerance = corrects ? search_tolerance_ : kFlightTolerance;
      series_.expand_free(state_, drives, corrects ? search_order_ : kFlightOrder, segment_);
      step = series_step(system_, segment_, point_tolerance);
    }
    if (!is_finite(segment_)) throw SolverFailure("the motion is no longer finite");
    // the series of the points turn with the part; those of the other edge and the corners follow from these
    segment_.coarse = implicit_now_;
    step = std::min({step, end, direction_step(step, point_tolerance)});
    if (implicit_now_ && step < implicit_length_) {
      const double shorter = shorten_implicit_step(step);
      if (shorter > 0.0) step = shorter;
    }
    if (!contact && system_.contacts.edges)
      for (const Site edge : {Site::a1, Site::a2})  // both: the mirror image steps alike
        step = std::min(step, pair_step(series_.point(edge, segment_), segment_.order, point_tolerance));
    if (!implicit_now_) counts_.rhs_evaluations += segment_.order;
    if (system_.recovery)
      for (const Recovery& recovery : mode_.recoveries)
        if (recovery.deformation > 0.0)
          step = std::min(step, recovery_step(system_, segment_, recovery, point_tolerance));
    segment_.duration = step;
    if (!(segment_.duration >= 0.0)) throw SolverFailure("the motion is no longer finite");
    // contacts that have been found to stick here, though they part within the step, hold for a part of it
    if (contact && holds_here_)
      for (int i = 0; i < kMostHalvings && must_part(); ++i) segment_.duration *= 0.5;
    holds_here_ = false;
    if (contact && must_part()) {
      // friction is decided anew
      holds_here_ = true;
      found.parts = true;
      found.time = 0.0;
      found.count = 1;
      found.events[0] = {EventKind::slip, first_sticking(mode_.contacts)};
    } else {
      find_events(system_, series_, segment_, mode_.pins, mode_.recoveries, outcomes_, drives, found);
    }
    if (found.count > 0) {
      if (corrects && found.time > 0.0) found.time = first_crossing(found);
      if (implicit_now_) retake_to_events(drives, found);
      segment_.duration = found.count > 0 ? found.time : implicit_length_;
    }
  }
  if (contact && method_ == ContactMethod::automatic && end > 0.0 && !contradicted()) settle(segment_.duration, end);
  const bool kink = segment_.duration == to_kink;
  if (found.count == 0 && !kink && segment_.duration < to_limit && now_.high + segment_.duration == now_.high)
    throw SolverFailure("the step has become too short");

  const bool whole_step = implicit_now_ && segment_.duration == implicit_length_;
  if (!whole_step) implicit_.forget();
  if (!leaps)
    segment_.end = whole_step ? implicit_.end()
                   : contact  ? state_at(segment_, segment_.duration)
                              : flight_state(segment_.duration);
  if (!is_finite(segment_.end)) throw SolverFailure("the motion is no longer finite");
  prepare_next(found, kink);
  return segment_;
}

void EventSolver::prepare_next(FoundEvents& found, bool kink) {
  const Instant end = segment_.start + segment_.duration;
  if (drives_change_) next_drives_ = drives_;
  drives_change_ = kink;
  if (kink)
    for (Drive& drive : next_drives_)
      if (drive.time_to_kink(segment_.start) <= segment_.duration) drive.pass_kink();

  segment_.event_count = 0;
  forms_known_ = found.count > 0 || kink;
  mode_changes_ = forms_known_ || system_.recovery;
  if (mode_changes_) next_mode_ = mode_;
  if (system_.recovery) recover(system_, segment_, next_mode_.recoveries);
  if (forms_known_) {
    set_forms(next_drives_, end, forms_);
    apply_events(system_, segment_, forms_, friction_, found, next_mode_);
  } else if (mode_changes_ && segment_.duration > 0.0) {
    next_mode_.pins.fill(SitePins{});
  }
  for (int i = 0; i < found.count; ++i)
    segment_.events[static_cast<std::size_t>(segment_.event_count++)] = found.events[static_cast<std::size_t>(i)];
  if (kink && segment_.event_count < kMaxEvents)
    segment_.events[static_cast<std::size_t>(segment_.event_count++)] = {EventKind::drive_kink};
}

void EventSolver::cut(double duration) {
  implicit_.forget();
  segment_.duration = duration;
  segment_.end = segment_.loaded_count > 0 ? state_at(segment_, duration) : flight_state(duration);
  FoundEvents none;
  prepare_next(none, false);
}

void EventSolver::set_excitations(const std::vector<Excitation>& excitations) {
  std::vector<Drive>& drives = started_ ? next_drives_ : drives_;
  const Instant when = started_ ? segment_.start + segment_.duration : now_;
  for (std::size_t i = 0; i < drives.size() && i < excitations.size(); ++i) drives[i].change(excitations[i], when);
  if (!started_) next_drives_ = drives_;
  drives_change_ = started_;
  forms_known_ = false;
  forces_jump();
}

void EventSolver::set_anchor_y(double anchor_y) {
  system_.y.anchor = anchor_y;
  forces_jump();
}

/// A jump of the forces may end sticking, and ends the closed form of a flight.
void EventSolver::forces_jump() {
  in_flight_ = false;
  if (!started_) return;
  implicit_.restart(true);
  choice_.ring();
  const Instant end = segment_.start + segment_.duration;
  if (!mode_changes_) {
    next_mode_ = mode_;
    if (segment_.duration > 0.0) next_mode_.pins.fill(SitePins{});
    mode_changes_ = true;
  }
  DriveForms forms;
  set_forms(next_drives_, end, forms);
  decide_friction_anew(system_, segment_, forms, friction_, next_mode_);
}

State state_at(const Segment& segment, double t) {
  if (segment.flight != nullptr) {
    State state;
    segment.flight->at(segment.flight_time + t, state);
    return state;
  }
  // Horner's rule on all six at once: none waits for another
  int k = segment.order;
  State q{segment.x[k], segment.y[k], segment.phi[k], segment.vx[k], segment.vy[k], segment.omega[k]};
  while (--k >= 0)
    q = {q.x * t + segment.x[k],   q.y * t + segment.y[k],   q.phi * t + segment.phi[k],
         q.vx * t + segment.vx[k], q.vy * t + segment.vy[k], q.omega * t + segment.omega[k]};
  return q;
}

}  // namespace vibratory_alignment
