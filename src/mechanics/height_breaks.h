// The heights between which nothing changes about which faces of the base a part at rest would touch.
#pragma once

#include <array>
#include <cstddef>

#include "mechanics/site_rules.h"

namespace vibratory_alignment {

/// Heights y, at the given x and phi, at which a site meets or leaves the other body, or another face becomes the
/// nearest: between two of them all depths are linear in y and no contact changes.
class HeightBreaks {
 public:
  HeightBreaks(const System& system, double x, double phi);

  /// The highest one below y; -infinity: none.
  double below(double y) const;

 private:
  void add_all_of(const Region& region, const Vec2& p, const Vec2& rate);
  void add(double height);

  std::array<double, 32> heights_;  // of 6 for an edge, 3 for each half of a corner, 1 for the floor below it
  std::size_t count_ = 0;
};

}  // namespace vibratory_alignment
