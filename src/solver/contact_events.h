// When the current contact laws end: the guards of docs/hybrid_step.md "Guards" on one segment.
#pragma once

#include "solver/contact_mode.h"
#include "solver/motion_bounds.h"
#include "solver/motion_series.h"

namespace vibratory_alignment {

struct FoundEvents {
  double time = kNoEvent;
  int count = 0;
  bool parts = false;  ///< sticking contacts have to move apart: their forces are at no limit
  bool kink = false;   ///< an excitation has a kink at the same instant
  std::array<Event, kMaxEvents> events;

  static constexpr double kNoEvent = -1.0;

  void clear() {
    time = kNoEvent;
    count = 0;
    parts = kink = false;
  }
};

/// Adds the first event within [0, duration] of the segment to `found`, which has none, with all that coincide with it.
/// `tolerance`: error that steps leave in places, relative to the part's lengths.
[[gnu::noinline]] void find_events(const System& system, MotionSeries& series, Segment& segment, const Pins& pins,
                                   const Recoveries& recoveries, const OutcomeGuards& outcomes,
                                   const DriveForms& drives, double tolerance, FoundEvents& found);

}  // namespace vibratory_alignment
