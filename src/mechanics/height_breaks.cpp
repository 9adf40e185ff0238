#include "mechanics/height_breaks.h"

#include <algorithm>
#include <cmath>

#include "mechanics/contact_frame.h"
#include "mechanics/tilt.h"

namespace vibratory_alignment {

HeightBreaks::HeightBreaks(const System& system, double x, double phi) {
  const Tilt tilt = tilt_of(phi);
  State level;
  level.x = x;
  level.phi = phi;
  for (int i = 0; i < site_end(system); ++i) {
    const auto site = static_cast<Site>(i);
    if (!site_in_use(system, site)) continue;
    const Vec2 p = site_point(system, level, site, tilt.cos, tilt.sin),
               rate = is_edge(site) ? Vec2{-tilt.sin, -tilt.cos} : Vec2{0.0, 1.0};
    for (int half = 0; half < region_count(site); ++half) add_all_of(site_region(system, site, half), p, rate);
  }
}

double HeightBreaks::below(double y) const {
  double highest = -INFINITY;
  for (std::size_t i = 0; i < count_; ++i)
    if (heights_[i] < y) highest = std::max(highest, heights_[i]);
  return highest;
}

/// Where one of its conditions begins to hold, or two are the same. p: the point at y = 0, and its rate with y.
void HeightBreaks::add_all_of(const Region& region, const Vec2& p, const Vec2& rate) {
  for (int i = 0; i < region.count; ++i) {
    const RegionCondition& one = region.conditions[i];
    const double value = one.value(p), slope = one.c1 * rate.x + one.c2 * rate.y;
    add(-value / slope);
    for (int j = 0; j < i; ++j) {
      const RegionCondition& other = region.conditions[j];
      add((other.value(p) - value) / (slope - other.c1 * rate.x - other.c2 * rate.y));
    }
  }
}

/// Faces that are upright have none.
void HeightBreaks::add(double height) {
  if (std::isfinite(height)) heights_[count_++] = height;
}

}  // namespace vibratory_alignment
