// The axes of a part that moves freely, each an oscillator m q'' + h q' + k (q - anchor) = force: what does not change
// from flight to flight. Axis by axis, and as lanes of a Quad for the closed form of all at once (free_motion.h).
#pragma once

#include <array>

#include "mechanics/quad.h"
#include "mechanics/system.h"

namespace vibratory_alignment {

struct FreeAxes {
  /// Lanes of the axes; what is in the fourth stands still.
  static constexpr int kX = 0, kY = 1, kPhi = 2, kCount = 3;

  explicit FreeAxes(const System& system);

  /// With a = h/2m. Rates and roots are 1 per unit of time.
  struct Constants {
    double pull = 0.0, frequency = 0.0;            ///< k/m and its root
    double decay = 0.0, square = 0.0, root = 0.0;  ///< a, a^2 - k/m, and the root of the absolute value of that
    double slow = 0.0, fast = 0.0;                 ///< rates of the two exponentials of an overdamped axis
    double own_rate = 0.0;                         ///< its fastest rate
    bool apart = false;                            ///< far enough from critical damping to be bounded mode by mode
  };
  std::array<Constants, kCount> constants;

  // lanes: 0 where an axis does not move or is not of that kind
  Quad pull{}, decay{};
  Quad half_root{}, inverse_root{};    ///< underdamped: root/2, 1/root
  Quad between{}, inverse_between{};   ///< overdamped: 2 root, how far apart its rates are, and 1/2 root
  Quad critical{};                     ///< critically damped: 1
  Quad fall{}, slope_rate{};           ///< overdamped: slow and fast; else decay
  QuadMask modes{};                    ///< overdamped, apart
  Quad mode_rate{}, fast_mode_rate{};  ///< apart: frequency, or slow and fast
  Quad near{}, near_most{};            ///< not apart: 1, 1/2a
  bool any_underdamped = false, any_overdamped = false, any_near = false;

  double largest_half_root = 0.0;
  double fastest = 0.0;  ///< own rate of all

 private:
  void set(int i, const Axis& axis);
};

}  // namespace vibratory_alignment
