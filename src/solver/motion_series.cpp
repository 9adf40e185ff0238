#include "solver/motion_series.h"

#include <algorithm>
#include <cmath>

namespace vibratory_alignment {
namespace {

/// a = constant + slope t and the oscillating part of a drive, added to a series.
void add_drive(const DriveForm& form, int order, Series& series) {
  series[0] += form.constant;
  series[1] += form.slope;
  if (form.amplitude == 0.0) return;
  // s' = (nu + rate t) c, c' = -(nu + rate t) s
  double s = form.amplitude * form.sin_phase, c = form.amplitude * form.cos_phase, s_before = 0.0, c_before = 0.0;
  for (int k = 0; k <= order; ++k) {
    series[k] += s;
    const double s_next = (form.frequency * c + form.rate * c_before) / (k + 1);
    const double c_next = -(form.frequency * s + form.rate * s_before) / (k + 1);
    s_before = s;
    c_before = c;
    s = s_next;
    c = c_next;
  }
}

int point_index(Site site) { return (is_edge(site) ? 0 : 2) + pair_index(site); }

/// What is left of V' of two sticking contacts, relative, that is more than rounding.
constexpr double kConflict = 1e-7;

constexpr Site kPointSites[4] = {Site::a1, Site::a2, Site::b1, Site::b2};

/// k(n) = c0 + c1 cos^2 phi on the faces of the part, power k.
void turning_term(const System& system, Face face, int k, const Segment& segment, double& stiffness, double& damping) {
  const double square = product_term(segment.cos_phi, segment.cos_phi, k);
  const bool bottom = face == Face::bottom;
  const double stiffness_0 = bottom ? system.stiffness_x : system.stiffness_y;
  const double damping_0 = bottom ? system.damping_x : system.damping_y;
  const double sign = bottom ? 1.0 : -1.0;
  stiffness = sign * (system.stiffness_y - system.stiffness_x) * square + (k == 0 ? stiffness_0 : 0.0);
  damping = sign * (system.damping_y - system.damping_x) * square + (k == 0 ? damping_0 : 0.0);
}

/// k(n) d + h(n) d', power k.
double turning_push(const Series& stiffness, const Series& damping, const Series& depth, int k) {
  double n = 0.0;
  for (int j = 0; j <= k; ++j) n += stiffness[j] * depth[k - j] + damping[j] * (k - j + 1) * depth[k - j + 1];
  return n;
}

}  // namespace

void MotionSeries::start(const State& start, const DriveForms& drives, int order, Segment& segment) {
  order_ = order;
  segment.order = order;
  segment.x[0] = start.x;
  segment.y[0] = start.y;
  segment.phi[0] = start.phi;
  segment.x[1] = segment.vx[0] = start.vx;
  segment.y[1] = segment.vy[0] = start.vy;
  segment.phi[1] = segment.omega[0] = start.omega;
  segment.cos_phi[0] = std::cos(start.phi);
  segment.sin_phi[0] = std::sin(start.phi);
  known_trig_ = 0;
  trig_term(0, segment);
  known_point_.fill(-1);
  for (Series* series : {&segment.drive_x, &segment.drive_y, &segment.drive_phi})
    std::fill(series->begin(), series->begin() + order + 1, 0.0);
  for (int i = 0; i < drives.count; ++i) {
    const Direction direction = drives.direction[i];
    Series& series = direction == Direction::x   ? segment.drive_x
                     : direction == Direction::y ? segment.drive_y
                                                 : segment.drive_phi;
    add_drive(drives.form[i], order, series);
  }
}

/// Velocity of power k + 1 and position of power k + 2 from the forces of power k.
void MotionSeries::accelerate(int k, const Load& load, Segment& segment) const {
  const double inverse = 1.0 / (k + 1), next_inverse = 1.0 / (k + 2);
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
  if (k > 0)
    direction_[k] = product_term(turned_, segment.omega, k - 1) / k;
  else
    direction_[0] = Pair(segment.cos_phi[0], segment.sin_phi[0]);
  turned_[k] = Pair(-direction_[k][1], direction_[k][0]);
  segment.cos_phi[k] = direction_[k][0];
  segment.sin_phi[k] = direction_[k][1];
}

void MotionSeries::point_term(Site site, int k, const Segment& segment) {
  const int index = point_index(site);
  known_point_[index] = k;
  if (!is_edge(site)) {
    const double beta = side_of(site) * system_.half_width, b = system_.base_distance;
    points_[index][k] = Pair(segment.x[k], segment.y[k]) + beta * direction_[k] - b * turned_[k];
    return;
  }
  // (u, w) = c (rx, ry) + s (ry, -rx)
  const double edge_x = k == 0 ? side_of(site) * system_.slot_half_width : 0.0;
  PairSeries& lever = levers_[index];
  PairSeries& crossed = crossed_[index];
  lever[k] = Pair(edge_x - segment.x[k], -segment.y[k]);
  crossed[k] = Pair(lever[k][1], -lever[k][0]);
  Pair sum = lever[0] * segment.cos_phi[k] + crossed[0] * segment.sin_phi[k];
  for (int j = 1; j <= k; ++j) sum += lever[j] * segment.cos_phi[k - j] + crossed[j] * segment.sin_phi[k - j];
  points_[index][k] = sum;
}

const PairSeries& MotionSeries::point(Site site, Segment& segment) {
  direction(segment);
  const int index = point_index(site);
  while (known_point_[index] < order_) point_term(kPointSites[index], known_point_[index] + 1, segment);
  return points_[index];
}

const PairSeries& MotionSeries::direction(Segment& segment) {
  while (known_trig_ < order_) trig_term(++known_trig_, segment);
  return direction_;
}

void MotionSeries::set_up_contacts(Segment& segment) {
  segment.loaded_count = 0;
  sticking_count_ = 0;
  conflict_ = {};
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
    contact.turning = is_edge(contact.site) && !system_.isotropic;
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
void MotionSeries::direction_terms(Contact& contact, int k, const Segment& segment) const {
  const ContactFrame& f = contact.frame;
  const Pair& p = points_[point_index(contact.site)][k];
  const double a = f.n1 + contact.ratio * f.t1(), b = f.n2 + contact.ratio * f.t2();
  Directions& d = contact.d;
  if (is_edge(contact.site)) {
    // body components (a, b): world a (c, s) + b (-s, c), moment b u - a w
    d.n[k] = a * direction_[k] + b * turned_[k];
    d.nm[k] = b * p[0] - a * p[1];
    if (!contact.separate_t) return;
    d.t[k] = f.t1() * direction_[k] + f.t2() * turned_[k];
    d.tm[k] = f.t2() * p[0] - f.t1() * p[1];
  } else {
    // world components (a, b), moment b r_x - a r_y
    const double rx = p[0] - segment.x[k], ry = p[1] - segment.y[k], one = k == 0 ? 1.0 : 0.0;
    d.n[k] = Pair(a * one, b * one);
    d.nm[k] = b * rx - a * ry;
    if (!contact.separate_t) return;
    d.t[k] = Pair(f.t1() * one, f.t2() * one);
    d.tm[k] = f.t2() * rx - f.t1() * ry;
  }
}

/// Depth, N, V and T of power k; positions are known to power k + 1. T of sticking contacts is left at zero.
void MotionSeries::force_terms(int k, Segment& segment) {
  for (int i = 0; i < segment.loaded_count; ++i) {
    Contact& contact = contacts_[i];
    ContactSeries& series = segment.loaded[i];
    const ContactFrame& f = contact.frame;
    const PairSeries& point = points_[point_index(contact.site)];
    if (k == 0) series.depth[0] = f.depth(point[0][0], point[0][1]);
    series.depth[k + 1] = f.sign * (f.n1 * point[k + 1][0] + f.n2 * point[k + 1][1]);
    const double depth_rate = (k + 1) * series.depth[k + 1];
    series.slip_velocity[k] = -f.sign * (k + 1) * (f.t1() * point[k + 1][0] + f.t2() * point[k + 1][1]);
    if (contact.turning) {
      turning_term(system_, contact.face, k, segment, contact.k[k], contact.h[k]);
      series.normal_force[k] = turning_push(contact.k, contact.h, series.depth, k);
    } else {
      series.normal_force[k] = contact.stiffness * series.depth[k] + contact.damping * depth_rate;
    }
    series.tangential_force[k] = contact.ratio * series.normal_force[k];
    if (contact.slip == Slip::regularized) {
      // z = tanh(V/eps): z' = (1 - z^2) V'/eps
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
    direction_terms(contact, k, segment);
  }
}

/// Tangential forces of power k that keep V = 0: T = 0 first, then G T = -V' corrects the acceleration.
void MotionSeries::hold_sticking(int k, Segment& segment) {
  if (k == 0) {
    for (int m = 0; m < sticking_count_; ++m)
      for (int n = 0; n < sticking_count_; ++n) {
        const Directions& a = contacts_[sticking_[m]].d;
        const Directions& b = contacts_[sticking_[n]].d;
        mobility_[m][n] = system_.x.inverse_inertia * a.t[0][0] * b.t[0][0] +
                          system_.y.inverse_inertia * a.t[0][1] * b.t[0][1] +
                          system_.phi.inverse_inertia * a.tm[0] * b.tm[0];
      }
  }
  // V' of power k without the forces sought
  trig_term(k + 2, segment);
  std::array<double, kSiteCount> rhs{}, force{};
  for (int m = 0; m < sticking_count_; ++m) {
    const Contact& contact = contacts_[sticking_[m]];
    point_term(contact.site, k + 2, segment);
    const PairSeries& point = points_[point_index(contact.site)];
    const ContactFrame& f = contact.frame;
    rhs[m] = f.sign * (k + 2) * (k + 1) * (f.t1() * point[k + 2][0] + f.t2() * point[k + 2][1]);
  }
  solve_mobility(mobility_, sticking_count_, rhs, force);
  if (sticking_count_ > 1 && conflict_.count == 0) find_conflict(rhs, force, k);
  for (int m = 0; m < sticking_count_; ++m) {
    const Directions& d = contacts_[sticking_[m]].d;
    segment.loaded[sticking_[m]].tangential_force[k] = force[m];
    segment.vx[k + 1] += system_.x.inverse_inertia * d.t[0][0] * force[m] / (k + 1);
    segment.vy[k + 1] += system_.y.inverse_inertia * d.t[0][1] * force[m] / (k + 1);
    segment.omega[k + 1] += system_.phi.inverse_inertia * d.tm[0] * force[m] / (k + 1);
  }
  segment.x[k + 2] = segment.vx[k + 1] / (k + 2);
  segment.y[k + 2] = segment.vy[k + 1] / (k + 2);
  segment.phi[k + 2] = segment.omega[k + 1] / (k + 2);
}

MotionSeries::Load MotionSeries::contact_load(int k, const Segment& segment) const {
  Load load;
  for (int i = 0; i < segment.loaded_count; ++i) {
    const Contact& contact = contacts_[i];
    const Directions& d = contact.d;
    const Series& n = segment.loaded[i].normal_force;
    for (int j = 0; j <= k; ++j) {
      load.force += d.n[j] * n[k - j];
      load.moment += d.nm[j] * n[k - j];
    }
    if (!contact.separate_t) continue;
    // what holds a sticking contact is not known yet in this power
    const Series& t = segment.loaded[i].tangential_force;
    const int first = contact.slip == Slip::stick ? 1 : 0;
    for (int j = first; j <= k; ++j) {
      load.force += d.t[j] * t[k - j];
      load.moment += d.tm[j] * t[k - j];
    }
  }
  return load;
}

/// Where G is singular the contacts hold one motion for this instant; if they part in a later power, V' of power k is
/// left over: one of them gives way, in the direction that is left over for it.
void MotionSeries::find_conflict(const std::array<double, kSiteCount>& rhs, const std::array<double, kSiteCount>& force,
                                 int k) {
  for (int m = 0; m < sticking_count_; ++m) {
    double left = -rhs[m], scale = std::abs(rhs[m]) + 1e-300;
    for (int n = 0; n < sticking_count_; ++n) {
      left += mobility_[m][n] * force[n];
      scale += std::abs(mobility_[m][n] * force[n]);
    }
    if (std::abs(left) <= kConflict * scale) continue;
    conflict_.candidates[conflict_.count++] = {EventKind::part, contacts_[sticking_[m]].site, Face::none,
                                               left > 0.0 ? 1 : -1, k + 1};
  }
}

void MotionSeries::expand_contact(const State& start, const DriveForms& drives, int order, Segment& segment) {
  this->start(start, drives, order, segment);
  set_up_contacts(segment);
  for (int i = 0; i < segment.loaded_count; ++i) point_term(contacts_[i].site, 0, segment);
  for (int k = 0;; ++k) {
    // positions are known to power k + 1: so are the points, and the forces to power k
    trig_term(k + 1, segment);
    known_trig_ = k + 1;
    for (int i = 0; i < segment.loaded_count; ++i) point_term(contacts_[i].site, k + 1, segment);
    force_terms(k, segment);
    if (k == order) break;
    accelerate(k, contact_load(k, segment), segment);
    if (sticking_count_ > 0) hold_sticking(k, segment);
  }
  // the highest power of what sticks is not determined yet at `order`; V itself is zero by construction
  for (int m = 0; m < sticking_count_; ++m) {
    ContactSeries& series = segment.loaded[sticking_[m]];
    series.tangential_force[order] = 0.0;
    std::fill(series.slip_velocity.begin(), series.slip_velocity.begin() + order + 1, 0.0);
  }
}

}  // namespace vibratory_alignment
