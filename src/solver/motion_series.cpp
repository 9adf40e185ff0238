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
void MotionSeries::accelerate(int k, double fx, double fy, double m, Segment& segment) const {
  const auto axis_term = [k](const Axis& axis, double force, Series& q, Series& v) {
    const double stretch = k == 0 ? q[0] - axis.anchor : q[k];
    v[k + 1] = axis.inverse_inertia * (force - axis.damping * v[k] - axis.stiffness * stretch) / (k + 1);
    q[k + 2] = v[k + 1] / (k + 2);
  };
  const double weight = k == 0 ? system_.weight : 0.0;
  axis_term(system_.x, segment.drive_x[k] + fx, segment.x, segment.vx);
  axis_term(system_.y, segment.drive_y[k] + fy - weight, segment.y, segment.vy);
  axis_term(system_.phi, segment.drive_phi[k] + m, segment.phi, segment.omega);
}

void MotionSeries::expand_free(const State& start, const DriveForms& drives, int order, Segment& segment) {
  this->start(start, drives, order, segment);
  segment.loaded_count = 0;
  for (int k = 0; k < order; ++k) accelerate(k, 0.0, 0.0, 0.0, segment);
}

void MotionSeries::trig_term(int k, Segment& segment) const {
  // c' = -s omega, s' = c omega
  double c = 0.0, s = 0.0;
  for (int j = 0; j < k; ++j) {
    c -= segment.sin_phi[j] * segment.omega[k - 1 - j];
    s += segment.cos_phi[j] * segment.omega[k - 1 - j];
  }
  segment.cos_phi[k] = c / k;
  segment.sin_phi[k] = s / k;
}

void MotionSeries::point_term(Site site, int k, const Segment& segment) {
  Point& point = points_[static_cast<std::size_t>(point_index(site))];
  const Series& c = segment.cos_phi;
  const Series& s = segment.sin_phi;
  if (is_edge(site)) {
    // u = rx c + ry s, w = ry c - rx s with rx = A_x - x, ry = -y
    const double edge_x = side_of(site) * system_.slot_half_width;
    double u = (edge_x - segment.x[0]) * c[k] - segment.y[0] * s[k];
    double w = -segment.y[0] * c[k] - (edge_x - segment.x[0]) * s[k];
    for (int j = 1; j <= k; ++j) {
      u -= segment.x[j] * c[k - j] + segment.y[j] * s[k - j];
      w += segment.x[j] * s[k - j] - segment.y[j] * c[k - j];
    }
    point.p1[k] = u;
    point.p2[k] = w;
  } else {
    const double beta = side_of(site) * system_.half_width, b = system_.base_distance;
    point.p1[k] = segment.x[k] + beta * c[k] + b * s[k];
    point.p2[k] = segment.y[k] + beta * s[k] - b * c[k];
  }
  known_point_[static_cast<std::size_t>(point_index(site))] = k;
}

const MotionSeries::Point& MotionSeries::point(Site site, Segment& segment) {
  for (; known_trig_ < order_; ++known_trig_) trig_term(known_trig_ + 1, segment);
  const auto index = static_cast<std::size_t>(point_index(site));
  while (known_point_[index] < order_) point_term(kPointSites[index], known_point_[index] + 1, segment);
  return points_[index];
}

void MotionSeries::set_up_contacts(Segment& segment) {
  segment.loaded_count = 0;
  sticking_count_ = 0;
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
  const Point& point = points_[static_cast<std::size_t>(point_index(contact.site))];
  const double a = f.n1 + contact.ratio * f.t1(), b = f.n2 + contact.ratio * f.t2();
  Directions& d = contact.d;
  if (is_edge(contact.site)) {
    // body components (a, b): world (a c - b s, a s + b c), moment b u - a w
    const double c = segment.cos_phi[k], s = segment.sin_phi[k];
    d.nx[k] = a * c - b * s;
    d.ny[k] = a * s + b * c;
    d.nm[k] = b * point.p1[k] - a * point.p2[k];
    if (!contact.separate_t) return;
    d.tx[k] = f.t1() * c - f.t2() * s;
    d.ty[k] = f.t1() * s + f.t2() * c;
    d.tm[k] = f.t2() * point.p1[k] - f.t1() * point.p2[k];
  } else {
    // world components (a, b), moment b r_x - a r_y
    const double rx = point.p1[k] - segment.x[k], ry = point.p2[k] - segment.y[k];
    d.nx[k] = k == 0 ? a : 0.0;
    d.ny[k] = k == 0 ? b : 0.0;
    d.nm[k] = b * rx - a * ry;
    if (!contact.separate_t) return;
    d.tx[k] = k == 0 ? f.t1() : 0.0;
    d.ty[k] = k == 0 ? f.t2() : 0.0;
    d.tm[k] = f.t2() * rx - f.t1() * ry;
  }
}

/// Depth, N, V and T of power k; positions are known to power k + 1. T of sticking contacts is left at zero.
void MotionSeries::force_terms(int k, Segment& segment) {
  for (int i = 0; i < segment.loaded_count; ++i) {
    Contact& contact = contacts_[i];
    ContactSeries& series = segment.loaded[i];
    const ContactFrame& f = contact.frame;
    const Point& point = points_[static_cast<std::size_t>(point_index(contact.site))];
    if (k == 0) series.depth[0] = f.depth(point.p1[0], point.p2[0]);
    series.depth[k + 1] = f.sign * (f.n1 * point.p1[k + 1] + f.n2 * point.p2[k + 1]);
    const double depth_rate = (k + 1) * series.depth[k + 1];
    series.slip_velocity[k] = -f.sign * (k + 1) * (f.t1() * point.p1[k + 1] + f.t2() * point.p2[k + 1]);
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
        mobility_[m][n] = system_.x.inverse_inertia * a.tx[0] * b.tx[0] + system_.y.inverse_inertia * a.ty[0] * b.ty[0] +
                          system_.phi.inverse_inertia * a.tm[0] * b.tm[0];
      }
  }
  // V' of power k without the forces sought
  trig_term(k + 2, segment);
  std::array<double, kSiteCount> rhs{}, force{};
  for (int m = 0; m < sticking_count_; ++m) {
    const Contact& contact = contacts_[sticking_[m]];
    point_term(contact.site, k + 2, segment);
    const Point& point = points_[static_cast<std::size_t>(point_index(contact.site))];
    const ContactFrame& f = contact.frame;
    rhs[m] = f.sign * (k + 2) * (k + 1) * (f.t1() * point.p1[k + 2] + f.t2() * point.p2[k + 2]);
  }
  solve_mobility(mobility_, sticking_count_, rhs, force);
  for (int m = 0; m < sticking_count_; ++m) {
    const Directions& d = contacts_[sticking_[m]].d;
    segment.loaded[sticking_[m]].tangential_force[k] = force[m];
    segment.vx[k + 1] += system_.x.inverse_inertia * d.tx[0] * force[m] / (k + 1);
    segment.vy[k + 1] += system_.y.inverse_inertia * d.ty[0] * force[m] / (k + 1);
    segment.omega[k + 1] += system_.phi.inverse_inertia * d.tm[0] * force[m] / (k + 1);
  }
  segment.x[k + 2] = segment.vx[k + 1] / (k + 2);
  segment.y[k + 2] = segment.vy[k + 1] / (k + 2);
  segment.phi[k + 2] = segment.omega[k + 1] / (k + 2);
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
    double fx = 0.0, fy = 0.0, m = 0.0;
    for (int i = 0; i < segment.loaded_count; ++i) {
      const Directions& d = contacts_[i].d;
      const Series& n = segment.loaded[i].normal_force;
      for (int j = 0; j <= k; ++j) {
        fx += n[j] * d.nx[k - j];
        fy += n[j] * d.ny[k - j];
        m += n[j] * d.nm[k - j];
      }
      if (!contacts_[i].separate_t) continue;
      const Series& t = segment.loaded[i].tangential_force;
      const int known = contacts_[i].slip == Slip::stick ? k - 1 : k;
      for (int j = 0; j <= known; ++j) {
        fx += t[j] * d.tx[k - j];
        fy += t[j] * d.ty[k - j];
        m += t[j] * d.tm[k - j];
      }
    }
    accelerate(k, fx, fy, m, segment);
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
