// Part of MotionSeries: the most frequent case, one contact that slides, in a loop of its own.
#include <cmath>

#include "solver/motion_series.h"

namespace vibratory_alignment {

/// The whole expansion for one contact that slides (or whose friction is regularised) on a base whose stiffness does
/// not turn: the same recurrences, in one loop.
template <bool kEdge, bool kTurns, bool kTanh>
void MotionSeries::expand_single_of(Segment& segment) {
  const Contact& contact = contacts_[0];
  ContactSeries& series = segment.loaded[0];
  PairSeries& point = points_[contact.point];
  const int order = segment.order;
  const ContactFrame& f = contact.frame;
  const double side = side_of(contact.site), l = side * system_.slot_half_width, beta = side * system_.half_width,
               b0 = system_.base_distance;
  const Pair depth_row(f.sign * f.n1, f.sign * f.n2), slip_row(-f.sign * f.t1(), -f.sign * f.t2());
  const Pair force_row(contact.force1, contact.force2), moment_row(contact.force2, -contact.force1),
      crossed_row(-contact.force2, contact.force1);
  const Pair drag_row(f.t1(), f.t2()), drag_moment_row(f.t2(), -f.t1()), drag_crossed_row(-f.t2(), f.t1());
  const double fast_x = system_.x.inverse_inertia, fast_y = system_.y.inverse_inertia,
               fast_phi = system_.phi.inverse_inertia, eps = system_.regularization;
  PairSeries push, drag;
  Series push_moment, drag_moment, tanh, sech2;
  for (int k = -1; k < order + 1; ++k) {
    // direction, point and depth of power k + 1
    if (k >= 0) {
      Pair turn(0.0, 0.0);
      if (kTurns) turn = product_term(direction_, segment.omega, k) * kInverse[k + 1];
      direction_[k + 1] = Pair(-turn[1], turn[0]);
      mirrored_[k + 1] = Pair(-turn[1], -turn[0]);
      swapped_[k + 1] = Pair(turn[0], -turn[1]);
      segment.cos_phi[k + 1] = -turn[1];
      segment.sin_phi[k + 1] = turn[0];
    }
    const int n = k + 1;
    const Pair& d = direction_[n];
    if (kEdge) {
      Pair along = segment.x[n] * mirrored_[0], across = segment.y[n] * swapped_[0];
      if (kTurns)
        for (int j = 0; j < n; ++j) {
          along += segment.x[j] * mirrored_[n - j];
          across += segment.y[j] * swapped_[n - j];
        }
      centre_[n] = along + across;
      point[n] = l * mirrored_[n] - centre_[n];
    } else {
      point[n] = Pair(segment.x[n] + beta * d[0] + b0 * d[1], segment.y[n] + beta * d[1] - b0 * d[0]);
    }
    series.depth[n] = (depth_row * point[n]).sum();
    if (k < 0) {
      series.depth[0] += f.offset;
      continue;
    }
    // forces of power k
    const double normal = contact.stiffness * series.depth[k] + contact.damping * n * series.depth[n];
    series.normal_force[k] = normal;
    series.slip_velocity[k] = n * (slip_row * point[n]).sum();
    const Pair lever =
        kEdge ? point[k]
              : Pair(beta * direction_[k][0] + b0 * direction_[k][1], beta * direction_[k][1] - b0 * direction_[k][0]);
    push_moment[k] = (moment_row * lever).sum();
    if (kEdge) push[k] = force_row[0] * direction_[k] + force_row[1] * Pair(-direction_[k][1], direction_[k][0]);
    Pair force;
    double moment = 0.0;
    if (kEdge && kTurns)
      force = product_term(push, series.normal_force, k);
    else
      force = normal * (kEdge ? push[0] : force_row);
    if (kTurns) moment = product_term(push_moment, series.normal_force, k);
    if (kTanh) {
      if (k == 0) {
        tanh[0] = std::tanh(series.slip_velocity[0] / eps);
      } else {
        double z = 0.0;
        for (int j = 0; j < k; ++j) z += (j + 1) * series.slip_velocity[j + 1] * sech2[k - 1 - j];
        tanh[k] = z * kInverse[k] / eps;
      }
      sech2[k] = (k == 0 ? 1.0 : 0.0) - product_term(tanh, tanh, k);
      series.tangential_force[k] = -system_.friction * product_term(series.normal_force, tanh, k);
      drag_moment[k] = (drag_moment_row * lever).sum();
      if (kEdge) drag[k] = drag_row[0] * direction_[k] + drag_row[1] * Pair(-direction_[k][1], direction_[k][0]);
      if (kEdge && kTurns)
        force += product_term(drag, series.tangential_force, k);
      else
        force += series.tangential_force[k] * (kEdge ? drag[0] : drag_row);
      if (kTurns) moment += product_term(drag_moment, series.tangential_force, k);
    } else {
      series.tangential_force[k] = contact.ratio * normal;
    }
    if (k == order) break;
    // velocity of power k + 1, position of power k + 2
    const double dx = k == 0 ? segment.x[0] - system_.x.anchor : segment.x[k];
    const double dy = k == 0 ? segment.y[0] - system_.y.anchor : segment.y[k];
    const double weight = k == 0 ? system_.weight : 0.0;
    const double inverse = kInverse[n], next_inverse = kInverse[n + 1];
    segment.vx[n] = fast_x * inverse *
                    (segment.drive_x[k] + force[0] - system_.x.damping * segment.vx[k] - system_.x.stiffness * dx);
    segment.vy[n] =
        fast_y * inverse *
        (segment.drive_y[k] + force[1] - weight - system_.y.damping * segment.vy[k] - system_.y.stiffness * dy);
    segment.x[n + 1] = segment.vx[n] * next_inverse;
    segment.y[n + 1] = segment.vy[n] * next_inverse;
    if (kTurns) {
      const double dphi = k == 0 ? segment.phi[0] - system_.phi.anchor : segment.phi[k];
      segment.omega[n] =
          fast_phi * inverse *
          (segment.drive_phi[k] + moment - system_.phi.damping * segment.omega[k] - system_.phi.stiffness * dphi);
      segment.phi[n + 1] = segment.omega[n] * next_inverse;
    } else {
      segment.omega[n] = segment.phi[n + 1] = 0.0;
    }
  }
  known_trig_ = order + 1;
  known_point_[contact.point] = order + 1;
  if (kEdge) known_centre_ = order + 1;
}

void MotionSeries::expand_single(Segment& segment) {
  const bool edge = is_edge(contacts_[0].site), turns = system_.phi.moves, tanh = contacts_[0].separate_t;
  if (edge)
    turns ? (tanh ? expand_single_of<true, true, true>(segment) : expand_single_of<true, true, false>(segment))
          : (tanh ? expand_single_of<true, false, true>(segment) : expand_single_of<true, false, false>(segment));
  else
    turns ? (tanh ? expand_single_of<false, true, true>(segment) : expand_single_of<false, true, false>(segment))
          : (tanh ? expand_single_of<false, false, true>(segment) : expand_single_of<false, false, false>(segment));
}

}  // namespace vibratory_alignment
