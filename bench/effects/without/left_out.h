// Members that a build without an effect has in the place of the scene's: known to the compiler, so that it drops all
// that depends on them. A value that would call for the effect is refused.
#pragma once

#include <stdexcept>

namespace vibratory_alignment {

/// In the place of a bool or a number that is always `value`.
template <typename T, int value>
struct Fixed {
  constexpr operator T() const { return T(value); }
  const Fixed& operator=(T given) const {
    if (given != T(value)) throw std::logic_error("this build is without an effect that the scene calls for");
    return *this;
  }
};
inline constexpr Fixed<bool, 0> kFixedFalse{};
inline constexpr Fixed<bool, 1> kFixedTrue{};
inline constexpr Fixed<double, 0> kFixedZero{};

/// In the place of an axis that never moves.
template <typename Axis>
struct LockedAxis : Axis {
  static constexpr bool moves = false;
  static constexpr double inverse_inertia = 0.0;
  LockedAxis& operator=(const Axis& axis) {
    Axis::operator=(axis);
    if (axis.moves) throw std::logic_error("this build is without an axis that the scene calls for");
    return *this;
  }
};

/// In the place of the contact features.
template <typename ContactFeatures, bool corners_allowed>
struct SomeFeatures {
  bool edges = false;
  std::conditional_t<corners_allowed, bool, const Fixed<bool, 0>> corners{};
  static constexpr Fixed<bool, 0> walls{};
  SomeFeatures& operator=(const ContactFeatures& given) {
    edges = given.edges;
    corners = given.corners;
    walls = given.walls;
    return *this;
  }
};

}  // namespace vibratory_alignment
