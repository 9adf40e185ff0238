#include "solver/box_friction.h"

#include <algorithm>
#include <cmath>

namespace vibratory_alignment {
namespace {

/// Sweeps that guess what sticks and what slides.
constexpr int kSweeps = 16;

/// A mobility that is none, beside a typical one; a T at its limit; rounding beside what a sum is made of.
constexpr double kHeldFast = 1e-14;
constexpr double kAtLimit = 1e-12;
constexpr double kRounding = 1e-13;

/// -1: T = -limit, 0: sticks, 1: T = limit.
using Choice = std::array<int, kSiteCount>;

double slip(const BoxFriction& p, int i, const Mobility::Vector& force) {
  double v = p.slip_free[i];
  for (int j = 0; j < p.count; ++j) v += p.mobility[i][j] * force[j];
  return v;
}

/// All contacts answer at once, each with its share: this always converges, and treats contacts alike.
void sweep(const BoxFriction& p, Mobility::Vector& force) {
  Mobility::Vector next{};
  for (int i = 0; i < p.count; ++i) {
    const double v = slip(p, i, force), share = p.count * p.mobility[i][i];
    const double slides = v > 0.0 ? -p.limit[i] : v < 0.0 ? p.limit[i] : 0.0;
    next[i] = share > kHeldFast * p.typical ? std::clamp(force[i] - v / share, -p.limit[i], p.limit[i]) : slides;
  }
  force = next;
}

Choice choice_of(const BoxFriction& p, const Mobility::Vector& force) {
  Choice choice{};
  for (int i = 0; i < p.count; ++i)
    if (std::abs(force[i]) >= (1.0 - kAtLimit) * p.limit[i]) choice[i] = force[i] > 0.0 ? 1 : -1;
  return choice;
}

/// The T of a choice; false where V or T contradicts it.
bool solve_choice(const BoxFriction& p, const Choice& choice, Mobility::Vector& force) {
  Mobility::Vector answer{}, noise{};
  std::array<int, kSiteCount> held{};
  int count = 0;
  for (int i = 0; i < p.count; ++i) {
    if (choice[i] == 0) held[count++] = i;
    answer[i] = choice[i] * p.limit[i];
  }
  for (int i = 0; i < p.count; ++i) {
    noise[i] = std::abs(p.slip_free[i]);
    for (int j = 0; j < p.count; ++j) noise[i] += std::abs(p.mobility[i][j]) * p.limit[j];
    noise[i] *= kRounding;
  }
  Mobility::Matrix matrix{};
  Mobility::Vector rhs{}, held_noise{};
  for (int a = 0; a < count; ++a) {
    rhs[a] = -slip(p, held[a], answer);
    held_noise[a] = noise[held[a]];
    for (int b = 0; b < count; ++b) matrix[a][b] = p.mobility[held[a]][held[b]];
  }
  Mobility mobility;
  mobility.set(matrix, count, p.typical);
  const Mobility::Vector holding = mobility.hold(rhs, held_noise);
  for (int a = 0; a < count; ++a) answer[held[a]] = holding[a];
  for (int i = 0; i < p.count; ++i) {
    const double v = slip(p, i, answer);
    const bool fits =
        choice[i] == 0 ? std::abs(v) <= noise[i] && std::abs(answer[i]) <= p.limit[i] : v * choice[i] <= noise[i];
    if (!fits) return false;
  }
  force = answer;
  return true;
}

/// The next choice in a count to the base of three; false after the last.
bool next_choice(int count, Choice& choice) {
  for (int i = 0; i < count; ++i) {
    choice[i] = choice[i] == 0 ? 1 : choice[i] == 1 ? -1 : 0;
    if (choice[i] != 0) return true;
  }
  return false;
}

}  // namespace

Mobility::Vector solve_box_friction(const BoxFriction& problem) {
  Mobility::Vector force{};
  // one contact is solved by its first sweep
  for (int i = 0; i < (problem.count > 1 ? kSweeps : 1); ++i) sweep(problem, force);
  if (problem.count < 2) return force;
  // what has been guessed is nearly always right; else, from all that stick on, every choice
  if (solve_choice(problem, choice_of(problem, force), force)) return force;
  Choice choice{};
  do {
    if (solve_choice(problem, choice, force)) return force;
  } while (next_choice(problem.count, choice));
  return force;
}

}  // namespace vibratory_alignment
