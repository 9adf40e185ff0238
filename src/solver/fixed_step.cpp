#include "solver/fixed_step.h"

#include <algorithm>
#include <cmath>

namespace vibratory_alignment {
namespace {

/// A rest of a step this small, relative to the step, is joined to a neighbour.
constexpr double kSliver = 1e-6;

}  // namespace

FixedStepSolver::FixedStepSolver(const System& system, const std::vector<Excitation>& excitations,
                                 std::unique_ptr<StepMethod> method, double step, long step_limit)
    : system_(system),
      method_(std::move(method)),
      step_(step),
      step_limit_(step_limit),
      sites_(system_),
      planned_(step),
      books_{open_book(system_, sites_, system.start), ContactBook(system.start)},
      drives_(excitations, now_),
      awaits_inserted_(system.has_inserted_depth) {}

void FixedStepSolver::go_to_end() {
  now_ = segment_.start + segment_.duration;
  drives_.pass(segment_.duration);
  asked_.for_each([&](const std::vector<Excitation>& change) { drives_.change(change, now_); });
  asked_.clear();
  book_ = 1 - book_;
  // what is left of the step, so that the steps stay on their grid
  const double left = planned_ - segment_.duration;
  planned_ = left > kSliver * step_ ? left : step_ + left;
  counts_.events += segment_.event_count;
  for (int i = 0; i < segment_.event_count; ++i) {
    const EventKind kind = segment_.events[static_cast<std::size_t>(i)].kind;
    if (kind == EventKind::aligned) awaits_aligned_ = false;
    if (kind == EventKind::inserted) awaits_inserted_ = false;
  }
}

const Segment& FixedStepSolver::advance(double limit) {
  const bool is_first = !started_;
  if (started_) go_to_end();
  started_ = true;
  if (++counts_.steps > step_limit_) throw SolverFailure("step limit of " + std::to_string(step_limit_) + " reached");

  const double to_limit = time_to(limit, now_);
  double duration = planned_;
  if (to_limit <= (1.0 + kSliver) * duration) duration = to_limit;

  segment_.start = now_;
  segment_.begin = state();
  segment_.duration = duration;
  segment_.flight = nullptr;
  segment_.loaded_count = 0;
  segment_.contacts = book().contacts;
  if (system_.recovery) segment_.recoveries = book().recoveries;
  drives_.begin_step(now_);
  if (duration > 0.0) {
    counts_.rhs_evaluations += method_->step({system_, sites_, book(), drives_, duration}, segment_, slip_at_end_);
    if (!is_finite(segment_.end)) throw SolverFailure("the motion is no longer finite");
  } else {
    rest();
  }
  book_end(true);
  if (is_first) {
    look_beyond_rest();
    take_events_of_start();
  }
  set_direction();
  return segment_;
}

/// Where the forces of the start are zero the first step may leave the part exactly where it is. What the next one leads
/// into is touched at the start then.
void FixedStepSolver::look_beyond_rest() {
  const State &begin = segment_.begin, &end = segment_.end;
  if (segment_.duration == 0.0 || begin.x != end.x || begin.y != end.y || begin.phi != end.phi) return;
  Segment next;
  next.start = now_ + segment_.duration;
  next.begin = end;
  next.duration = step_;
  next.contacts = end_book().contacts;
  if (system_.recovery) next.recoveries = end_book().recoveries;
  std::array<Slip, kSiteCount> slip{};
  drives_.begin_step(next.start);
  method_->step({system_, sites_, end_book(), drives_, next.duration}, next, slip);
  drives_.begin_step(now_);
  if (!is_finite(next.end)) return;
  ContactBook after(next.end);
  follow(system_, sites_, end_book(), next, after);
  for (int i = 0; i < next.event_count; ++i) {
    const Event& event = next.events[static_cast<std::size_t>(i)];
    if (event.kind == EventKind::touch && starts_on(event)) add_event(segment_, event.kind, event.site, event.face);
  }
}

/// What the first step has found may be of the start itself: the touch of a face on which a point starts, an outcome
/// that holds there. Then the first segment is the start alone, and the step comes after it.
void FixedStepSolver::take_events_of_start() {
  const ContactBook& start = book();
  ContactBook& end = end_book();
  std::array<Event, kMaxEvents> touches;
  int count = 0;
  for (int i = 0; i < segment_.event_count; ++i) {
    const Event& event = segment_.events[static_cast<std::size_t>(i)];
    if (event.kind == EventKind::touch && starts_on(event)) touches[static_cast<std::size_t>(count++)] = event;
  }
  if (count == 0 && !aligns(start) && !inserts(start)) return;

  segment_.duration = 0.0;
  segment_.contacts = start.contacts;
  segment_.loaded_count = segment_.event_count = 0;
  rest();
  end = start;
  for (int n = 0; n < count; ++n) {
    const Event& touch = touches[static_cast<std::size_t>(n)];
    const auto i = static_cast<std::size_t>(touch.site);
    const ContactPoint& point = end.touching[i] =
        contact_point(system_, end.placed, touch.site, touch.face, end.points[i]);
    end.contacts[i].phase = point.push() > 0.0 ? Phase::loaded : Phase::unloaded;
    end.contacts[i].face = touch.face;
    if (end.contacts[i].phase == Phase::loaded) end.contacts[i].slip = slip_at(i, true);
    add_event(segment_, EventKind::touch, touch.site, touch.face);
  }
  add_outcomes(start);
}

bool FixedStepSolver::aligns(const ContactBook& at) const {
  return awaits_aligned_ && is_below(system_, at.placed, at.contacts, system_.aligned_depth, true);
}

bool FixedStepSolver::inserts(const ContactBook& at) const {
  return awaits_inserted_ && is_below(system_, at.placed, at.contacts, system_.inserted_depth, false);
}

void FixedStepSolver::add_outcomes(const ContactBook& at) {
  if (aligns(at)) add_event(segment_, EventKind::aligned, Site::b1);
  if (inserts(at)) add_event(segment_, EventKind::inserted, Site::b1);
}

bool FixedStepSolver::starts_on(const Event& touch) const {
  const Vec2& point = book().points[static_cast<std::size_t>(touch.site)];
  return std::abs(contact_frame(system_, touch.face).depth(point.x, point.y)) <= last_digits(system_, state());
}

/// A segment without length.
void FixedStepSolver::rest() {
  segment_.end = state();
  segment_.order = 0;
  const State& s = state();
  const Load3 drive = drives_.at(0.0);
  segment_.x[0] = s.x;
  segment_.y[0] = s.y;
  segment_.phi[0] = s.phi;
  segment_.vx[0] = s.vx;
  segment_.vy[0] = s.vy;
  segment_.omega[0] = s.omega;
  segment_.drive_x[0] = drive.x;
  segment_.drive_y[0] = drive.y;
  segment_.drive_phi[0] = drive.phi;
}

/// cos and sin of the tilt, as far as the order of the segment goes; of a line, in which forces act along the
/// directions of its start, those of there.
void FixedStepSolver::set_direction() {
  const PlacedState &begin = book().placed, &end = end_book().placed;
  const double h = segment_.duration;
  const int order = segment_.order;
  set_constant(segment_.cos_phi, order, begin.cos_phi);
  set_constant(segment_.sin_phi, order, begin.sin_phi);
  if (order >= 3) {
    const double w0 = begin.state.omega, w1 = end.state.omega;
    set_cubic(segment_.cos_phi, order, begin.cos_phi, -w0 * begin.sin_phi, end.cos_phi, -w1 * end.sin_phi, h);
    set_cubic(segment_.sin_phi, order, begin.sin_phi, w0 * begin.cos_phi, end.sin_phi, w1 * end.cos_phi, h);
  }
}

/// Slip of a loaded contact at the segment's end. Where the segment has been cut the method has not decided it, and a
/// contact sticks there that does so at both ends.
Slip FixedStepSolver::slip_at(std::size_t site, bool whole) {
  if (system_.friction == 0.0) return Slip::none;
  const bool was_loaded = segment_.contacts[site].phase == Phase::loaded;
  const Slip before = segment_.contacts[site].slip, decided = slip_at_end_[site];
  if (was_loaded && (whole || before == decided)) return decided;
  return end_book().touching[site].slip_velocity > 0.0 ? Slip::plus : Slip::minus;
}

void FixedStepSolver::book_end(bool whole) {
  segment_.event_count = 0;
  ContactBook& end = end_book();
  follow(system_, sites_, book(), segment_, end);
  for (int n = 0; n < sites_.count; ++n) {
    const Site site = sites_.sites[static_cast<std::size_t>(n)];
    const auto i = static_cast<std::size_t>(site);
    ContactState& contact = end.contacts[i];
    if (contact.phase != Phase::loaded) continue;
    contact.slip = slip_at(i, whole);
    if (book().contacts[i].phase != Phase::loaded || system_.friction == 0.0) continue;
    const bool sticks = contact.slip == Slip::stick, stuck = segment_.contacts[i].slip == Slip::stick;
    const bool reversed = book().touching[i].slip_velocity * end.touching[i].slip_velocity < 0.0;
    if (sticks != stuck)
      add_event(segment_, sticks ? EventKind::stick : EventKind::slip, site);
    else if (!sticks && reversed)
      add_event(segment_, EventKind::slip_reversal, site);
  }
  if (drives_.has_kink(segment_.duration)) add_event(segment_, EventKind::drive_kink, Site::a1);
  add_outcomes(end);
}

void FixedStepSolver::cut(double duration) {
  segment_.end = duration > 0.0 ? state_at(segment_, duration) : segment_.begin;
  if (duration == 0.0) segment_.loaded_count = 0;  // the forces at its start are those of the step before
  segment_.duration = duration;
  book_end(false);
}

void FixedStepSolver::set_excitations(const std::vector<Excitation>& excitations) {
  if (started_)
    asked_.add(excitations);
  else
    drives_.change(excitations, now_);
}

}  // namespace vibratory_alignment
