// Where the part and the base can touch, and what state each such place is in.
//
//   site      point that touches                 faces it can touch
//   a1, a2    edges of the slot (+l,0), (-l,0)   bottom, right side, left side of the part
//   b1, b2    lower corners of the part          top surface, wall of the slot
//   b1_floor, b2_floor   the same corners        floor of the slot (a corner can touch wall and floor at once)
#pragma once

#include <array>
#include <cstdint>

namespace vibratory_alignment {

// One byte each: the states of all contacts are copied in every step.
enum class Site : std::uint8_t { a1, a2, b1, b2, b1_floor, b2_floor };
constexpr int kSiteCount = 6;

enum class Face : std::uint8_t { none, bottom, right_side, left_side, top, right_wall, left_wall, floor };

/// outside: the point is not in the other body. unloaded: the contact lasts (depth > 0) but carries no force.
/// loaded: N > 0. free: inside the other body without contact (entered through a face the scene does not call for).
enum class Phase : std::uint8_t { outside, unloaded, loaded, free };

/// Sliding direction of a loaded contact, the sign of V; `none` without friction, `regularized` for the tanh law.
enum class Slip : std::uint8_t { none, plus, minus, stick, regularized };

struct ContactState {
  Phase phase = Phase::outside;
  Face face = Face::none;
  Slip slip = Slip::none;

  bool touching() const { return phase == Phase::loaded || phase == Phase::unloaded; }
  /// Touches a wall: a corner that does is between the walls, in which it presses a dent.
  bool on_wall() const { return touching() && (face == Face::right_wall || face == Face::left_wall); }
};

using ContactStates = std::array<ContactState, kSiteCount>;

}  // namespace vibratory_alignment
