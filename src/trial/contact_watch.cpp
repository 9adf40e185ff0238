#include "trial/contact_watch.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "mechanics/contact_frame.h"
#include "solver/layer_crossing.h"
#include "solver/polynomial_roots.h"
#include "solver/solver.h"

namespace vibratory_alignment {
namespace {

/// A touch this early belongs to the start: the trial begins in contact.
constexpr double kStart = 1e-12;

/// Room for changes of mode without allocation.
constexpr std::size_t kExpectedChanges = 1024;

/// True when N of loaded[i] surely stays below `force` during the segment.
bool force_stays_below(const Segment& segment, int i, double force) {
  if (segment.layer_crossing != nullptr) return segment.layer_crossing->most_normal_force() <= force;
  const Series& normal_force = segment.loaded[i].normal_force;
  double bound = 0.0;
  for (int k = segment.order; k > 0; --k) bound = (bound + std::max(normal_force[k], 0.0)) * segment.duration;
  return normal_force[0] + bound <= force || stays_below(normal_force, segment.order, segment.duration, force);
}

}  // namespace

ContactWatch::ContactWatch(const System& system, double period) : system_(system), period_(period) {
  changes_.reserve(kExpectedChanges);
}

void ContactWatch::book(const Segment& segment) {
  book_peaks(segment);
  follow_mode(segment);
  for (int i = 0; i < segment.event_count; ++i)
    if (segment.events[i].kind == EventKind::touch) book_touch(segment, segment.events[i]);
}

void ContactWatch::book_peaks(const Segment& segment) {
  for (int i = 0; i < segment.loaded_count; ++i) {
    const Spot spot = spot_of(segment.loaded[i].site);
    double& peak = peaks_[static_cast<std::size_t>(spot)];
    // the maximum is looked for only where it can be a new one
    if (force_stays_below(segment, i, peak)) continue;
    const double largest = largest_normal_force(segment, i, 0.0, segment.duration);
    if (!std::isfinite(largest))
      throw SolverFailure(std::string("the force at ") + to_string(spot) + " is no longer finite");
    peak = std::max(peak, largest);
  }
}

void ContactWatch::book_touch(const Segment& segment, const Event& touch) {
  const double time = segment.end_time();
  if (time <= kStart) return;
  const auto spot = static_cast<std::size_t>(spot_of(touch.site));
  ++impacts_[spot];
  times_[spot] = {times_[spot] ? times_[spot]->first : time, time};
  if (first_) return;
  const ContactKinematics k = contact_kinematics(system_, segment.end, touch.site, touch.face);
  first_ = FirstContact{time, spot_of(touch.site), segment.end, k.depth_rate, k.slip_velocity};
}

void ContactWatch::follow_mode(const Segment& segment) {
  const bool touching = is_touching(segment);
  const double start = segment.start.value();
  if (touching && !touching_) {
    // contact regained: the flight before it was a loss
    if (ever_touched_) note(Mode::impact, contact_end_);
    contact_start_ = start;
  }
  if (touching_ && !touching) contact_end_ = start;
  if (touching && segment.end_time() - contact_start_ > period_) note(Mode::nonimpact, contact_start_);
  touching_ = touching;
  ever_touched_ = ever_touched_ || touching;
}

void ContactWatch::note(Mode mode, double time) {
  if (changes_.empty() || changes_.back().mode != mode) changes_.push_back({time, mode});
}

bool ContactWatch::is_touching(const Segment& segment) {
  return std::any_of(segment.contacts.begin(), segment.contacts.end(),
                     [](const ContactState& contact) { return contact.touching(); });
}

/// Before the first change: whether the first contact still lasts.
Mode ContactWatch::mode_where(bool touching) const {
  if (changes_.empty()) return touching ? Mode::nonimpact : Mode::none;
  return changes_.size() == 1 ? changes_.front().mode : Mode::mixed;
}

}  // namespace vibratory_alignment
