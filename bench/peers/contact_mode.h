// The events that end a mode, as root functions, and what follows from each.
//
// Two guards an edge; every guard is an event when it rises through zero:
//   guard 2 e      of edge e: flight -> touch,    inside of the part: the least of the depths below its three faces
//                             contact -> release, minus that: the depth is closed or the foot has run off its face
//   guard 2 e + 1  of edge e: loaded -> unload,   minus the push: N = 0 is reached, the base is left with d > 0
//                             unloaded -> reload, the push
//                             flight: not in use, -1
#pragma once

#include <algorithm>
#include <array>

#include "right_hand_side.h"

namespace vibratory_alignment::peers {

constexpr int guard_count = 4;
using Guards = std::array<double, guard_count>;

// Depths of an edge below the faces of the part.
struct Depths {
  double bottom, right, left;

  Depths(const Parameters& p, const double* s, const Tilt& tilt, int edge) {
    const Vec2 r = lever(p, s, edge);
    const double along = r.x * tilt.cos + r.y * tilt.sin;
    bottom = p.b - r.x * tilt.sin + r.y * tilt.cos;
    right = p.a - along;
    left = p.a + along;
  }
  double inside() const { return std::min(bottom, std::min(right, left)); }
  Face nearest_face() const {
    if (bottom <= right && bottom <= left) return Face::bottom;
    return right <= left ? Face::right : Face::left;
  }
};

inline void guards(const Parameters& p, const Mode& mode, const double* s, double* values) {
  const Tilt tilt(s[2]);
  for (int edge = 0; edge < 2; ++edge) {
    const EdgeMode& m = mode[static_cast<std::size_t>(edge)];
    const double inside = Depths(p, s, tilt, edge).inside();
    if (m.face == Face::none) {
      values[2 * edge] = inside;
      values[2 * edge + 1] = -1.0;
    } else {
      const double push = contact_at(p, s, tilt, edge, m.face).push;
      values[2 * edge] = -inside;
      values[2 * edge + 1] = m.loaded ? -push : push;
    }
  }
}

// The mode after `guard` was an event.
inline void transition(const Parameters& p, int guard, const double* s, Mode& mode) {
  const int edge = guard / 2;
  EdgeMode& m = mode[static_cast<std::size_t>(edge)];
  if (guard % 2 == 1) {
    m.loaded = m.face != Face::none && !m.loaded;
  } else if (m.face != Face::none) {
    m = EdgeMode{};
  } else {
    m = EdgeMode{Depths(p, s, Tilt(s[2]), edge).nearest_face(), true};
  }
}

// The mode of a start: an edge inside the part touches the nearest face.
inline Mode mode_of_start(const Parameters& p, const double* s) {
  const Tilt tilt(s[2]);
  Mode mode;
  for (int edge = 0; edge < 2; ++edge) {
    const Depths depths(p, s, tilt, edge);
    if (depths.inside() <= 0.0) continue;
    const Face face = depths.nearest_face();
    mode[static_cast<std::size_t>(edge)] = EdgeMode{face, contact_at(p, s, tilt, edge, face).push > 0.0};
  }
  return mode;
}

}  // namespace vibratory_alignment::peers
