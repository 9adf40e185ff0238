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

/// Most share of V' that friction takes at the far side, as N is now: more may make V turn.
constexpr double kMostFriction = 0.95;

/// Radians of the base that a crossing may take at most: what N does in them is found by iteration.
constexpr double kMostRadians = 4.0;

/// The first guess of a duration is no farther off than by this factor.
constexpr double kSurelyTooLong = 2.0;

/// Radians of the base in which N is first guessed to go on as it does at the start.
constexpr double kFewRadians = 2.0;

/// N of a crossing is nowhere below this share of its largest.
constexpr double kLeastForce = 0.05;

/// Error that the iteration leaves, as a share of the tolerance: it is cheap.
constexpr double kIterationShare = 0.1;

/// Iterations at most, and the share of its last change that one may leave.
constexpr int kMostIterations = 16;
constexpr double kSlow = 0.6;

/// What accelerations may be larger between the nodes than at them.
constexpr double kBetween = 1.1;

/// Real part of w at V/eps = centre + 3 i pi/2, where it is i pi/2 beside this: asinh 3i.
constexpr double kNextPole = 1.7627471740390861;

/// log of the sum of the half axes of the ellipse with foci -1 and 1 through a point.
double log_ellipse(const std::complex<double>& point) {
  const std::complex<double> root = std::sqrt(point * point - 1.0);
  return std::log(std::max(std::abs(point + root), std::abs(point - root)));
}

/// What is no number may be lost in these: it spreads to all values in the next iteration.
VIBRATORY_ALIGNMENT_INLINE Octet smaller(const Octet& a, const Octet& b) {
  return {a.low < b.low ? a.low : b.low, a.high < b.high ? a.high : b.high};
}
VIBRATORY_ALIGNMENT_INLINE Octet larger(const Octet& a, const Octet& b) {
  return {a.low > b.low ? a.low : b.low, a.high > b.high ? a.high : b.high};
}

/// Integrals from the start to every node of rates at the nodes.
template <typename Stages, std::size_t kCount>
VIBRATORY_ALIGNMENT_INLINE void integrate_to_nodes(const GaussTable& table, const std::array<Stages, kCount>& rates,
                                                   std::array<Stages, kCount>& integrals) {
  for (std::size_t i = 0; i < table.octets(); ++i) {
    std::array<Octet, kCount> sum{};
    for (std::size_t octet = 0; octet < table.octets(); ++octet)
#pragma GCC unroll 8
      for (std::size_t j = 0; j < Octet::kSize; ++j)
        for (std::size_t c = 0; c < kCount; ++c)
          sum[c] += table.integral[octet * Octet::kSize + j][i] * rates[c][octet][j];
    for (std::size_t c = 0; c < kCount; ++c) integrals[c][i] = sum[c];
  }
}

}  // namespace

LayerCrossing::LayerCrossing(const System& system, double tolerance)
    : system_(system), tolerance_(std::max(tolerance, kRounding)), table_(&gauss_table(0)) {
  // made now, not in the first crossing
  for (std::size_t count = GaussTable::kLeast; count <= GaussTable::kMost; count += GaussTable::kStep)
    gauss_table(count);
}

bool LayerCrossing::take(const State& start, const DriveForms& drives, const ContactStates& contacts, Site site,
                         double longest, SolverCounts& counts) {
  start_ = start;
  drives_ = drives;
  site_ = site;
  face_ = contacts[static_cast<std::size_t>(site)].face;
  longest_ = longest;
  const long evaluations = ++counts.rhs_evaluations;
  if (!look_at_start(contacts) || !place_nodes()) return false;
  if (resolve(counts) && finish()) return true;
  counts.rejected += counts.rhs_evaluations > evaluations;
  return false;
}

/// Solves the equations with as many nodes as it takes. False where they are too many or there is no crossing.
bool LayerCrossing::resolve(SolverCounts& counts) {
  while (guess() && solve(counts)) {
    if (unresolved() <= tolerance_) return true;
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
  const Vec2 &n = contact.normal, &t = contact.tangent;
  const double normal_lever = contact.normal_lever(), tangent_lever = contact.tangent_lever();
  const auto along = [](const Vec2& axis, double lever, double ax, double ay, double alpha) {
    return axis.x * ax + axis.y * ay + lever * alpha;
  };
  const auto effect_of = [&](const Vec2& force, double lever) {
    const double ax = system_.x.inverse_inertia * force.x, ay = system_.y.inverse_inertia * force.y,
                 alpha = system_.phi.inverse_inertia * lever;
    return Effect{ax, ay, alpha, along(t, tangent_lever, ax, ay, alpha)};
  };
  of_push_ = effect_of(n, normal_lever);
  of_friction_ = effect_of(t, tangent_lever);
  slip_rate_at_start_ = along(t, tangent_lever, forces.ax, forces.ay, forces.alpha) + contact.slip_rate;
  // N = k d + h d' with d'' of now, but without T, which changes its sign
  const double depth_acceleration =
      friction_at_start_ * along(n, normal_lever, of_friction_.x, of_friction_.y, of_friction_.phi) -
      along(n, normal_lever, forces.ax, forces.ay, forces.alpha);
  push_rate_at_start_ = contact.stiffness * contact.depth_rate + contact.damping * depth_acceleration;
  push_acceleration_at_start_ = 0.5 * contact.stiffness * depth_acceleration;
  way_ = slip_rate_at_start_ < 0.0 ? -1.0 : 1.0;

  const double driven = way_ * (slip_rate_at_start_ - of_friction_.slip_rate * friction_at_start_);
  const double held = of_friction_.slip_rate * system_.friction * normal_force_at_start_;
  if (!(normal_force_at_start_ > 0.0 && held > 0.0 && held <= kMostFriction * driven)) return false;
  centre_ = std::atanh(held / driven);

  const double mobility = along(n, normal_lever, of_push_.x, of_push_.y, of_push_.phi);
  base_rate_ = std::sqrt(contact.stiffness * mobility) + contact.damping * mobility;
  return way_ * share_at_start_ < system_.tanh_saturation;
}

/// The map, its nodes, and T there. As many nodes as the nearest pole asks for. False where that is too many.
bool LayerCrossing::place_nodes() {
  first_ = std::asinh((way_ * share_at_start_ - centre_) / kWidth);
  half_ = 0.5 * (std::asinh((system_.tanh_saturation - centre_) / kWidth) - first_);
  // values at the nodes tell of the function between them to rho^-n, rho the ellipse through the nearest pole: from
  // within the layer it may be the next one, V/eps = centre + 3 i pi/2
  double log_rho = log_ellipse({-(first_ + half_) / half_, kWidth / half_});
  if (first_ > -kNextPole)
    log_rho = std::min(log_rho, log_ellipse({(kNextPole - first_ - half_) / half_, kWidth / half_}));
  const double needed = -std::log(tolerance_) / log_rho;
  if (!(needed <= static_cast<double>(GaussTable::kMost))) return false;
  table_ = &gauss_table(static_cast<std::size_t>(std::ceil(needed)));
  return true;
}

/// Collocation by iteration: with V given at the nodes, forces and accelerations follow from the states, and times and
/// states from these. False where that does not converge to a crossing.
bool LayerCrossing::solve(SolverCounts& counts) {
  integrate();
  double before = 0.0;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    evaluate();
    counts.rhs_evaluations += static_cast<long>(table_->count);
    if (!passes()) return false;
    const double change = integrate();
    const double shrinks = before > 0.0 ? change / before : kSlow;
    if (change * shrinks <= kIterationShare * tolerance_) return true;  // what the next one would change
    if (!(shrinks <= kSlow)) return false;
    before = change;
  }
  return false;
}

/// The map at the nodes, and accelerations there with N as at the start, then as it would go on from there without
/// friction. False where that takes too many radians of the base, or surely too long.
bool LayerCrossing::guess() {
  bool is_short = false;
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    const double scale = way_ * system_.regularization, friction = system_.friction;
    std::array<Stages, 1> pace, time;
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
      pace[0][i] = half_ * stretch_[i] / (slip_rate_at_start_ + of_friction_.slip_rate * more);
    }
    integrate_to_nodes(*table_, pace, time);
    const double duration = of_node(time[0], table_->count - 1), radians = base_rate_ * duration;
    is_short = radians <= kMostRadians && duration < kSurelyTooLong * longest_;
    const double goes_on = radians <= kFewRadians ? 1.0 : 0.0;
    for (std::size_t i = 0; i < table_->octets(); ++i) {
      const Octet& t = time[0][i];
      const Octet push = goes_on * t * (push_rate_at_start_ + push_acceleration_at_start_ * t);
      const Octet drag = -friction * tanh_[i] * (normal_force_at_start_ + push) - friction_at_start_;
      pace_[i] = stretch_[i] / (slip_rate_at_start_ + of_push_.slip_rate * push + of_friction_.slip_rate * drag);
      ax_[i] = acceleration_at_start_.x + of_push_.x * push + of_friction_.x * drag;
      ay_[i] = acceleration_at_start_.y + of_push_.y * push + of_friction_.y * drag;
      alpha_[i] = acceleration_at_start_.phi + of_push_.phi * push + of_friction_.phi * drag;
      time_[i] = 0.0;
      states_[i] = {start_.x, start_.y, start_.phi, start_.vx, start_.vy, start_.omega};
    }
  });
  pace_at_start_ = way_ * system_.regularization * kWidth * std::cosh(first_) / slip_rate_at_start_;
  return is_short;
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
      const Octet normal_force = normal_force_of(system_, contact, face_, c, s);
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
bool LayerCrossing::passes() {
  bool pass = false;
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    Octet slowest = pace_[0], least = normal_force_[0], most = least;
    for (std::size_t i = 1; i < table_->octets(); ++i) {
      slowest = smaller(slowest, pace_[i]);
      least = smaller(least, normal_force_[i]);
      most = larger(most, normal_force_[i]);
    }
    least_force_ = std::min(-largest(-least), normal_force_at_start_);
    most_force_ = std::max(largest(most), normal_force_at_start_);
    pass = -largest(-slowest) > 0.0 && least_force_ > kLeastForce * most_force_;
  });
  return pass;
}

/// Times, velocities and positions at the nodes from pace and accelerations. Returns the largest change at the last
/// nodes, up to which it adds up, of times relative to the duration and of velocities relative to the part's speed.
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
    const std::size_t end = octets - 1;
    const Octet& t = integrals[0][end];
    const Octet vx = start_.vx + integrals[1][end], vy = start_.vy + integrals[2][end],
                omega = start_.omega + integrals[3][end];
    const StateOctet& before = states_[end];
    const Octet of_times = abs(t - time_[end]) / t[Octet::kSize - 1],
                of_speeds = (abs(vx - before.vx) + abs(vy - before.vy) + reach * abs(omega - before.omega)) /
                            largest(abs(vx) + abs(vy) + reach * abs(omega));
    change = largest(larger(of_times, of_speeds));
    std::array<Stages, 3> velocities, ways;
    for (std::size_t i = 0; i < octets; ++i) {
      StateOctet& q = states_[i];
      time_[i] = integrals[0][i];
      q.vx = start_.vx + integrals[1][i];
      q.vy = start_.vy + integrals[2][i];
      q.omega = start_.omega + integrals[3][i];
      velocities[0][i] = rates[0][i] * q.vx;
      velocities[1][i] = rates[0][i] * q.vy;
      velocities[2][i] = rates[0][i] * q.omega;
    }
    integrate_to_nodes(*table_, velocities, ways);
    for (std::size_t i = 0; i < octets; ++i) {
      states_[i].x = start_.x + ways[0][i];
      states_[i].y = start_.y + ways[1][i];
      states_[i].phi = start_.phi + ways[2][i];
    }
  });
  return change;
}

/// Errors of times and of N between the nodes that the last Legendre coefficients tell of, the larger one, relative to
/// the duration and the largest N.
double LayerCrossing::unresolved() const {
  double error = 0.0;
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
    std::array<Octet, 2> pace{}, force{};
    Octet duration = 0.0;
    for (std::size_t i = 0; i < table_->octets(); ++i) {
      for (std::size_t k = 0; k < 2; ++k) {
        pace[k] += table_->last[k][i] * pace_[i];
        force[k] += table_->last[k][i] * normal_force_[i];
      }
      duration += table_->weight[i] * pace_[i];
    }
    const auto size = [](const std::array<Octet, 2>& last) { return std::abs(sum(last[0])) + std::abs(sum(last[1])); };
    const double of_times = size(pace) / (static_cast<double>(table_->count) * sum(duration));
    error = std::max(of_times, size(force) / most_force_);
  });
  return error;
}

/// The end, by the quadrature of the nodes, and the bounds. False where the part would be released before, or a kink or
/// limit comes.
bool LayerCrossing::finish() {
  run_widely([&]() VIBRATORY_ALIGNMENT_INLINE_LAMBDA {
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
    most_normal_force_ = least_force_ + kBetween * (most_force_ - least_force_);
    most_acceleration_ = {kBetween * std::max(largest(ax), std::abs(acceleration_at_start_.x)),
                          kBetween * std::max(largest(ay), std::abs(acceleration_at_start_.y)),
                          kBetween * std::max(largest(alpha), std::abs(acceleration_at_start_.phi))};
  });
  return duration_ < longest_ && contact_at_place(1.0).normal_force > kLeastForce * most_force_;
}

}  // namespace vibratory_alignment
