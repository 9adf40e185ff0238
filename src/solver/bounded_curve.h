// A number that changes with time, known by its first derivatives and a bound on the next: what is certain about its
// sign for a while.
#pragma once

#include <algorithm>
#include <cmath>

namespace vibratory_alignment {

/// value + rate s + 1/2 acceleration s^2 at time s >= 0 from now, with an error of at most 1/6 jerk s^3.
struct BoundedCurve {
  /// Halvings with which the end of a time is found at least and at most: no more than to half of it. What is lost is
  /// time, never certainty.
  static constexpr int kHalvings = 8, kMostHalvings = 60;

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
    if (from_zero ? !(rate < 0.0) : value >= 0.0) return 0.0;
    // its upper bound rises, falls where rate + acceleration s + 1/2 jerk s^2 < 0, and rises again
    double low = 0.0, high = longest;
    const bool turns = rate > 0.0 && acceleration < 0.0;
    if (!turns && highest(high) <= 0.0) return high;
    const double discriminant = acceleration * acceleration - 2.0 * jerk * rate;
    if (!std::isfinite(discriminant)) return 0.0;
    const double root = std::sqrt(std::max(discriminant, 0.0));
    if (turns && discriminant > 0.0) {
      // the smaller zero in the form that loses no digits where the jerk is next to nothing
      const double maximum = 2.0 * rate / (root - acceleration);
      if (highest(std::min(maximum, longest)) > 0.0)
        high = std::min(maximum, longest);
      else
        low = std::min((root - acceleration) / jerk, longest);
    } else if (rate <= 0.0) {
      const double minimum = acceleration < 0.0 ? (root - acceleration) / jerk : -2.0 * rate / (root + acceleration);
      if (minimum > 0.0) low = std::min(minimum, longest);
    }
    if (turns && highest(high) <= 0.0) return high;
    for (int i = 0; i < kHalvings || (low < 0.5 * high && i < kMostHalvings); ++i) {
      const double middle = 0.5 * (low + high);
      (highest(middle) <= 0.0 ? low : high) = middle;
    }
    return low;
  }
};

}  // namespace vibratory_alignment
