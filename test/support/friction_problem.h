// Friction at an instant of rest, written once more from MODEL.md "Contact": what every contact's V' is made of, and
// the only V' that Coulomb's law allows, by projected Gauss-Seidel on its minimum principle.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "mechanics/contact.h"
#include "mechanics/state.h"
#include "mechanics/system.h"
#include "solver/motion_series.h"
#include "touch_point.h"

namespace vibratory_alignment::test {

/// V' = drift + G T with |T_i| <= limit_i, for contacts of a part whose velocities are zero.
struct FrictionProblem {
  using Vector = std::array<double, kSiteCount>;
  int count = 0;
  std::array<Vector, kSiteCount> mobility{};
  Vector drift{}, limit{};

  double rate(int i, const Vector& force) const {
    double rate = drift[i];
    for (int j = 0; j < count; ++j) rate += mobility[i][j] * force[j];
    return rate;
  }

  Vector rates(const Vector& force) const {
    Vector all{};
    for (int i = 0; i < count; ++i) all[i] = rate(i, force);
    return all;
  }

  /// V' of the minimum of 1/2 T.G.T + drift.T in the box, one coordinate at a time until nothing moves: V' is unique, T
  /// need not be.
  Vector true_rates() const {
    Vector force{};
    for (int sweep = 0; sweep < 200000; ++sweep) {
      double change = 0.0, largest = 0.0;
      for (int i = 0; i < count; ++i) {
        if (mobility[i][i] <= 0.0) continue;
        const double next = std::clamp(force[i] - rate(i, force) / mobility[i][i], -limit[i], limit[i]);
        change = std::max(change, std::abs(next - force[i]));
        largest = std::max(largest, std::abs(next));
        force[i] = next;
      }
      if (change <= 1e-16 * largest) break;
    }
    return rates(force);
  }
};

inline FrictionProblem friction_problem(const System& s, const State& q, const DriveForms& drives,
                                        const std::vector<Touch>& touches) {
  double fx = -s.x.stiffness * (q.x - s.x.anchor), fy = -s.y.stiffness * (q.y - s.y.anchor) - s.weight;
  double moment = -s.phi.stiffness * (q.phi - s.phi.anchor);
  for (int i = 0; i < drives.count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const Direction direction = drives.direction[index];
    (direction == Direction::x ? fx : direction == Direction::y ? fy : moment) += drives.form[index].at(0.0);
  }
  std::vector<TouchPoint> points;
  for (const Touch& touch : touches) points.push_back(touch_point(s, q, touch));
  for (const TouchPoint& p : points) {
    fx += p.normal_force * p.nx;
    fy += p.normal_force * p.ny;
    moment += p.normal_force * p.normal_moment();
  }
  FrictionProblem problem;
  problem.count = static_cast<int>(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = points[i].tx * s.x.inverse_inertia, y = points[i].ty * s.y.inverse_inertia;
    const double turn = points[i].tangent_moment() * s.phi.inverse_inertia;
    problem.limit[i] = s.friction * points[i].normal_force;
    problem.drift[i] = x * fx + y * fy + turn * moment;
    for (std::size_t j = 0; j < points.size(); ++j)
      problem.mobility[i][j] = x * points[j].tx + y * points[j].ty + turn * points[j].tangent_moment();
  }
  return problem;
}

}  // namespace vibratory_alignment::test
