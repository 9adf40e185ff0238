// What a trial's contacts have done so far: impacts, peak forces, first touch, and the mode of motion.
//
// Mode: contact is lost "again and again" while no contact lasts longer than one period of the excitation, and "kept"
// when one does. A loss counts once it is followed by another touch, so that the slip-down into the slot, which leaves
// the base for good, does not.
#pragma once

#include <optional>
#include <vector>

#include "mechanics/system.h"
#include "solver/segment.h"
#include "trial/outcome.h"

namespace vibratory_alignment {

class ContactWatch {
 public:
  /// `period`: of the slowest excitation.
  ContactWatch(const System& system, double period);

  void set_period(double period) { period_ = period; }
  void book(const Segment& segment);

  long impacts(Spot spot) const { return impacts_[static_cast<std::size_t>(spot)]; }
  double peak_force(Spot spot) const { return peaks_[static_cast<std::size_t>(spot)]; }
  const std::optional<FirstContact>& first_contact() const { return first_; }
  const std::optional<ImpactTimes>& impact_times(Spot spot) const { return times_[static_cast<std::size_t>(spot)]; }
  const std::vector<ModeChange>& mode_changes() const { return changes_; }
  /// Of the segments that have been booked.
  Mode mode() const { return mode_where(touching_); }
  /// Where the motion is in `segment`, the last booked one or that after it.
  Mode mode_in(const Segment& segment) const { return mode_where(is_touching(segment)); }

 private:
  static bool is_touching(const Segment& segment);
  Mode mode_where(bool touching) const;
  void book_peaks(const Segment& segment);
  void book_touch(const Segment& segment, const Event& touch);
  void follow_mode(const Segment& segment);
  void note(Mode mode, double time);

  System system_;
  double period_;
  std::array<long, kSpotCount> impacts_{};
  std::array<double, kSpotCount> peaks_{};
  std::array<std::optional<ImpactTimes>, kSpotCount> times_;
  std::optional<FirstContact> first_;
  std::vector<ModeChange> changes_;
  bool touching_ = false, ever_touched_ = false;
  double contact_start_ = 0.0, contact_end_ = 0.0;
};

}  // namespace vibratory_alignment
