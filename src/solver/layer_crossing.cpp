#include "solver/layer_crossing.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "mechanics/forces.h"
#include "mechanics/octet_contact.h"
#include "mechanics/quad_functions.h"
#include "solver/contact_point.h"

namespace vibratory_alignment {
namespace {

/// T has poles at distances of pi/2 eps from the real axis of V: the width of the map that leads them away.
constexpr double kWidth = 1.5707963267948966;

/// Most share of V' that friction takes at the far side, as N is now: more may make V turn.
constexpr double kMostFriction = 0.95;

/// Radians of the base that a crossing may take at most: what N does in them is found by iteration.
constexpr double kMostRadians = 10.0;

/// N of a crossing is nowhere below this share of its largest.
constexpr double kLeastForce = 0.05;

/// Iterations at most, and the share of its last change that one may leave.
constexpr int kMostIterations = 16;
constexpr double kSlow = 0.6;

/// Rounding of a change, relative to what changes.
constexpr double kRounding = 4e-15;

/// What accelerations may be larger between the nodes than at them.
constexpr double kBetween = 1.1;

/// Iterations by which a time's place is found, and the largest N.
constexpr int kPlaceIterations = 50, kForceIterations = 40;

VIBRATORY_ALIGNMENT_INLINE Octet larger(const Octet& a, const Octet& b) {
  return {a.low > b.low ? a.low : b.low, a.high > b.high ? a.high : b.high};
}

/// Of values at the nodes, eight in each, the one at node j.
VIBRATORY_ALIGNMENT_INLINE double of_node(const std::array<Octet, GaussTable::kOctets>& values, std::size_t j) {
  return values[j / Octet::kSize][j % Octet::kSize];
}

/// Integrals from the start to every node of rates at the nodes.
template <typename Stages, std::size_t kCount>
VIBRATORY_ALIGNMENT_INLINE void integrate_to_nodes(const GaussTable& table, const std::array<Stages, kCount>& rates,
                                                   std::array<Stages, kCount>& integrals) {
  for (std::size_t i = 0; i < table.octets(); ++i) {
    std::array<Octet, kCount> sum{};
    for (std::size_t j = 0; j < table.count; ++j)
      for (std::size_t c = 0; c < kCount; ++c) sum[c] += table.integral[j][i] * of_node(rates[c], j);
    for (std::size_t c = 0; c < kCount; ++c) integrals[c][i] = sum[c];
  }
}

}  // namespace

LayerCrossing::LayerCrossing(const System& system, double tolerance)
    : system_(system), tolerance_(std::max(tolerance, kRounding)), table_(&gauss_table(0)) {}

bool LayerCrossing::take(const State& start, const DriveForms& drives, const ContactStates& contacts, Site site,
                         SolverCounts& counts) {
  start_ = start;
  drives_ = drives;
  site_ = site;
  face_ = contacts[static_cast<std::size_t>(site)].face;
  ++counts.rhs_evaluations;
  if (!look_at_start(contacts) || !place_nodes()) return false;
  while (solve(counts)) {
    if (unresolved() <= tolerance_) {
      finish();
      return true;
    }
    if (table_->count == GaussTable::kMost) return false;
    table_ = &gauss_table(table_->count + 1);
  }
  return false;
}

/// Forces and accelerations at the start. False where V turns, as they are now.
bool LayerCrossing::look_at_start(const ContactStates& contacts) {
  Forces forces;
  evaluate_forces(system_, start_, load_at(drives_, 0.0), contacts, forces);
  normal_force_at_start_ = forces.contact[0].normal_force;
  friction_at_start_ = forces.contact[0].tangential_force;
  share_at_start_ = forces.contact[0].slip_velocity / system_.regularization;
  acceleration_at_start_ = {forces.ax, forces.ay, forces.alpha};

  const PlacedState placed(start_);
  const ContactPoint contact = contact_point(system_, placed, site_, face_, site_point(system_, placed, site_));
  const double lever = contact.tangent_lever();
  of_friction_ = {system_.x.inverse_inertia * contact.tangent.x, system_.y.inverse_inertia * contact.tangent.y,
                  system_.phi.inverse_inertia * lever};
  friction_mobility_ =
      contact.tangent.x * of_friction_.x + contact.tangent.y * of_friction_.y + lever * of_friction_.phi;
  slip_rate_at_start_ =
      contact.tangent.x * forces.ax + contact.tangent.y * forces.ay + lever * forces.alpha + contact.slip_rate;
  way_ = slip_rate_at_start_ < 0.0 ? -1.0 : 1.0;

  const double driven = way_ * (slip_rate_at_start_ - friction_mobility_ * friction_at_start_);
  const double held = friction_mobility_ * system_.friction * normal_force_at_start_;
  if (!(normal_force_at_start_ > 0.0 && held > 0.0 && held <= kMostFriction * driven)) return false;
  centre_ = std::atanh(held / driven);

  const double normal_lever = contact.normal_lever();
  const double mobility = contact.normal.x * contact.normal.x * system_.x.inverse_inertia +
                          contact.normal.y * contact.normal.y * system_.y.inverse_inertia +
                          normal_lever * normal_lever * system_.phi.inverse_inertia;
  base_rate_ = std::sqrt(contact.stiffness * mobility) + contact.damping * mobility;
  return way_ * share_at_start_ < system_.tanh_saturation;
}

/// The map, its nodes, and T there. As many nodes as the nearest pole asks for. False where that is too many.
bool LayerCrossing::place_nodes() {
  first_ = std::asinh((way_ * share_at_start_ - centre_) / kWidth);
  half_ = 0.5 * (std::asinh((system_.tanh_saturation - centre_) / kWidth) - first_);
  // values at the nodes tell of the function between them to rho^-n, rho the ellipse through the pole at w = i pi/2
  const std::complex<double> pole(-(first_ + half_) / half_, kWidth / half_), root = std::sqrt(pole * pole - 1.0);
  const double log_rho = std::log(std::max(std::abs(pole + root), std::abs(pole - root)));
  const double needed = -std::log(tolerance_) / log_rho;
  if (!(needed <= static_cast<double>(GaussTable::kMost))) return false;
  table_ = &gauss_table(static_cast<std::size_t>(std::ceil(needed)));
  return true;
}

/// Collocation by iteration: with V given at the nodes, forces and accelerations follow from the states, and times and
/// states from these. False where that does not converge to a crossing.
bool LayerCrossing::solve(SolverCounts& counts) {
  guess();
  integrate();
  if (!(of_node(time_, table_->count - 1) * base_rate_ <= kMostRadians)) return false;
  double before = 1.0;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    evaluate();
    counts.rhs_evaluations += static_cast<long>(table_->count);
    if (!passes()) return false;
    const double change = integrate();
    if (change <= tolerance_) return true;
    if (!(change <= kSlow * before)) return false;
    before = change;
  }
  return false;
}

/// The map at the nodes, and accelerations there with N as it is at the start.
void LayerCrossing::guess() {
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    const double scale = way_ * system_.regularization, friction = system_.friction;
    for (std::size_t i = 0; i < table_->octets(); ++i) {
      const Octet w = first_ + half_ * (1.0 + table_->node[i]), size = abs(w);
      Octet change, left, tanh;
      exp_change(-size.low, change.low, left.low);
      exp_change(-size.high, change.high, left.high);
      const Octet inverse = 1.0 / left, cosh = 0.5 * (inverse + left), sinh = 0.5 * (inverse - left);
      const Octet share =
          centre_ + kWidth * Octet(w.low < 0.0 ? -sinh.low : sinh.low, w.high < 0.0 ? -sinh.high : sinh.high);
      tanh_of(share.low, tanh.low);
      tanh_of(share.high, tanh.high);
      tanh_[i] = way_ * tanh;
      stretch_[i] = (scale * kWidth) * cosh;
      const Octet more = -(friction * normal_force_at_start_) * tanh_[i] - friction_at_start_;
      pace_[i] = stretch_[i] / (slip_rate_at_start_ + friction_mobility_ * more);
      ax_[i] = acceleration_at_start_.x + of_friction_.x * more;
      ay_[i] = acceleration_at_start_.y + of_friction_.y * more;
      alpha_[i] = acceleration_at_start_.phi + of_friction_.phi * more;
      time_[i] = 0.0;
      states_[i] = {start_.x, start_.y, start_.phi, start_.vx, start_.vy, start_.omega};
    }
  });
  pace_at_start_ = way_ * system_.regularization * kWidth * std::cosh(first_) / slip_rate_at_start_;
}

/// Forces and accelerations at the nodes, with T as V tells, and with them the pace of time.
void LayerCrossing::evaluate() {
  std::array<LoadOctet, GaussTable::kOctets> drive;
  for (std::size_t i = 0; i < table_->octets(); ++i)
    evaluate_drives(drives_.form.data(), drives_.direction.data(), drives_.count, time_[i], drive[i]);
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    const double friction = system_.friction;
    for (std::size_t i = 0; i < table_->octets(); ++i) {
      const StateOctet& q = states_[i];
      Octet c, s;
      tilts_of(q.phi, c, s);
      const ContactOctet contact = contact_octet(system_, q, site_, face_, c, s);
      const Vec2Octet &n = contact.normal, &t = contact.tangent;
      const Octet normal_force = along_normal(face_, c, s, system_.stiffness_x, system_.stiffness_y) * contact.depth +
                                 along_normal(face_, c, s, system_.damping_x, system_.damping_y) * contact.depth_rate;
      const Octet tangential_force = -friction * tanh_[i] * normal_force;
      const Vec2Octet force = {normal_force * n.x + tangential_force * t.x,
                               normal_force * n.y + tangential_force * t.y};
      const LoadOctet load = free_load(system_, q, drive[i]);
      normal_force_[i] = normal_force;
      ax_[i] = system_.x.inverse_inertia * (load.x + force.x);
      ay_[i] = system_.y.inverse_inertia * (load.y + force.y);
      alpha_[i] = system_.phi.inverse_inertia * (load.phi + cross(contact.lever, force));
      const Octet slip_rate =
          t.x * ax_[i] + t.y * ay_[i] + cross(contact.lever, t) * alpha_[i] + slip_rate_of(q, contact, face_);
      pace_[i] = stretch_[i] / slip_rate;
    }
  });
}

/// True as long as V goes on its way at every node and N pushes.
bool LayerCrossing::passes() const {
  double least_pace = pace_at_start_, least_force = normal_force_at_start_, most_force = normal_force_at_start_;
  for (std::size_t i = 0; i < table_->octets(); ++i) {
    least_pace = std::min(least_pace, -largest(-pace_[i]));
    least_force = std::min(least_force, -largest(-normal_force_[i]));
    most_force = std::max(most_force, largest(normal_force_[i]));
  }
  return least_pace > 0.0 && least_force > kLeastForce * most_force;
}

/// Times, velocities and positions at the nodes from pace and accelerations. Returns the largest change, of times
/// relative to the duration and of velocities relative to the part's speed.
double LayerCrossing::integrate() {
  double change = 0.0;
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    const std::size_t octets = table_->octets();
    const double reach = system_.half_width + system_.base_distance;
    std::array<Stages, 4> rates, integrals;
    for (std::size_t i = 0; i < octets; ++i) {
      const Octet pace = half_ * pace_[i];
      rates[0][i] = pace;
      rates[1][i] = pace * ax_[i];
      rates[2][i] = pace * ay_[i];
      rates[3][i] = pace * alpha_[i];
    }
    integrate_to_nodes(*table_, rates, integrals);
    Octet time_change = 0.0, speed_change = 0.0, speed = 0.0, latest = 0.0;
    std::array<Stages, 3> velocities, ways;
    for (std::size_t i = 0; i < octets; ++i) {
      StateOctet& q = states_[i];
      const Octet vx = start_.vx + integrals[1][i], vy = start_.vy + integrals[2][i],
                  omega = start_.omega + integrals[3][i];
      time_change = larger(time_change, abs(integrals[0][i] - time_[i]));
      speed_change = larger(speed_change, abs(vx - q.vx) + abs(vy - q.vy) + reach * abs(omega - q.omega));
      speed = larger(speed, abs(vx) + abs(vy) + reach * abs(omega));
      latest = larger(latest, integrals[0][i]);
      time_[i] = integrals[0][i];
      q.vx = vx;
      q.vy = vy;
      q.omega = omega;
      velocities[0][i] = rates[0][i] * vx;
      velocities[1][i] = rates[0][i] * vy;
      velocities[2][i] = rates[0][i] * omega;
    }
    integrate_to_nodes(*table_, velocities, ways);
    for (std::size_t i = 0; i < octets; ++i) {
      states_[i].x = start_.x + ways[0][i];
      states_[i].y = start_.y + ways[1][i];
      states_[i].phi = start_.phi + ways[2][i];
    }
    const double of_time = largest(time_change) / largest(latest), of_speed = largest(speed_change) / largest(speed);
    change = of_time > of_speed ? of_time : of_speed;
  });
  return change;
}

/// Error of the duration that the last Legendre coefficients of the pace tell of, relative to it.
double LayerCrossing::unresolved() const {
  double before_last = 0.0, last = 0.0, mean = 0.0;
  for (std::size_t i = 0; i < table_->octets(); ++i) {
    before_last += sum(table_->last[0][i] * pace_[i]);
    last += sum(table_->last[1][i] * pace_[i]);
    mean += sum(table_->weight[i] * pace_[i]);
  }
  return (std::abs(before_last) + std::abs(last)) / (static_cast<double>(table_->count) * mean);
}

/// The end, by the quadrature of the nodes, and the bounds.
void LayerCrossing::finish() {
  Octet time = 0.0, vx = 0.0, vy = 0.0, omega = 0.0, x = 0.0, y = 0.0, phi = 0.0, ax = 0.0, ay = 0.0, alpha = 0.0;
  for (std::size_t i = 0; i < table_->octets(); ++i) {
    const Octet pace = half_ * table_->weight[i] * pace_[i];
    time += pace;
    vx += pace * ax_[i];
    vy += pace * ay_[i];
    omega += pace * alpha_[i];
    x += pace * states_[i].vx;
    y += pace * states_[i].vy;
    phi += pace * states_[i].omega;
    ax = larger(ax, abs(ax_[i]));
    ay = larger(ay, abs(ay_[i]));
    alpha = larger(alpha, abs(alpha_[i]));
  }
  duration_ = sum(time);
  end_ = {start_.x + sum(x),   start_.y + sum(y),   start_.phi + sum(phi),
          start_.vx + sum(vx), start_.vy + sum(vy), start_.omega + sum(omega)};
  double least_force = normal_force_at_start_, most_force = normal_force_at_start_;
  for (std::size_t i = 0; i < table_->octets(); ++i) {
    least_force = std::min(least_force, -largest(-normal_force_[i]));
    most_force = std::max(most_force, largest(normal_force_[i]));
  }
  most_normal_force_ = least_force + kBetween * (most_force - least_force);
  most_acceleration_ = {kBetween * std::max(largest(ax), std::abs(acceleration_at_start_.x)),
                        kBetween * std::max(largest(ay), std::abs(acceleration_at_start_.y)),
                        kBetween * std::max(largest(alpha), std::abs(acceleration_at_start_.phi))};
}

/// V.
double LayerCrossing::slip_at(double place) const {
  return way_ * system_.regularization * (centre_ + kWidth * std::sinh(first_ + half_ * (1.0 + place)));
}

/// What the values at the start and at the nodes count at a place: Lagrange's polynomials.
LayerCrossing::Basis LayerCrossing::basis_at(double place) const {
  Basis basis{};
  double total = 0.0;
  for (std::size_t j = 0; j <= table_->count; ++j) {
    const double away = place - (j == 0 ? -1.0 : of_node(table_->node, j - 1));
    if (away == 0.0) {
      basis = {};
      basis[j] = 1.0;
      return basis;
    }
    basis[j] = table_->barycentric[j] / away;
    total += basis[j];
  }
  for (double& of_value : basis) of_value /= total;
  return basis;
}

double LayerCrossing::interpolate(const Basis& basis, double at_start, const Stages& at_nodes) const {
  double value = basis[0] * at_start;
  for (std::size_t j = 0; j < table_->count; ++j) value += basis[j + 1] * of_node(at_nodes, j);
  return value;
}

/// Newton's method from between the nodes next to it, within what is known to hold the place.
double LayerCrossing::place_at(double t) const {
  if (!(t > 0.0)) return -1.0;
  if (t >= duration_) return 1.0;
  double low = -1.0, high = 1.0, before = 0.0, after = duration_;
  for (std::size_t j = 0; j < table_->count; ++j) {
    const double time = of_node(time_, j), node = of_node(table_->node, j);
    if (time > t) {
      high = node;
      after = time;
      break;
    }
    low = node;
    before = time;
  }
  double place = low + (high - low) * (t - before) / (after - before);
  for (int iteration = 0; iteration < kPlaceIterations; ++iteration) {
    const Basis basis = basis_at(place);
    const double late = interpolate(basis, 0.0, time_) - t;
    const double next = place - late / (half_ * interpolate(basis, pace_at_start_, pace_));
    if (std::abs(next - place) <= kRounding) break;
    (late > 0.0 ? high : low) = place;
    place = next > low && next < high ? next : 0.5 * (low + high);
  }
  return place;
}

State LayerCrossing::state_at_place(double place) const {
  if (place == 1.0) return end_;
  const Basis basis = basis_at(place);
  const auto at = [&](double State::*coordinate, Octet StateOctet::*at_nodes) {
    double value = basis[0] * start_.*coordinate;
    for (std::size_t j = 0; j < table_->count; ++j)
      value += basis[j + 1] * (states_[j / Octet::kSize].*at_nodes)[j % Octet::kSize];
    return value;
  };
  return {at(&State::x, &StateOctet::x),   at(&State::y, &StateOctet::y),   at(&State::phi, &StateOctet::phi),
          at(&State::vx, &StateOctet::vx), at(&State::vy, &StateOctet::vy), at(&State::omega, &StateOctet::omega)};
}

ContactValues LayerCrossing::contact_at_place(double place) const {
  const PlacedState placed(state_at_place(place));
  const ContactPoint contact = contact_point(system_, placed, site_, face_, site_point(system_, placed, site_));
  const double slip = slip_at(place), normal_force = contact.push();
  return {contact.depth, normal_force, -system_.friction * std::tanh(slip / system_.regularization) * normal_force,
          slip};
}

Load3 LayerCrossing::drive_at(double t) const { return load_at(drives_, t); }

/// Golden section between the neighbours of the largest of the values at both ends and the nodes between them.
double LayerCrossing::largest_normal_force(double from, double to) const {
  constexpr double kGolden = 0.6180339887498949;
  const auto force_at = [&](double place) { return contact_at_place(place).normal_force; };
  std::array<double, GaussTable::kMost + 2> places;
  std::size_t count = 0, of_most = 0;
  places[count++] = place_at(from);
  for (std::size_t j = 0; j < table_->count; ++j) {
    const double place = of_node(table_->node, j);
    if (place > places[0]) places[count++] = place;
  }
  const double last = place_at(to);
  while (count > 1 && places[count - 1] >= last) --count;
  places[count++] = last;
  double most = force_at(places[0]);
  for (std::size_t i = 1; i < count; ++i) {
    const double force = force_at(places[i]);
    if (!(force > most)) continue;
    most = force;
    of_most = i;
  }
  if (of_most == 0 || of_most == count - 1) return most;
  double low = places[of_most - 1], high = places[of_most + 1];
  double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
  double at_left = force_at(left), at_right = force_at(right);
  for (int iteration = 0; iteration < kForceIterations; ++iteration) {
    if (at_left > at_right) {
      high = right;
      right = left;
      at_right = at_left;
      left = high - kGolden * (high - low);
      at_left = force_at(left);
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = low + kGolden * (high - low);
      at_right = force_at(right);
    }
  }
  return std::max({most, at_left, at_right});
}

LayerCrossing::Quadrature LayerCrossing::quadrature(double from, double to) const {
  const double first = place_at(from), half = 0.5 * (place_at(to) - first);
  Quadrature quadrature;
  quadrature.count = table_->count;
  for (std::size_t j = 0; j < table_->count; ++j) {
    const Basis basis = basis_at(first + half * (1.0 + of_node(table_->node, j)));
    quadrature.time[j] = interpolate(basis, 0.0, time_);
    quadrature.weight[j] = half * of_node(table_->weight, j) * half_ * interpolate(basis, pace_at_start_, pace_);
  }
  return quadrature;
}

}  // namespace vibratory_alignment
