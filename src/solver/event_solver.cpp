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

/// Shortest flight that is worth a segment of its own without an event at its end, in radians of what a series would
/// have to follow.
constexpr double kShortestFlight = 1.0;

/// Largest correction of the time of a crossing, as a share of the step in which it was found.
constexpr double kMostCrossingCorrection = 0.1;

/// Longest segment in flight, in radians of its fastest motion.
constexpr double kLongestFlightSegment = 20.0;

/// Longest flight in one closed form, in radians of its fastest motion.
constexpr double kLongestFlight = 6000.0;

/// Truncation error of a contact step as a share of the tolerance asked for: what a step leaves behind is amplified by
/// the impacts after it and adds up in the energy.
constexpr double kStepShare = 1e-3;

/// Truncation error of friction forces in the tanh layer, as a share of the tolerance asked for: the root of a tenth of
/// it, within these. What of it moves the part is below that of a step; the loosest tolerances leave little of the
/// share, as the poles of the layer bound its steps.
constexpr double kLeastForceShare = 0.01, kMostForceShare = 0.1;

/// Events in a row that advance time by nothing: more than this is no motion but a contradiction.
constexpr int kMaxEventsWithoutProgress = 100;

/// Error of an implicit step as a share of the tolerance asked for.
constexpr double kImplicitShare = 1e-2;

/// Halvings of a step within which sticking contacts have to move apart.
constexpr int kMostHalvings = 50;

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

/// Time has passed: what was zero at the start no longer is. But a point that has not come out of its face yet, by the
/// error of the time at which it left it, goes on to.
void drop_pins(const System& system, const State& state, double tolerance, ContactMode& mode) {
  for (std::size_t i = 0; i < kSiteCount; ++i) {
    const Face face = mode.pins[i].face;
    mode.pins[i] = {};
    if (face == Face::none || mode.contacts[i].phase != Phase::outside) continue;
    const ContactKinematics k = contact_kinematics(system, state, static_cast<Site>(i), face);
    const double most = tolerance * (system.half_width + system.base_distance);
    if (k.depth > 0.0 && k.depth <= most && k.depth_rate < 0.0) mode.pins[i].face = face;
  }
}

/// The forces jump: V that an event has just made zero still is (returned); how it goes on from there, and what T is
/// beside its limits, is for the new forces to say.
SiteFlags forget_pushes(ContactMode& mode) {
  SiteFlags zero_slip{};
  for (std::size_t i = 0; i < kSiteCount; ++i) {
    SitePins& pins = mode.pins[i];
    zero_slip[i] = mode.contacts[i].phase == Phase::loaded && pins.slip > 0;
    pins.slip = pins.hold_plus = pins.hold_minus = 0;
  }
  return zero_slip;
}

bool any_loaded(const ContactStates& contacts) {
  return std::any_of(contacts.begin(), contacts.end(), [](const ContactState& c) { return c.phase == Phase::loaded; });
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

double force_tolerance(double tolerance) {
  const double share = std::clamp(std::sqrt(0.1 * tolerance), kLeastForceShare, kMostForceShare);
  return std::max(share * tolerance, kSmallestTolerance);
}

/// What is left of the deformations of a base at the segment's end.
void recover(const System& system, const Segment& segment, Recoveries& recoveries) {
  const Tilt tilt = tilt_of(segment.end.phi);
  for (Recovery& recovery : recoveries) {
    if (recovery.deformation == 0.0) continue;
    const double left = Relaxation(system, segment, recovery).deformation_at(segment.duration);
    recovery = left_behind(system, left, recovery.face, tilt.cos, tilt.sin);
  }
}

/// True when a leap in flight knows what is left of all deformations at its end.
bool all_recover_evenly(const System& system, const Recoveries& recoveries) {
  return std::all_of(recoveries.begin(), recoveries.end(), [&](const Recovery& recovery) {
    return recovery.deformation == 0.0 || recovers_evenly(system, recovery.face);
  });
}

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
      reach_(system_, tolerance_, force_tolerance(tolerance)),
      friction_(system_, tolerance_),
      flight_(system_, excitations.size()) {
  if (method_ != ContactMethod::series) {
    collocation();  // made now, not in the first step
    implicit_.emplace(system_, std::max(kImplicitShare * tolerance, kSmallestTolerance));
  }
  if (has_layer(system_) && !system_.recovery &&
      (method_ == ContactMethod::series || method_ == ContactMethod::automatic))
    layer_crossing_.emplace(system_, tolerance_);
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
  // a graze has no rate to divide by, or one of rounding, which leads away, or back to where the point left the face
  if (!(std::abs(correction) <= kMostCrossingCorrection * segment_.duration) || correction <= -found) return found;
  const double corrected = std::min(found + correction, segment_.duration);
  return std::abs(point_at(corrected).depth) <= std::abs(k.depth) ? corrected : found;
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
  if (progress)
    events_without_progress_ = 0;
  else if (!is_cut_)
    ++events_without_progress_;
  is_cut_ = false;
  if (progress && implicit_) implicit_->leave_start();
  by_implicit_step_ = implicit_now_ || (by_implicit_step_ && !progress);
  now_ = end;
  if (events_without_progress_ > kMaxEventsWithoutProgress) throw SolverFailure("no contact state is consistent");
  state_ = segment_.end;
  if (mode_changes_) {
    mode_ = next_mode_;
    may_cross_ = true;
  } else if (segment_.duration > 0.0) {
    drop_pins(system_, state_, tolerance_, mode_);
  }
  if (drives_change_) drives_ = next_drives_;
  drives_change_ = forces_have_jumped_ = false;
  asked_.clear();
  counts_.events += segment_.event_count;
  bool rings = false;
  for (int i = 0; i < segment_.event_count; ++i) {
    const EventKind kind = segment_.events[static_cast<std::size_t>(i)].kind;
    if (kind == EventKind::drive_kink) in_flight_ = false;
    if (kind == EventKind::aligned) outcomes_.aligned = false;
    if (kind == EventKind::inserted) outcomes_.inserted = false;
    rings = rings || rings_base(kind);
  }
  if (segment_.event_count > 0 && implicit_) implicit_->restart(rings);
  if (rings) ring();
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
  segment_.coarse = false;
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

/// Crosses the tanh layer in one segment, without series, to its other side, where nothing else can happen on the way.
/// Tried once after each event.
bool EventSolver::cross_layer(double longest, FoundEvents& found) {
  if (!layer_crossing_ || !may_cross_) return false;
  may_cross_ = false;
  const auto is_loaded = [](const ContactState& contact) { return contact.phase == Phase::loaded; };
  const ContactStates& contacts = mode_.contacts;
  const auto only = std::find_if(contacts.begin(), contacts.end(), is_loaded);
  if (only->slip != Slip::regularized || std::any_of(only + 1, contacts.end(), is_loaded)) return false;
  const auto site = static_cast<Site>(only - contacts.begin());
  if (!layer_crossing_->take(state_, forms_, contacts, site, longest, counts_)) return false;
  const double duration = layer_crossing_->duration();
  MotionBounds bounds(system_, segment_, mode_.pins, tilt_of(segment_.begin.phi));
  bounds.set(duration, layer_crossing_->most_acceleration());
  if (!bounds.only_forces_act(outcomes_)) {
    ++counts_.rejected;
    return false;
  }
  segment_.layer_crossing = &*layer_crossing_;
  segment_.coarse = false;
  segment_.order = 0;
  segment_.loaded_count = 1;
  segment_.loaded[0].site = site;
  segment_.duration = duration;
  segment_.end = layer_crossing_->end();
  found.time = duration;
  found.count = 1;
  found.events[0] = {EventKind::slip, site};
  choice_.cross_layer();
  return true;
}

void EventSolver::start() {
  set_forms(drives_, now_, forms_);
  forms_known_ = true;
  mode_ = start_mode(system_, state_, forms_, friction_);
  started_ = true;
}

void EventSolver::begin_segment(bool contact) {
  if (!forms_known_) set_forms(drives_, now_, forms_);
  forms_known_ = false;
  segment_.start = now_;
  segment_.contacts = mode_.contacts;
  if (system_.recovery) segment_.recoveries = mode_.recoveries;
  if (contact) state_ = hold_sticking(system_, state_, mode_.contacts);
  segment_.begin = state_;
  segment_.flight = nullptr;
  segment_.layer_crossing = nullptr;
  implicit_now_ = false;
  if (contact) {
    in_flight_ = false;
    return;
  }
  if (method_ == ContactMethod::automatic) choice_.leave_contact();
  // a flight without end begins anew now and then: its phases are exact at the start and rounded after it
  const double flown = in_flight_ ? now_ - flight_.start() : 0.0;
  const bool long_ago = in_flight_ && flown * flight_.rate(flown) > kLongestFlight;
  if (!in_flight_ || long_ago) flight_.begin(state_, forms_, now_);
  in_flight_ = true;
  segment_.flight_time = now_ - flight_.start();
}

/// Takes one step, by power series or an implicit one, to the first of: its end, `longest`, an event.
void EventSolver::take_step(double longest, bool contact) {
  // in flight events are only sought in the series, and their times corrected in the closed form
  const bool corrects = !contact && corrects_crossings();
  const double point_tolerance = contact ? tolerance_ : corrects ? search_tolerance_ : kFlightTolerance;
  double step = 0.0;
  if (contact) {
    step = contact_step(longest, forms_);
  } else {
    series_.expand_free(state_, forms_, corrects ? search_order_ : kFlightOrder, segment_);
    step = series_step(system_, segment_, point_tolerance);
  }
  go_along(step, longest, point_tolerance, contact);
  if (!implicit_now_ || (implicit_->keeps_contacts(segment_, mode_.pins) && !implicit_->leaves_ring_of_start() &&
                         !implicit_->leaves_ring_of_event(segment_)))
    return;
  leave_implicit_step();
  go_along(series_contact_step(longest, forms_), longest, point_tolerance, contact);
}

/// Goes along the segment's series, which hold for `step`, to the first of: its end, `longest`, an event.
void EventSolver::go_along(double step, double longest, double point_tolerance, bool contact) {
  if (!std::isfinite(last_terms(segment_))) throw SolverFailure("the motion is no longer finite");
  segment_.coarse = implicit_now_;
  segment_.duration = bounded_step(step, longest, point_tolerance, contact);
  if (!implicit_now_) counts_.rhs_evaluations += segment_.order;
  if (!(segment_.duration >= 0.0)) throw SolverFailure("the motion is no longer finite");

  // contacts that have been found to stick here, though they part within the step, hold for a part of it
  if (contact && holds_here_)
    for (int i = 0; i < kMostHalvings && must_part(); ++i) segment_.duration *= 0.5;
  holds_here_ = false;
  if (contact && must_part()) {
    // friction is decided anew
    holds_here_ = true;
    found_.parts = true;
    found_.time = 0.0;
    found_.count = 1;
    found_.events[0] = {EventKind::slip, first_sticking(mode_.contacts)};
  } else if (segment_.duration != searched_) {
    found_.clear();
    find_events(system_, series_, segment_, mode_.pins, mode_.recoveries, outcomes_, forms_, tolerance_, found_);
  }
  if (found_.count == 0) return;
  if (!contact && corrects_crossings() && found_.time > 0.0) found_.time = first_crossing(found_);
  if (implicit_now_) retake_to_events(forms_, found_);
  segment_.duration = found_.count > 0 ? found_.time : implicit_length_;
}

/// Of a step of the motion, at most `longest`, the part over which all that events are sought in holds as well: the
/// series of the points turn with the part; those of the other edge and the corners follow from these.
double EventSolver::bounded_step(double step, double longest, double point_tolerance, bool contact) {
  step = std::min({step, longest, direction_step(step, point_tolerance)});
  if (system_.recovery)
    for (const Recovery& recovery : mode_.recoveries)
      if (recovery.deformation > 0.0)
        step = std::min(step, recovery_step(system_, segment_, recovery, point_tolerance));
  if (implicit_now_ && step < implicit_length_) {
    const double shorter = shorten_implicit_step(step);
    if (shorter > 0.0) step = shorter;
    implicit_->go_on_from(step);
  }
  if (!contact && system_.contacts.edges)
    for (const Site edge : {Site::a1, Site::a2})  // both: the mirror image steps alike
      step = std::min(step, pair_step(series_.point(edge, segment_), segment_.order, point_tolerance));
  return step;
}

const Segment& EventSolver::advance(double limit) {
  if (started_)
    go_to_end();
  else
    start();
  if (++counts_.steps > step_limit_) throw SolverFailure("step limit of " + std::to_string(step_limit_) + " reached");

  const double to_limit = time_to(limit, now_), to_kink = time_to_kink(drives_, now_);
  const double longest = std::min(to_limit, to_kink);
  const bool contact = any_loaded(mode_.contacts);
  begin_segment(contact);
  found_.clear();
  searched_ = 0.0;
  const bool at_once = contact ? cross_layer(longest, found_) : leap(longest, found_);
  if (!at_once) take_step(longest, contact);
  if (contact && !at_once && method_ == ContactMethod::automatic && longest > 0.0 && !contradicted())
    settle(segment_.duration, longest);
  const bool kink = segment_.duration == to_kink;
  if (found_.count == 0 && !kink && segment_.duration < to_limit && now_.high + segment_.duration == now_.high)
    throw SolverFailure("the step has become too short");

  const bool whole_step = implicit_now_ && segment_.duration == implicit_length_;
  if (implicit_ && !whole_step) implicit_->forget();
  if (!at_once)
    segment_.end = whole_step ? implicit_->end()
                   : contact  ? state_at(segment_, segment_.duration)
                              : flight_state(segment_.duration);
  if (!is_finite(segment_.end)) throw SolverFailure("the motion is no longer finite");
  prepare_next(found_, kink);
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
    found.kink = kink;
    apply_events(system_, segment_, forms_, friction_, found, next_mode_);
  } else if (mode_changes_ && segment_.duration > 0.0) {
    drop_pins(system_, segment_.end, tolerance_, next_mode_);
  }
  for (int i = 0; i < found.count; ++i)
    segment_.events[static_cast<std::size_t>(segment_.event_count++)] = found.events[static_cast<std::size_t>(i)];
  if (kink && segment_.event_count < kMaxEvents)
    segment_.events[static_cast<std::size_t>(segment_.event_count++)] = {EventKind::drive_kink};
}

void EventSolver::cut(double duration) {
  if (implicit_) implicit_->forget();
  segment_.duration = duration;
  segment_.end = segment_.loaded_count > 0 ? state_at(segment_, duration) : flight_state(duration);
  may_cross_ = true;
  FoundEvents none;
  prepare_next(none, false);
  is_cut_ = true;
  if (!forces_have_jumped_) return;
  // what was to change at the old end does so here
  asked_.for_each([&](const std::vector<Excitation>& change) { change_drives(change); });
  forces_jump();
}

void EventSolver::set_excitations(const std::vector<Excitation>& excitations) {
  if (started_) asked_.add(excitations);
  change_drives(excitations);
  forces_jump();
}

void EventSolver::change_drives(const std::vector<Excitation>& excitations) {
  std::vector<Drive>& drives = started_ ? next_drives_ : drives_;
  const Instant when = started_ ? segment_.start + segment_.duration : now_;
  for (std::size_t i = 0; i < drives.size() && i < excitations.size(); ++i) drives[i].change(excitations[i], when);
  if (!started_) next_drives_ = drives_;
  drives_change_ = started_;
  forms_known_ = false;
}

void EventSolver::set_anchor_y(double anchor_y) {
  system_.y.anchor = anchor_y;
  forces_jump();
}

/// A jump of the forces may end sticking, and ends the closed form of a flight.
void EventSolver::forces_jump() {
  in_flight_ = false;
  if (!started_) return;
  forces_have_jumped_ = true;
  if (implicit_) implicit_->restart(true);
  ring();
  const Instant end = segment_.start + segment_.duration;
  if (!mode_changes_) {
    next_mode_ = mode_;
    if (segment_.duration > 0.0) drop_pins(system_, segment_.end, tolerance_, next_mode_);
    mode_changes_ = true;
  }
  const SiteFlags zero_slip = system_.regularization > 0.0 ? SiteFlags{} : forget_pushes(next_mode_);
  DriveForms forms;
  set_forms(next_drives_, end, forms);
  decide_friction_anew(system_, segment_, forms, zero_slip, friction_, next_mode_);
}

}  // namespace vibratory_alignment
