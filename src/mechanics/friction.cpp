#include "mechanics/friction.h"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

namespace vibratory_alignment {
namespace {

/// Below this, relative to the largest, a pivot of G is rounding: the contacts hold the same motion.
constexpr double kSingular = 2e-15;
constexpr double kRoundoff = 1e-12;

using Choice = std::array<Slip, kSiteCount>;

/// How far a choice of stick and slip is from fulfilling the conditions, in accelerations relative to what they are
/// made of; 0 when it does, infinite when nothing can hold a sticking contact.
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
  for (int m = 0; m < stick_count; ++m) {
    solution.force[sticking[m]] = force[m];
    if (!std::isfinite(force[m])) return INFINITY;
  }
  double worst = 0.0;
  for (int i = 0; i < problem.count; ++i) {
    double acceleration = problem.drift[i], scale = problem.drift_scale[i] + 1e-300;
    for (int j = 0; j < problem.count; ++j) {
      acceleration += problem.mobility[i][j] * solution.force[j];
      scale += std::abs(problem.mobility[i][j]) * (std::abs(solution.force[j]) + problem.limit[j]);
    }
    if (choice[i] == Slip::stick) {
      // holds, and with a force within its limit
      const double excess = problem.mobility[i][i] * (std::abs(solution.force[i]) - problem.limit[i]);
      worst = std::max({worst, std::abs(acceleration) / scale, excess / scale});
    } else {
      worst = std::max(worst, (choice[i] == Slip::plus ? -acceleration : acceleration) / scale);
    }
  }
  return worst;
}

}  // namespace

void solve_mobility(const std::array<std::array<double, kSiteCount>, kSiteCount>& mobility, int count,
                    const std::array<double, kSiteCount>& rhs, std::array<double, kSiteCount>& force) {
  if (count == 0) return;
  if (count == 1) {
    force[0] = rhs[0] / mobility[0][0];
    return;
  }
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kSiteCount, kSiteCount>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kSiteCount, 1>;
  Matrix matrix(count, count);
  Vector vector(count);
  for (int i = 0; i < count; ++i) {
    vector[i] = rhs[i];
    for (int j = 0; j < count; ++j) matrix(i, j) = mobility[i][j];
  }
  Eigen::CompleteOrthogonalDecomposition<Matrix> decomposition;
  decomposition.setThreshold(kSingular);
  decomposition.compute(matrix);
  const Vector solution = decomposition.solve(vector);
  for (int i = 0; i < count; ++i) force[i] = solution[i];
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
