#include "solver/damped_pushes.h"

#include <algorithm>

#include <Eigen/LU>

namespace vibratory_alignment {
namespace {

using Dense = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kSiteCount, kSiteCount>;
using DenseVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kSiteCount, 1>;

/// Choices of who pushes: each once, and where rounding undecides one some more.
constexpr int kMostChoices = 2 << kSiteCount;

/// The N of those that push, and of the others what they would push with, which is not to be above zero.
Mobility::Vector solve_choice(const DampedPushes& p, const std::array<bool, kSiteCount>& pushes) {
  std::array<int, kSiteCount> chosen{};
  int count = 0;
  for (int i = 0; i < p.count; ++i)
    if (pushes[i]) chosen[count++] = i;
  Dense matrix = Dense::Identity(count, count);
  DenseVector offered(count);
  for (int a = 0; a < count; ++a) {
    offered[a] = p.offered[chosen[a]];
    for (int b = 0; b < count; ++b) matrix(a, b) += p.damping[chosen[a]] * p.mobility[chosen[a]][chosen[b]];
  }
  const DenseVector solution = matrix.partialPivLu().solve(offered);
  Mobility::Vector answer = p.offered;
  for (int a = 0; a < count; ++a)
    for (int i = 0; i < p.count; ++i)
      if (!pushes[i]) answer[i] -= p.damping[i] * p.mobility[i][chosen[a]] * solution[a];
  for (int a = 0; a < count; ++a) answer[chosen[a]] = solution[a];
  return answer;
}

}  // namespace

/// By principal pivots, of those that the answer contradicts always the first one (Murty 1974): that comes to an end.
Mobility::Vector solve_damped_pushes(const DampedPushes& p) {
  if (p.count == 1) return {std::max(0.0, p.offered[0] / (1.0 + p.damping[0] * p.mobility[0][0]))};
  std::array<bool, kSiteCount> pushes{};
  for (int i = 0; i < p.count; ++i) pushes[i] = p.offered[i] > 0.0;
  Mobility::Vector answer = solve_choice(p, pushes);
  for (int choice = 0; choice < kMostChoices; ++choice) {
    int first = 0;
    while (first < p.count && pushes[first] == (answer[first] > 0.0)) ++first;
    if (first == p.count) break;
    pushes[first] = !pushes[first];
    answer = solve_choice(p, pushes);
  }
  for (int i = 0; i < p.count; ++i) answer[i] = pushes[i] ? std::max(0.0, answer[i]) : 0.0;
  return answer;
}

}  // namespace vibratory_alignment
