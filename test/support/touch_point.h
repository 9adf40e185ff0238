// A possible contact of one site with one face: where it is, how deep, how fast, and what the base answers. Written
// once more from MODEL.md "Contact", so that tests do not ask the code that they judge.
#pragma once

#include <cmath>

#include "mechanics/contact.h"
#include "mechanics/state.h"
#include "mechanics/system.h"

namespace vibratory_alignment::test {

struct Touch {
  Site site;
  Face face;
};

/// One contact in world axes: normal n, tangent t = (n_y, -n_x), lever r from the mass centre.
struct TouchPoint {
  double nx, ny, tx, ty, rx, ry, depth, depth_rate, slip, stiffness, damping;
  double normal_force;  ///< k d + h d', below zero where the base would pull

  double normal_moment() const { return rx * ny - ry * nx; }
  double tangent_moment() const { return rx * ty - ry * tx; }
};

inline TouchPoint touch_point(const System& s, const State& q, const Touch& touch) {
  const double cosine = std::cos(q.phi), sine = std::sin(q.phi),
               side = static_cast<int>(touch.site) % 2 == 0 ? 1.0 : -1.0;
  TouchPoint p{};
  if (touch.site == Site::a1 || touch.site == Site::a2) {
    p.rx = side * s.slot_half_width - q.x;
    p.ry = -q.y;
    const double along = p.rx * cosine + p.ry * sine, up = p.ry * cosine - p.rx * sine;
    const double way = touch.face == Face::right_side ? -1.0 : 1.0;
    const bool bottom = touch.face == Face::bottom;
    p.nx = bottom ? -sine : way * cosine;
    p.ny = bottom ? cosine : way * sine;
    p.depth = bottom ? up + s.base_distance : s.half_width + way * along;
  } else {
    p.rx = side * s.half_width * cosine + s.base_distance * sine;
    p.ry = side * s.half_width * sine - s.base_distance * cosine;
    p.nx = touch.face == Face::right_wall ? -1.0 : touch.face == Face::left_wall ? 1.0 : 0.0;
    p.ny = p.nx == 0.0 ? 1.0 : 0.0;
    const double surface = p.nx != 0.0 ? -s.slot_half_width : touch.face == Face::floor ? -s.floor_depth : 0.0;
    p.depth = surface - p.nx * (q.x + p.rx) - p.ny * (q.y + p.ry);
  }
  p.tx = p.ny;
  p.ty = -p.nx;
  const double vx = q.vx - q.omega * p.ry, vy = q.vy + q.omega * p.rx;
  p.depth_rate = -(vx * p.nx + vy * p.ny);
  p.slip = vx * p.tx + vy * p.ty;
  p.stiffness = s.stiffness_y * p.ny * p.ny + s.stiffness_x * p.nx * p.nx;
  p.damping = s.damping_y * p.ny * p.ny + s.damping_x * p.nx * p.nx;
  p.normal_force = p.stiffness * p.depth + p.damping * p.depth_rate;
  return p;
}

}  // namespace vibratory_alignment::test
