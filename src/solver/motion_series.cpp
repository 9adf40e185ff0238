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

/// 1/k.
constexpr std::array<double, kMaxOrder + 4> kInverse = [] {
  std::array<double, kMaxOrder + 4> inverse{};
  for (std::size_t k = 1; k < inverse.size(); ++k) inverse[k] = 1.0 / static_cast<double>(k);
  return inverse;
}();

int point_index(Site site) { return (is_edge(site) ? 0 : 2) + pair_index(site); }

/// Rounding of V' relative to the sizes of its terms.
constexpr double kSlipRateRounding = 1e-15;

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
  direction_[0] = Pair(segment.cos_phi[0], segment.sin_phi[0]);
  mirrored_[0] = Pair(segment.cos_phi[0], -segment.sin_phi[0]);
  swapped_[0] = Pair(segment.sin_phi[0], segment.cos_phi[0]);
  known_centre_ = -1;
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
  direction_[k] = Pair(c, s);
  mirrored_[k] = Pair(c, -s);
  swapped_[k] = Pair(s, c);
  segment.cos_phi[k] = c;
  segment.sin_phi[k] = s;
}

/// (x c + y s, y c - x s), power k.
void MotionSeries::centre_term(int k, const Segment& segment) {
  known_centre_ = k;
  Pair sum = segment.x[k] * mirrored_[0] + segment.y[k] * swapped_[0];
  if (system_.phi.moves)
    for (int j = 0; j < k; ++j) sum += segment.x[j] * mirrored_[k - j] + segment.y[j] * swapped_[k - j];
  centre_[k] = sum;
}

void MotionSeries::point_term(int point, int k, const Segment& segment) {
  known_point_[point] = k;
  const Pair& d = direction_[k];
  const double side = point % 2 == 0 ? 1.0 : -1.0;
  if (point >= 2) {
    const double beta = side * system_.half_width, b = system_.base_distance;
    points_[point][k] = Pair(segment.x[k] + beta * d[0] + b * d[1], segment.y[k] + beta * d[1] - b * d[0]);
    return;
  }
  if (known_centre_ < k) centre_term(k, segment);
  const double l = side * system_.slot_half_width;
  points_[point][k] = l * mirrored_[k] - centre_[k];
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
  sticking_count_ = 0;
  not_held_.fill(0.0);
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
void MotionSeries::direction_terms(Contact& contact, int k) const {
  const ContactFrame& f = contact.frame;
  const Pair& d = direction_[k];
  if (is_edge(contact.site)) {
    // body components (a, b): world a (c, s) + b (-s, c), moment b u - a w
    const Pair& p = points_[contact.point][k];
    const auto force = [&](double a, double b) { return Pair(a * d[0] - b * d[1], a * d[1] + b * d[0]); };
    contact.push[k] = force(contact.force1, contact.force2);
    contact.push_moment[k] = contact.force2 * p[0] - contact.force1 * p[1];
    if (!contact.separate_t) return;
    contact.drag[k] = force(f.t1(), f.t2());
    contact.drag_moment[k] = f.t2() * p[0] - f.t1() * p[1];
  } else {
    // world components (a, b), moment b r_x - a r_y
    const double beta = side_of(contact.site) * system_.half_width, b0 = system_.base_distance;
    const double rx = beta * d[0] + b0 * d[1], ry = beta * d[1] - b0 * d[0], one = k == 0 ? 1.0 : 0.0;
    contact.push[k] = Pair(contact.force1 * one, contact.force2 * one);
    contact.push_moment[k] = contact.force2 * rx - contact.force1 * ry;
    if (!contact.separate_t) return;
    contact.drag[k] = Pair(f.t1() * one, f.t2() * one);
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

void MotionSeries::set_up_mobility() {
  Mobility::Matrix matrix{};
  for (int m = 0; m < sticking_count_; ++m)
    for (int n = 0; n < sticking_count_; ++n) {
      const Contact& a = contacts_[sticking_[m]];
      const Contact& b = contacts_[sticking_[n]];
      matrix[m][n] = system_.x.inverse_inertia * a.drag[0][0] * b.drag[0][0] +
                     system_.y.inverse_inertia * a.drag[0][1] * b.drag[0][1] +
                     system_.phi.inverse_inertia * a.drag_moment[0] * b.drag_moment[0];
    }
  mobility_.set(matrix, sticking_count_, typical_mobility(system_));
}

double MotionSeries::slip_rate_size(const Segment& segment) const {
  const auto force = [](const Axis& axis, const Series& drive, const Series& q, const Series& v) {
    return std::abs(drive[0]) + axis.damping * std::abs(v[0]) + axis.stiffness * std::abs(q[0] - axis.anchor);
  };
  const double reach = system_.half_width + system_.base_distance;
  double forces = system_.weight;
  for (int i = 0; i < segment.loaded_count; ++i)
    forces += std::abs(segment.loaded[i].normal_force[0]) + std::abs(segment.loaded[i].tangential_force[0]);
  const double turn = std::abs(segment.omega[0]),
               speed = std::abs(segment.vx[0]) + std::abs(segment.vy[0]) + reach * turn;
  return system_.x.inverse_inertia * (force(system_.x, segment.drive_x, segment.x, segment.vx) + forces) +
         system_.y.inverse_inertia * (force(system_.y, segment.drive_y, segment.y, segment.vy) + forces) +
         reach * system_.phi.inverse_inertia *
             (force(system_.phi, segment.drive_phi, segment.phi, segment.omega) + reach * forces) +
         turn * speed;
}

/// Sum of the absolute values of what V' of power k is made of: what its rounding is measured by.
double MotionSeries::slip_rate_size(const Contact& contact, int k, const Segment& segment) const {
  const auto axis_size = [&](const Axis& axis, const Series& drive, const Series& q, const Series& v) {
    return std::abs(drive[k]) + axis.damping * std::abs(v[k]) + axis.stiffness * std::abs(q[k]);
  };
  double x =
      axis_size(system_.x, segment.drive_x, segment.x, segment.vx) + system_.x.stiffness * std::abs(system_.x.anchor);
  double y = axis_size(system_.y, segment.drive_y, segment.y, segment.vy) + std::abs(system_.y.anchor) + system_.weight;
  double moment = axis_size(system_.phi, segment.drive_phi, segment.phi, segment.omega);
  for (int i = 0; i < segment.loaded_count; ++i) {
    const Contact& other = contacts_[i];
    const ContactSeries& series = segment.loaded[i];
    for (int j = 0; j <= k; ++j) {
      const double n = std::abs(series.normal_force[k - j]);
      x += std::abs(other.push[j][0]) * n;
      y += std::abs(other.push[j][1]) * n;
      moment += std::abs(other.push_moment[j]) * n;
      if (!other.separate_t) continue;
      const double t = std::abs(series.tangential_force[k - j]);
      x += std::abs(other.drag[j][0]) * t;
      y += std::abs(other.drag[j][1]) * t;
      moment += std::abs(other.drag_moment[j]) * t;
    }
  }
  // V' along t, and what turning adds to it
  const double size = std::abs(contact.drag[0][0]) * system_.x.inverse_inertia * x +
                      std::abs(contact.drag[0][1]) * system_.y.inverse_inertia * y +
                      std::abs(contact.drag_moment[0]) * system_.phi.inverse_inertia * moment;
  double turning = 0.0;
  for (int j = 0; j <= k + 1; ++j) {
    const double reach =
        j == 0 ? system_.half_width + system_.base_distance : std::abs(segment.x[j]) + std::abs(segment.y[j]);
    turning += reach * direction_[k + 2 - j].abs().sum();
  }
  return size + (k + 2) * (k + 1) * turning;
}

/// Tangential forces of power k that keep V = 0: T = 0 first, then G T = -V' corrects the acceleration.
void MotionSeries::hold_sticking(int k, Segment& segment) {
  if (k == 0) set_up_mobility();
  // V' of power k without the forces sought
  trig_term(k + 2, segment);
  Mobility::Vector rhs{}, noise{};
  for (int m = 0; m < sticking_count_; ++m) {
    const Contact& contact = contacts_[sticking_[m]];
    point_term(contact.point, k + 2, segment);
    const PairSeries& point = points_[contact.point];
    const ContactFrame& f = contact.frame;
    rhs[m] = f.sign * (k + 2) * (k + 1) * (f.t1() * point[k + 2][0] + f.t2() * point[k + 2][1]);
    if (!mobility_.regular()) noise[m] = kSlipRateRounding * slip_rate_size(contact, k, segment);
  }
  const Mobility::Vector held = mobility_.hold(rhs, noise);
  for (int m = 0; m < sticking_count_; ++m) {
    const Contact& contact = contacts_[sticking_[m]];
    const Pair& d = contact.drag[0];
    const double force = held[m];
    segment.loaded[sticking_[m]].tangential_force[k] = force;
    segment.vx[k + 1] += system_.x.inverse_inertia * d[0] * force / (k + 1);
    segment.vy[k + 1] += system_.y.inverse_inertia * d[1] * force / (k + 1);
    segment.omega[k + 1] += system_.phi.inverse_inertia * contact.drag_moment[0] * force / (k + 1);
    if (k < kHeldPowers && !mobility_.regular()) {
      const double left = std::abs(mobility_.left_over(m, rhs, held));
      if (left > noise[m]) not_held_[k] = std::max(not_held_[k], left);
    }
  }
  segment.x[k + 2] = segment.vx[k + 1] / (k + 2);
  segment.y[k + 2] = segment.vy[k + 1] / (k + 2);
  segment.phi[k + 2] = segment.omega[k + 1] / (k + 2);
  known_centre_ = std::min(known_centre_, k + 1);  // that of k + 2 was without these forces
}

std::array<double, kSiteCount> MotionSeries::holding_force_noise(
    const std::array<double, kSiteCount>& slip_rate_noise) const {
  Mobility::Vector rate{};
  for (int m = 0; m < sticking_count_; ++m) rate[m] = slip_rate_noise[sticking_[m]];
  const Mobility::Vector spread = mobility_.spread(rate);
  std::array<double, kSiteCount> noise{};
  for (int m = 0; m < sticking_count_; ++m) noise[sticking_[m]] = spread[m];
  return noise;
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

/// The whole expansion for one contact that slides (or whose friction is regularised) on a base whose stiffness does
/// not turn: the same recurrences, in one loop.
template <bool kEdge, bool kTurns, bool kTanh>
void MotionSeries::expand_single(Segment& segment) {
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

void MotionSeries::expand_contact(const State& start, const DriveForms& drives, int order, Segment& segment) {
  this->start(start, drives, order, segment);
  set_up_contacts(segment);
  if (segment.loaded_count == 1 && sticking_count_ == 0 && !contacts_[0].turning) {
    const bool edge = is_edge(contacts_[0].site), turns = system_.phi.moves, tanh = contacts_[0].separate_t;
    if (edge)
      turns ? (tanh ? expand_single<true, true, true>(segment) : expand_single<true, true, false>(segment))
            : (tanh ? expand_single<true, false, true>(segment) : expand_single<true, false, false>(segment));
    else
      turns ? (tanh ? expand_single<false, true, true>(segment) : expand_single<false, true, false>(segment))
            : (tanh ? expand_single<false, false, true>(segment) : expand_single<false, false, false>(segment));
    return;
  }
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
