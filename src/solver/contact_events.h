// When the current contact laws end: the guards of docs/hybrid_step.md "Guards" on one segment.
#pragma once

#include "solver/motion_series.h"

namespace vibratory_alignment {

/// What is known to be exactly zero at the start of a segment because an event has just put it there.
struct SitePins {
  int normal = 0;          ///< zeros of N (loaded) or of the force that would load (unloaded)
  int slip = 0;            ///< zeros of V; 2 where sliding has just begun out of stick
  Face face = Face::none;  ///< the face on which an outside point lies
};
using Pins = std::array<SitePins, kSiteCount>;

/// Which outcomes are still waited for.
struct OutcomeGuards {
  bool aligned = false, inserted = false;
};

/// A base that recovers: deformation u exp(-rate t) of a site during a segment.
struct Recovery {
  double deformation = 0.0, rate = 0.0;
  Face face = Face::none;
};
using Recoveries = std::array<Recovery, kSiteCount>;

struct FoundEvents {
  double time = kNoEvent;
  int count = 0;
  std::array<Event, kMaxEvents> events;

  static constexpr double kNoEvent = -1.0;
};

/// |V|/eps beyond which tanh is 1 to the last digit: the regularised law is then sliding friction.
constexpr double kTanhSaturation = 19.1;

/// First event within [0, duration] of the segment, with all that coincide with it.
FoundEvents find_events(const System& system, MotionSeries& series, Segment& segment, const Pins& pins,
                        const Recoveries& recoveries, const OutcomeGuards& outcomes, const DriveForms& drives);

}  // namespace vibratory_alignment
