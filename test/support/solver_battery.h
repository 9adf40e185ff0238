// What the battery of tests that every solver goes through knows about each of them, and closed forms to hold it
// against.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "model/scene.h"
#include "trial/make_solver.h"

namespace vibratory_alignment::test {

/// A solver and what is stated about it (docs/solvers.md, docs/hybrid_step.md).
struct StatedSolver {
  const char* name;
  bool fixed_step;
  double order;            ///< fixed step: while the motion is smooth
  bool sticks;             ///< V = 0 while dry friction holds; else V creeps in a layer as narrow as the step
  double numerical_decay;  ///< an oscillation of rate w has the damping ratio h w times this in addition
};

inline std::ostream& operator<<(std::ostream& out, const StatedSolver& solver) { return out << solver.name; }

/// All of this build.
inline std::vector<StatedSolver> stated_solvers() {
  return {{"event", false, 0.0, true, 0.0}, {"implicit", false, 0.0, true, 0.0},
          {"auto", false, 0.0, true, 0.0},  {kImplicitAlone, false, 0.0, true, 0.0},
          {"rk4", true, 4.0, false, 0.0},   {"semi_implicit", true, 1.0, true, 0.0},
#ifdef VIBRATORY_ALIGNMENT_ODE
          {"ode", true, 1.0, true, 0.5}
#endif
  };
}

/// A suite of tests with the solver as its parameter.
class SolverBattery : public testing::TestWithParam<StatedSolver> {
 protected:
  bool fixed_step() const { return GetParam().fixed_step; }

  /// The scene with this solver; `setting` is its step or its tolerance.
  Scene with(Scene scene, double setting) const {
    scene.solver = {};
    scene.solver.name = GetParam().name;
    if (fixed_step())
      scene.solver.step = setting;
    else
      scene.solver.tolerance = setting;
    return scene;
  }

  /// Coarse to fine, far enough from each other to show an order and well above rounding.
  std::vector<double> settings() const {
    return fixed_step() ? std::vector<double>{8e-4, 2e-4, 5e-5} : std::vector<double>{1e-4, 1e-7, 1e-10};
  }
};

/// Names the instances after the solvers.
inline std::string solver_test_name(const testing::TestParamInfo<StatedSolver>& info) { return info.param.name; }

/// y'' + c y' + k y = f, underdamped: value and rate at t.
struct Oscillation {
  double c, k, f, y0, v0;

  double rate() const { return std::sqrt(k - 0.25 * c * c); }
  double y(double t) const {
    const double w = rate(), a = 0.5 * c, u = y0 - f / k;
    return f / k + std::exp(-a * t) * (u * std::cos(w * t) + (v0 + a * u) / w * std::sin(w * t));
  }
  double v(double t) const {
    const double w = rate(), a = 0.5 * c, u = y0 - f / k, b = (v0 + a * u) / w;
    return std::exp(-a * t) * ((b * w - a * u) * std::cos(w * t) - (u * w + a * b) * std::sin(w * t));
  }
};

/// A part that is drawn to a damped spring, its edge: when it touches and when N falls to zero, from the closed forms
/// of flight and contact alone.
struct BouncingBall {
  double stiffness = 1e4, damping = 20.0, anchor = 0.6, surface = 0.9, start = 1.0;
  std::vector<double> touches, releases;

  explicit BouncingBall(double end) {
    double t = 0.0;
    Oscillation flight{0.0, 1.0, anchor, start, 0.0};
    while (true) {
      // first out of the base, then back to it
      double s = flight.y0 < surface ? first_zero([&](double u) { return surface - flight.y(u); }, 0.0) : 0.0;
      s = first_zero([&](double u) { return flight.y(u) - surface; }, s + kScan);
      if ((t += s) > end) return;
      touches.push_back(t);
      const Oscillation contact{damping, 1.0 + stiffness, anchor + stiffness * surface, flight.y(s), flight.v(s)};
      const auto force = [&](double u) { return stiffness * (surface - contact.y(u)) - damping * contact.v(u); };
      s = first_zero(force, kScan);
      if ((t += s) > end) return;
      releases.push_back(t);
      flight = {0.0, 1.0, anchor, contact.y(s), contact.v(s)};
    }
  }

 private:
  static constexpr double kScan = 1e-4;

  /// Where g falls below zero after `from`.
  template <class Function>
  static double first_zero(const Function& g, double from) {
    double low = from;
    while (g(low + kScan) > 0.0) low += kScan;
    double high = low + kScan;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (g(middle) > 0.0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
};

}  // namespace vibratory_alignment::test
