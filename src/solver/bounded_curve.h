// A number that changes with time, known by its first derivatives and a bound on the next: what is certain about its
// sign for a while.
#pragma once

#include <algorithm>
#include <cmath>

namespace vibratory_alignment {

/// value + rate s + 1/2 acceleration s^2 at time s >= 0 from now, with an error of at most 1/6 jerk s^3.
struct BoundedCurve {
  /// The end of a time is known when so small a part of it is left open. What is lost is time, never certainty.
  static constexpr double kNear = 0.05;
  static constexpr int kMostSteps = 60;

  double value, rate, acceleration, jerk;

  double highest(double s) const { return value + s * (rate + s * (0.5 * acceleration + s * jerk / 6.0)); }
  double lowest(double s) const { return value + s * (rate + s * (0.5 * acceleration - s * jerk / 6.0)); }
  BoundedCurve negative() const { return {-value, -rate, -acceleration, jerk}; }

  /// True when the curve surely stays above zero on [0, span].
  bool stays_above(double span) const {
    return value - span * (std::abs(rate) + span * (0.5 * std::abs(acceleration) + span * jerk / 6.0)) > 0.0;
  }

  /// True when the curve surely rises on all of [0, span].
  bool rises(double span) const { return rate + span * (std::min(acceleration, 0.0) - 0.5 * span * jerk) > 0.0; }

  /// First positive zero of value + rate s + 1/2 acceleration s^2 for value < 0; infinity if there is none.
  double estimated_rise() const {
    const double discriminant = rate * rate - 2.0 * acceleration * value;
    if (discriminant < 0.0) return INFINITY;
    const double root = std::sqrt(discriminant);
    if (rate > 0.0) return -2.0 * value / (rate + root);
    return acceleration > 0.0 ? (root - rate) / acceleration : INFINITY;
  }

  /// Time in [0, longest] up to which the curve surely stays at or below zero. `from_zero`: it starts at zero, its
  /// value is rounding, and is judged by what follows.
  double time_below(double longest, bool from_zero) const {
    if (from_zero) return rate < 0.0 ? std::min(return_to_zero(), longest) : 0.0;
    if (value >= 0.0) return 0.0;
    // the upper bound bends down until its inflection, and up from there
    const double inflection = acceleration < 0.0 ? std::min(longest, -acceleration / jerk) : 0.0;
    if (rate > 0.0 && inflection > 0.0) {
      const double discriminant = acceleration * acceleration - 2.0 * jerk * rate;
      if (!std::isfinite(discriminant)) return 0.0;
      // the maximum, in the form that loses no digits where the jerk is next to nothing
      const double top = discriminant > 0.0 ? 2.0 * rate / (std::sqrt(discriminant) - acceleration) : inflection;
      if (highest(std::min(top, inflection)) > 0.0) return rise_bending_down();
    }
    return highest(longest) <= 0.0 ? longest : rise_bending_up(inflection, longest);
  }

 private:
  double slope_of_highest(double s) const { return rate + s * (acceleration + s * (0.5 * jerk)); }

  /// First positive zero of the upper bound if it starts at zero and falls: of rate + 1/2 acceleration s + 1/6 jerk
  /// s^2.
  double return_to_zero() const {
    const double bend = 0.5 * acceleration, square = bend * bend - jerk * rate * (2.0 / 3.0);
    if (!std::isfinite(square)) return 0.0;
    if (bend > 0.0) return -2.0 * rate / (bend + std::sqrt(square));
    return jerk > 0.0 ? (std::sqrt(square) - bend) / (jerk / 3.0) : INFINITY;
  }

  /// Before the first zero of the upper bound, up to which it rises and bends down: Newton's steps stay before it.
  double rise_bending_down() const {
    double s = -value / rate;
    for (int i = 0; i < kMostSteps; ++i) {
      const double step = -highest(s) / slope_of_highest(s);
      if (!(step > 0.0)) break;
      s += step;
      if (step < kNear * s) break;
    }
    return s;
  }

  /// Before the zero of the upper bound in [low, high], where it bends up: Newton's steps come from beyond, chords
  /// from before, somewhat shortened against rounding.
  double rise_bending_up(double low, double high) const {
    double below = highest(low);
    if (!(below <= 0.0)) return 0.0;
    high = std::min(high, estimated_rise());
    for (int i = 0; i < kMostSteps; ++i) {
      const double above = highest(high);
      if (above <= 0.0) return high;
      const double next = low - 0.99 * below * (high - low) / (above - below);
      high -= above / slope_of_highest(high);
      below = highest(next);
      if (!(below <= 0.0)) break;
      low = next;
      if (!(high - low > kNear * high)) break;
    }
    return low;
  }
};

}  // namespace vibratory_alignment
