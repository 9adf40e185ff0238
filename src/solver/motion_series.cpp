#include "solver/motion_series.h"

#include <algorithm>
#include <cmath>

#include "mechanics/tilt.h"
#include "solver/turning_face.h"

namespace vibratory_alignment {
namespace {

int point_index(Site site) { return (is_edge(site) ? 0 : 2) + pair_index(site); }

/// k(n) d + h(n) d', power k.
double turning_push(const Series& stiffness, const Series& damping, const Series& depth, int k) {
  double n = 0.0;
  for (int j = 0; j <= k; ++j) n += stiffness[j] * depth[k - j] + damping[j] * (k - j + 1) * depth[k - j + 1];
  return n;
}

}  // namespace

/// Direction of power 0; nothing else is known.
void MotionSeries::restart(int order, Segment& segment) {
  order_ = order;
  segment.order = order;
  const auto [c, s] = tilt_of(segment.phi[0]);
  segment.cos_phi[0] = c;
  segment.sin_phi[0] = s;
  direction_[0] = Pair{c, s};
  known_trig_ = 0;
  known_centre_ = -1;
  known_point_.fill(-1);
  sticking_count_ = 0;
  not_held_.fill(0.0);
}

void MotionSeries::adopt(Segment& segment) { restart(segment.order, segment); }

void MotionSeries::start(const State& start, const DriveForms& drives, int order, Segment& segment) {
  segment.x[0] = start.x;
  segment.y[0] = start.y;
  segment.phi[0] = start.phi;
  segment.x[1] = segment.vx[0] = start.vx;
  segment.y[1] = segment.vy[0] = start.vy;
  segment.phi[1] = segment.omega[0] = start.omega;
  restart(order, segment);
  drive_series_.begin(drives);
  drive_series_.extend(order, segment);
}

/// Velocity of power k + 1 and position of power k + 2 from the forces of power k.
void MotionSeries::accelerate(int k, const Load& load, Segment& segment) const {
  const double inverse = kInverse[k + 1], next_inverse = kInverse[k + 2];
  const auto axis_term = [&](const Axis& axis, double force, Series& q, Series& v) {
    const double stretch = k == 0 ? q[0] - axis.anchor : q[k];
    v[k + 1] = axis.inverse_inertia * (force - axis.damping * v[k] - axis.stiffness * stretch) * inverse;
    q[k + 2] = v[k + 1] * next_inverse;
  };
  const double weight = k == 0 ? system_.weight : 0.0;
  axis_term(system_.x, segment.drive_x[k] + load.force[0], segment.x, segment.vx);
  axis_term(system_.y, segment.drive_y[k] + load.force[1] - weight, segment.y, segment.vy);
  axis_term(system_.phi, segment.drive_phi[k] + load.moment, segment.phi, segment.omega);
}

void MotionSeries::expand_free(const State& start, const DriveForms& drives, int order, Segment& segment) {
  this->start(start, drives, order, segment);
  segment.loaded_count = 0;
  for (int k = 0; k < order; ++k) accelerate(k, Load{}, segment);
}

void MotionSeries::trig_term(int k, Segment& segment) {
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
void MotionSeries::centre_term(int k, const Segment& segment) {
  known_centre_ = k;
  Pair along = segment.x[k] * direction_[0], across = segment.y[k] * direction_[0];
  if (system_.phi.moves)
    for (int j = 0; j < k; ++j) {
      along += segment.x[j] * direction_[k - j];
      across += segment.y[j] * direction_[k - j];
    }
  centre_[k] = Pair{along[0] + across[1], across[0] - along[1]};
}

void MotionSeries::point_term(int point, int k, const Segment& segment) {
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

const PairSeries& MotionSeries::point(Site site, Segment& segment) {
  direction(segment);
  const int index = point_index(site);
  while (known_point_[index] < order_) point_term(index, known_point_[index] + 1, segment);
  return points_[index];
}

const PairSeries& MotionSeries::direction(Segment& segment) {
  while (known_trig_ < order_) trig_term(++known_trig_, segment);
  return direction_;
}

void MotionSeries::set_up_contacts(Segment& segment) {
  segment.loaded_count = 0;
  for (int i = 0; i < kSiteCount; ++i) {
    const ContactState& state = segment.contacts[i];
    if (state.phase != Phase::loaded) continue;
    const int index = segment.loaded_count++;
    segment.loaded[index].site = static_cast<Site>(i);
    Contact& contact = contacts_[index];
    contact.site = static_cast<Site>(i);
    contact.face = state.face;
    contact.slip = state.slip;
    contact.frame = contact_frame(system_, state.face);
    contact.separate_t = state.slip == Slip::stick || state.slip == Slip::regularized;
    contact.ratio = state.slip == Slip::plus ? -system_.friction : state.slip == Slip::minus ? system_.friction : 0.0;
    contact.point = point_index(contact.site);
    contact.force1 = contact.frame.n1 + contact.ratio * contact.frame.t1();
    contact.force2 = contact.frame.n2 + contact.ratio * contact.frame.t2();
    contact.turning = is_edge(contact.site) && !system_.isotropic && system_.phi.moves;
    contact.stiffness = stiffness_of(system_, state.face, segment.cos_phi[0], segment.sin_phi[0]);
    contact.damping = damping_of(system_, state.face, segment.cos_phi[0], segment.sin_phi[0]);
    if (state.slip == Slip::stick) sticking_[sticking_count_++] = index;
  }
}

void MotionSeries::push_series(const Segment& segment, Face face, const Series& depth, Series& push) const {
  if (is_part_face(face) && !system_.isotropic) {
    Series stiffness, damping;
    for (int k = 0; k < segment.order; ++k) {
      turning_term(system_, face, k, segment, stiffness[k], damping[k]);
      push[k] = turning_push(stiffness, damping, depth, k);
    }
    return;
  }
  const double stiffness = stiffness_of(system_, face, segment.cos_phi[0], segment.sin_phi[0]);
  const double damping = damping_of(system_, face, segment.cos_phi[0], segment.sin_phi[0]);
  for (int k = 0; k < segment.order; ++k) push[k] = stiffness * depth[k] + damping * (k + 1) * depth[k + 1];
}

/// Directions in which a contact's forces act, power k: sliding contacts take N and T together.
void MotionSeries::direction_terms(Contact& contact, int k) const {
  const ContactFrame& f = contact.frame;
  const Pair& d = direction_[k];
  if (is_edge(contact.site)) {
    // body components (a, b): world a (c, s) + b (-s, c), moment b u - a w
    const Pair& p = points_[contact.point][k];
    const auto force = [&](double a, double b) { return Pair{a * d[0] - b * d[1], a * d[1] + b * d[0]}; };
    contact.push[k] = force(contact.force1, contact.force2);
    contact.push_moment[k] = contact.force2 * p[0] - contact.force1 * p[1];
    if (!contact.separate_t) return;
    contact.drag[k] = force(f.t1(), f.t2());
    contact.drag_moment[k] = f.t2() * p[0] - f.t1() * p[1];
  } else {
    // world components (a, b), moment b r_x - a r_y
    const double beta = side_of(contact.site) * system_.half_width, b0 = system_.base_distance;
    const double rx = beta * d[0] + b0 * d[1], ry = beta * d[1] - b0 * d[0], one = k == 0 ? 1.0 : 0.0;
    contact.push[k] = Pair{contact.force1 * one, contact.force2 * one};
    contact.push_moment[k] = contact.force2 * rx - contact.force1 * ry;
    if (!contact.separate_t) return;
    contact.drag[k] = Pair{f.t1() * one, f.t2() * one};
    contact.drag_moment[k] = f.t2() * rx - f.t1() * ry;
  }
}

/// T = -f N z of power k, z = tanh(V/eps): z' = (1 - z^2) V'/eps.
void MotionSeries::tanh_term(Contact& contact, int k, ContactSeries& series) const {
  const double eps = system_.regularization;
  if (k == 0) {
    contact.tanh[0] = std::tanh(series.slip_velocity[0] / eps);
  } else {
    double z = 0.0;
    for (int j = 0; j < k; ++j) z += (j + 1) * series.slip_velocity[j + 1] * contact.sech2[k - 1 - j];
    contact.tanh[k] = z / (k * eps);
  }
  contact.sech2[k] = (k == 0 ? 1.0 : 0.0) - product_term(contact.tanh, contact.tanh, k);
  series.tangential_force[k] = -system_.friction * product_term(series.normal_force, contact.tanh, k);
}

/// Depth (power k + 1), N, V and T (power k) of a contact whose point is known to power k + 1. T of what sticks stays
/// 0.
void MotionSeries::force_term(Contact& contact, int k, ContactSeries& series, const Segment& segment) {
  const ContactFrame& f = contact.frame;
  const Pair& p = points_[contact.point][k + 1];
  const double depth = f.sign * (f.n1 * p[0] + f.n2 * p[1]);
  const double depth_rate = (k + 1) * depth;
  series.depth[k + 1] = depth;
  series.slip_velocity[k] = -f.sign * (k + 1) * (f.t1() * p[0] + f.t2() * p[1]);
  if (contact.turning) {
    turning_term(system_, contact.face, k, segment, contact.k[k], contact.h[k]);
    series.normal_force[k] = turning_push(contact.k, contact.h, series.depth, k);
  } else {
    series.normal_force[k] = contact.stiffness * series.depth[k] + contact.damping * depth_rate;
  }
  series.tangential_force[k] = contact.ratio * series.normal_force[k];
  if (contact.slip == Slip::regularized) tanh_term(contact, k, series);
  direction_terms(contact, k);
}

MotionSeries::Load MotionSeries::contact_load(int k, const Segment& segment) const {
  Load load;
  for (int i = 0; i < segment.loaded_count; ++i) {
    const Contact& contact = contacts_[i];
    const ContactSeries& series = segment.loaded[i];
    load.force += product_term(contact.push, series.normal_force, k);
    load.moment += product_term(contact.push_moment, series.normal_force, k);
    // what holds a sticking contact is zero in this power as yet
    if (!contact.separate_t) continue;
    load.force += product_term(contact.drag, series.tangential_force, k);
    load.moment += product_term(contact.drag_moment, series.tangential_force, k);
  }
  return load;
}

/// At the last power that has been asked for: makes room for more, if they are wanted.
bool MotionSeries::goes_on(Segment& segment) {
  if (choice_ == nullptr) return false;
  const int order = choice_->next_order(segment);
  if (order <= segment.order) return false;
  order_ = segment.order = order;
  drive_series_.extend(order, segment);
  return true;
}

void MotionSeries::expand_contact(const State& start, const DriveForms& drives, int order, Segment& segment,
                                  OrderChoice* choice) {
  choice_ = choice;
  this->start(start, drives, order, segment);
  set_up_contacts(segment);
  if (segment.loaded_count == 1 && expand_single(segment)) return end_sticking(segment);
  for (int i = 0; i < segment.loaded_count; ++i) {
    const Contact& contact = contacts_[i];
    point_term(contact.point, 0, segment);
    const Pair& p = points_[contact.point][0];
    segment.loaded[i].depth[0] = contact.frame.depth(p[0], p[1]);
  }
  for (int k = 0;; ++k) {
    // positions are known to power k + 1: so are the points, and the forces to power k
    if (k + 1 > known_trig_) trig_term(k + 1, segment);
    known_trig_ = k + 1;
    for (int i = 0; i < segment.loaded_count; ++i) {
      point_term(contacts_[i].point, k + 1, segment);
      force_term(contacts_[i], k, segment.loaded[i], segment);
    }
    if (k == segment.order && !goes_on(segment)) break;
    accelerate(k, contact_load(k, segment), segment);
    if (sticking_count_ > 0) hold_sticking(k, segment);
  }
  end_sticking(segment);
}

/// V of what sticks is zero by construction.
void MotionSeries::end_sticking(Segment& segment) const {
  for (int m = 0; m < sticking_count_; ++m) {
    Series& v = segment.loaded[sticking_[m]].slip_velocity;
    std::fill(v.begin(), v.begin() + segment.order + 1, 0.0);
  }
}

}  // namespace vibratory_alignment
