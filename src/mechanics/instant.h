// A point of simulated time with more digits than a double, so that the phase of the excitation does not drift in
// long runs: the sum of two doubles, |low| <= ulp(high)/2.
#pragma once

#include <algorithm>
#include <cmath>

namespace vibratory_alignment {

struct Instant {
  double high = 0.0;
  double low = 0.0;

  /// The nearest double.
  double value() const { return high; }
};

/// t + dt, exact to about 32 digits (two-sum).
inline Instant operator+(const Instant& t, double dt) {
  const double sum = t.high + dt;
  const double part = sum - t.high;
  const double error = (t.high - (sum - part)) + (dt - part) + t.low;
  Instant result;
  result.high = sum + error;
  result.low = error - (result.high - sum);
  return result;
}

/// Time from `earlier` to `later`, rounded to a double.
inline double operator-(const Instant& later, const Instant& earlier) {
  return (later.high - earlier.high) + (later.low - earlier.low);
}

inline double operator-(double later, const Instant& earlier) { return (later - earlier.high) - earlier.low; }

/// Time from `now` to `end`, 0 when that is over: added to `now` it makes the double `end` to the last bit.
inline double time_to(double end, const Instant& now) {
  const double time = std::max(0.0, end - now), reached = (now + time).value();
  if (time == 0.0 || reached == end) return time;
  return std::nextafter(time, reached < end ? HUGE_VAL : 0.0);
}

}  // namespace vibratory_alignment
