// Part of MotionSeries: what one power adds, for the loops over powers to take in whatever they are compiled for.
#pragma once

#include <cmath>

#include "solver/motion_series.h"

namespace vibratory_alignment {

/// Velocity of power k + 1 and position of power k + 2 from the forces of power k.
VIBRATORY_ALIGNMENT_INLINE void MotionSeries::accelerate(int k, const Quad& load, Segment& segment) const {
  const double inverse = kInverse[k + 1], next_inverse = kInverse[k + 2];
  const auto axis_term = [&](const Axis& axis, double force, Series& q, Series& v) VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    const double stretch = k == 0 ? q[0] - axis.anchor : q[k];
    v[k + 1] = axis.inverse_inertia * (force - axis.damping * v[k] - axis.stiffness * stretch) * inverse;
    q[k + 2] = v[k + 1] * next_inverse;
  };
  const double weight = k == 0 ? system_.weight : 0.0;
  axis_term(system_.x, segment.drive_x[k] + load[0], segment.x, segment.vx);
  axis_term(system_.y, segment.drive_y[k] + load[1] - weight, segment.y, segment.vy);
  axis_term(system_.phi, segment.drive_phi[k] + load[2], segment.phi, segment.omega);
}

VIBRATORY_ALIGNMENT_INLINE void MotionSeries::trig_term(int k, Segment& segment) {
  // (c, s)' = omega (-s, c)
  double c = 0.0, s = 0.0;
  if (system_.phi.moves) {
    const Pair product = product_term(direction_, segment.omega, k - 1) * kInverse[k];
    c = -product[1];
    s = product[0];
  }
  direction_[k] = Pair{c, s};
  segment.cos_phi[k] = c;
  segment.sin_phi[k] = s;
}

/// (x c + y s, y c - x s), power k.
VIBRATORY_ALIGNMENT_INLINE void MotionSeries::centre_term(int k, const Segment& segment) {
  known_centre_ = k;
  Pair along{}, across{};
  if (k == 0 || !system_.phi.moves) {
    along = segment.x[k] * direction_[0];
    across = segment.y[k] * direction_[0];
  } else {
    along = product_term(direction_, segment.x, k);
    across = product_term(direction_, segment.y, k);
  }
  centre_[k] = Pair{along[0] + across[1], across[0] - along[1]};
}

VIBRATORY_ALIGNMENT_INLINE void MotionSeries::point_term(int point, int k, const Segment& segment) {
  known_point_[point] = k;
  const Pair& d = direction_[k];
  const double side = point % 2 == 0 ? 1.0 : -1.0;
  if (point >= 2) {
    const double beta = side * system_.half_width, b = system_.base_distance;
    points_[point][k] = Pair{segment.x[k] + beta * d[0] + b * d[1], segment.y[k] + beta * d[1] - b * d[0]};
    return;
  }
  if (known_centre_ < k) centre_term(k, segment);
  const double l = side * system_.slot_half_width;
  points_[point][k] = Pair{l * d[0] - centre_[k][0], -l * d[1] - centre_[k][1]};
}

/// Forces and moments per unit of N and of T, power k: sliding contacts take N and T together.
VIBRATORY_ALIGNMENT_INLINE void MotionSeries::direction_terms(Contact& contact, int k) const {
  const ContactFrame& f = contact.frame;
  const Pair& d = direction_[k];
  const bool is_on_part = is_edge(contact.site);
  // arm of the moment in the axes of the frame: the point's coordinates, or those of a corner seen from C
  Pair arm = points_[contact.point][k];
  if (!is_on_part) {
    const double beta = side_of(contact.site) * system_.half_width;
    arm = beta * d + Pair{system_.base_distance, -system_.base_distance} * swapped(d);
  }
  // components (a, b): along (c, s) and (-s, c) where the frame is the part's
  const auto set_force = [&](QuadSeries& forces, double a, double b) VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    const Pair world = is_on_part ? a * d + Pair{-b, b} * swapped(d) : k == 0 ? Pair{a, b} : Pair{};
    forces[k] = Quad{world[0], world[1], b * arm[0] - a * arm[1], 0.0};
  };
  set_force(contact.push, contact.force1, contact.force2);
  if (contact.separate_t) set_force(contact.drag, f.t1(), f.t2());
}

/// What a k(n) and h(n) that change with cos^2 phi add to N of power k, depth and its rate of this power given.
VIBRATORY_ALIGNMENT_INLINE double MotionSeries::push_of_turning(Contact& contact, int k, double depth,
                                                                double depth_rate) {
  const double level = contact.face == Face::bottom ? 1.0 : -1.0;
  const double growth = level * ((system_.stiffness_y - system_.stiffness_x) * depth +
                                 (system_.damping_y - system_.damping_x) * depth_rate);
  const double c = direction_[k][0];
  contact.growth[k] = Pair{c, growth};
  if (k == 0) {
    contact.square[0] = Pair{c, 0.0};  // what it adds at power 0 is in the contact's own k and h
    return 0.0;
  }
  // the two products, but for their terms in powers 0 and k
  Pair sum{};
  add_inner_product_term(contact.square, contact.growth, k, sum);
  const double square = sum[0] + 2.0 * direction_[0][0] * c;
  contact.square[k] = Pair{c, square};
  return sum[1] + square * contact.growth[0][1];
}

/// T = -f N z of power k, z = tanh(V/eps): z' = (1 - z^2) V'/eps.
VIBRATORY_ALIGNMENT_INLINE void MotionSeries::tanh_term(Contact& contact, int k, ContactSeries& series) const {
  const double eps = system_.regularization;
  const double v = series.slip_velocity[k], n = series.normal_force[k];
  if (k == 0) {
    const double tanh = std::tanh(v / eps);
    contact.layer[0] = Quad{tanh, tanh, tanh * tanh, 0.0};
    contact.layer_by[0] = Quad{tanh, n, 0.0, 0.0};
    series.tangential_force[0] = -system_.friction * n * tanh;
    return;
  }
  // z^2, N z and z^2 V' of the power before, but for their terms in powers 0 and k
  Quad sum{};
  add_inner_product_term(contact.layer, contact.layer_by, k, sum);
  const double tanh_0 = contact.layer[0][0], n_0 = contact.layer_by[0][1], rate = k * v;
  const double tanh = ((1.0 - contact.layer[0][2]) * rate - sum[2]) / (k * eps);
  contact.layer[k] = Quad{tanh, tanh, sum[0] + 2.0 * tanh_0 * tanh, 0.0};
  contact.layer_by[k] = Quad{tanh, n, rate, 0.0};
  series.tangential_force[k] = -system_.friction * (sum[1] + n_0 * tanh + n * tanh_0);
}

/// Depth (power k + 1), N, V and T (power k) of a contact whose point is known to power k + 1. T of what sticks stays
/// 0.
VIBRATORY_ALIGNMENT_INLINE void MotionSeries::force_term(Contact& contact, int k, ContactSeries& series) {
  const ContactFrame& f = contact.frame;
  const Pair& p = points_[contact.point][k + 1];
  const double depth = f.sign * (f.n1 * p[0] + f.n2 * p[1]);
  const double depth_rate = (k + 1) * depth;
  series.depth[k + 1] = depth;
  series.slip_velocity[k] = -f.sign * (k + 1) * (f.t1() * p[0] + f.t2() * p[1]);
  double push = contact.stiffness * series.depth[k] + contact.damping * depth_rate;
  if (contact.turning) push += push_of_turning(contact, k, series.depth[k], depth_rate);
  series.normal_force[k] = push;
  series.tangential_force[k] = contact.ratio * push;
  if (contact.slip == Slip::regularized) tanh_term(contact, k, series);
  direction_terms(contact, k);
}

/// Adds force and moment (x, y, phi, 0) of all contacts, power k. What holds a sticking contact is zero in this power
/// as yet. Each contact's are a sum of their own: those of a symmetric part take each other away to the last digit; and
/// so are those of a pair, which the mirror image adds up the other way.
VIBRATORY_ALIGNMENT_INLINE void MotionSeries::add_contact_load(int k, const Segment& segment, Quad& load) const {
  const auto add_load_of = [&](int i, Quad& own) VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    const Contact& contact = contacts_[i];
    const ContactSeries& series = segment.loaded[i];
    add_product_term(contact.push, series.normal_force, k, own);
    if (contact.separate_t) add_product_term(contact.drag, series.tangential_force, k, own);
  };
  for (int i = 0; i < segment.loaded_count; ++i) {
    Quad own{}, of_other{};
    add_load_of(i, own);
    const bool is_pair = i + 1 < segment.loaded_count && side_of(contacts_[i].site) > 0.0 &&
                         static_cast<int>(contacts_[i + 1].site) == static_cast<int>(contacts_[i].site) + 1;
    if (is_pair) add_load_of(++i, of_other);
    own += of_other;
    load += own;
  }
}

}  // namespace vibratory_alignment
