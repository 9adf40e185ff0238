#include "solver/held_state.h"

#include <cmath>

#include "mechanics/contact_frame.h"
#include "mechanics/holding_forces.h"

namespace vibratory_alignment {
namespace {

/// Rounding of V relative to the speeds that it is made of: left where contacts (nearly) hold the same motion.
constexpr double kSpeedRounding = 1e-15;

/// Of the part's speed: more than this is no last digit, though contacts of nearly the same lever make it of theirs.
constexpr double kMostTakenOut = 1e-6;

double reach_of(const Vec2& lever) { return std::abs(lever.x) + std::abs(lever.y); }

}  // namespace

State take_out_slip(const System& system, const State& state, const ContactStates& contacts) {
  std::array<ContactKinematics, kSiteCount> held;
  int count = 0;
  for (std::size_t i = 0; i < kSiteCount; ++i)
    if (contacts[i].slip == Slip::stick)
      held[count++] = contact_kinematics(system, state, static_cast<Site>(i), contacts[i].face);
  HoldingForces::Rows rows;
  HoldingForces::Vector rhs{}, noise{};
  for (int i = 0; i < count; ++i) {
    rows[i] = {held[i].tangent.x, held[i].tangent.y, cross(held[i].lever, held[i].tangent)};
    rhs[i] = -held[i].slip_velocity;
    const double speed = std::abs(state.vx) + std::abs(state.vy) + std::abs(state.omega) * reach_of(held[i].lever);
    noise[i] = kSpeedRounding * speed;
  }
  HoldingForces impulse;
  impulse.set(system, rows, count);
  HoldingForces::Answer change = impulse.hold(rhs, noise);
  const double reach = system.half_width + system.base_distance;
  const auto size = [&](double x, double y, double phi) { return std::abs(x) + std::abs(y) + std::abs(phi) * reach; };
  // what the contacts have in common only: V of two that have begun to part is not of last digits
  if (change.told_apart &&
      size(change.x, change.y, change.phi) > kMostTakenOut * size(state.vx, state.vy, state.omega)) {
    noise.fill(INFINITY);
    change = impulse.hold(rhs, noise);
  }
  State result = state;
  result.vx += change.x;
  result.vy += change.y;
  result.omega += change.phi;
  return result;
}

}  // namespace vibratory_alignment
