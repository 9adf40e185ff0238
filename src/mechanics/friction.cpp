#include "mechanics/friction.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vibratory_alignment {
namespace {

/// Added to the diagonal, relative to its largest entry: makes a singular G share forces, changes none otherwise.
constexpr double kRidge = 1e-14;
constexpr double kRoundoff = 1e-12;

using Choice = std::array<Slip, kSiteCount>;

/// How far a choice of stick and slip is from fulfilling the conditions, relative; 0 when it does.
double violation(const FrictionProblem& problem, const Choice& choice, FrictionSolution& solution) {
  std::array<int, kSiteCount> sticking{};
  int stick_count = 0;
  for (int i = 0; i < problem.count; ++i) {
    solution.slip[i] = choice[i];
    if (choice[i] == Slip::stick) {
      sticking[stick_count++] = i;
    } else {
      solution.force[i] = choice[i] == Slip::plus ? -problem.limit[i] : problem.limit[i];
    }
  }
  // forces of those that stick
  std::array<std::array<double, kSiteCount>, kSiteCount> mobility{};
  std::array<double, kSiteCount> rhs{}, force{};
  for (int m = 0; m < stick_count; ++m) {
    const int i = sticking[m];
    rhs[m] = -problem.drift[i];
    for (int j = 0; j < problem.count; ++j)
      if (choice[j] != Slip::stick) rhs[m] -= problem.mobility[i][j] * solution.force[j];
    for (int n = 0; n < stick_count; ++n) mobility[m][n] = problem.mobility[i][sticking[n]];
  }
  solve_mobility(mobility, stick_count, rhs, force);
  double worst = 0.0;
  for (int m = 0; m < stick_count; ++m) {
    const int i = sticking[m];
    solution.force[i] = force[m];
    worst = std::max(worst, (std::abs(force[m]) - problem.limit[i]) / (std::abs(force[m]) + problem.limit[i] + 1e-300));
  }
  // directions of those that slip
  for (int i = 0; i < problem.count; ++i) {
    if (choice[i] == Slip::stick) continue;
    double acceleration = problem.drift[i], scale = std::abs(problem.drift[i]) + 1e-300;
    for (int j = 0; j < problem.count; ++j) {
      acceleration += problem.mobility[i][j] * solution.force[j];
      scale += std::abs(problem.mobility[i][j] * solution.force[j]);
    }
    worst = std::max(worst, (choice[i] == Slip::plus ? -acceleration : acceleration) / scale);
  }
  return worst;
}

}  // namespace

void solve_mobility(const std::array<std::array<double, kSiteCount>, kSiteCount>& mobility, int count,
                    const std::array<double, kSiteCount>& rhs, std::array<double, kSiteCount>& force) {
  auto matrix = mobility;
  force = rhs;
  double largest = 1e-300;
  for (int i = 0; i < count; ++i) largest = std::max(largest, matrix[i][i]);
  for (int i = 0; i < count; ++i) matrix[i][i] += kRidge * largest;
  // symmetric and positive definite: elimination without pivoting
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      const double factor = matrix[j][i] / matrix[i][i];
      for (int n = i; n < count; ++n) matrix[j][n] -= factor * matrix[i][n];
      force[j] -= factor * force[i];
    }
  }
  for (int i = count - 1; i >= 0; --i) {
    for (int n = i + 1; n < count; ++n) force[i] -= matrix[i][n] * force[n];
    force[i] /= matrix[i][i];
  }
}

FrictionSolution solve_friction(const FrictionProblem& problem) {
  // all combinations of stick, plus, minus; the first that fulfils the conditions, else the one nearest to it
  static constexpr Slip kKinds[3] = {Slip::stick, Slip::plus, Slip::minus};
  int combinations = 1;
  for (int i = 0; i < problem.count; ++i) combinations *= 3;
  FrictionSolution best, candidate;
  double least = INFINITY;
  for (int code = 0; code < combinations; ++code) {
    Choice choice{};
    int digits = code;
    for (int i = 0; i < problem.count; ++i, digits /= 3) choice[i] = kKinds[digits % 3];
    const double value = violation(problem, choice, candidate);
    if (value < least) {
      least = value;
      best = candidate;
      if (value <= kRoundoff) break;
    }
  }
  return best;
}

}  // namespace vibratory_alignment
