// What a crossing of the tanh layer tells of any time on the way: its polynomials, by Lagrange's formula.
#include <algorithm>
#include <cmath>

#include "solver/contact_point.h"
#include "solver/layer_crossing.h"

namespace vibratory_alignment {
namespace {

/// Iterations by which a time's place is found, and the largest N.
constexpr int kPlaceIterations = 50, kForceIterations = 8;

}  // namespace

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
    if (time == t) return node;
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

/// The vertex of the parabola through three places about the largest of the values at both ends and the nodes between
/// them, and again with that and its neighbours.
double LayerCrossing::largest_normal_force(double from, double to) const {
  const auto force_at = [&](double place) { return contact_at_place(place).normal_force; };
  std::array<double, GaussTable::kMost + 2> places, forces;
  std::size_t count = 0;
  const auto add = [&](double place, double force) {
    places[count] = place;
    forces[count++] = force;
  };
  const double first = place_at(from), last = place_at(to);
  add(first, force_at(first));
  for (std::size_t j = 0; j < table_->count; ++j) {
    const double place = of_node(table_->node, j);
    if (place > first && place < last) add(place, of_node(normal_force_, j));
  }
  add(last, force_at(last));
  const auto largest = std::max_element(forces.begin(), forces.begin() + count) - forces.begin();
  if (largest == 0 || largest == static_cast<std::ptrdiff_t>(count) - 1)
    return forces[static_cast<std::size_t>(largest)];
  std::array<double, 3> place, force;
  std::copy_n(places.begin() + largest - 1, 3, place.begin());
  std::copy_n(forces.begin() + largest - 1, 3, force.begin());
  for (int iteration = 0; iteration < kForceIterations; ++iteration) {
    const double slope = (force[1] - force[0]) / (place[1] - place[0]),
                 next_slope = (force[2] - force[1]) / (place[2] - place[1]);
    const double bend = (next_slope - slope) / (place[2] - place[0]);
    const double vertex = 0.5 * (place[0] + place[1] - slope / bend);
    if (!(vertex > place[0] && vertex < place[2]) || vertex == place[1]) break;
    const double at_vertex = force_at(vertex);
    const std::size_t replaced = (vertex > place[1]) == (at_vertex > force[1]) ? 0 : 2;
    if (at_vertex > force[1]) {
      place[replaced] = place[1];
      force[replaced] = force[1];
      place[1] = vertex;
      force[1] = at_vertex;
    } else {
      place[replaced] = vertex;
      force[replaced] = at_vertex;
    }
  }
  return force[1];
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
