#include "solver/ring_watch.h"

#include <algorithm>

namespace vibratory_alignment {
namespace {

/// Shortest implicit step that passes over a ring, in steps of the series, but not more than this share of the way.
constexpr double kShortest = 2.0, kShortestShare = 0.5;

/// Steps of the series after the first implicit step that was given up in a ring; after each further one twice as many.
constexpr int kWait = 4;

}  // namespace

void RingWatch::ring() {
  series_follow_ = true;
  wait_ = 0;
}

StepBounds RingWatch::bounds(double longest) const {
  StepBounds bounds{longest};
  bounds.shortest = std::min(kShortest * series_step_, kShortestShare * longest);
  bounds.passes_over = first_;
  return bounds;
}

void RingWatch::settle_implicit(bool follows_base) {
  wait_ = 0;
  if (follows_base && ++short_steps_ >= most_short_steps_) {
    series_follow_ = true;
    most_short_steps_ *= 2;
    short_steps_ = 0;
  } else if (!follows_base && !first_) {
    short_steps_ = 0;
  }
  first_ = false;
}

void RingWatch::give_up_implicit() {
  series_follow_ = true;
  wait_ = std::max(kWait, 2 * wait_);
  steps_ = 0;
}

bool RingWatch::asks(double step) {
  series_step_ = step;
  return ++steps_ >= wait_;
}

void RingWatch::pass_over() {
  series_follow_ = false;
  first_ = true;
}

}  // namespace vibratory_alignment
