#include "trial/energy.h"

#include <cmath>

#include "mechanics/contact_frame.h"
#include "solver/flight.h"

namespace vibratory_alignment {
namespace {

/// Integral of a b over the first `h` of the segment.
double integral_of_product(const Series& a, const Series& b, int order, double h) {
  Series product{};
  for (int k = 0; k <= order; ++k) product[k] = product_term(a, b, k);
  return integral(product, order, 0.0, h);
}

}  // namespace

double EnergyAccount::mechanical(const State& s) const {
  const auto axis_energy = [](const Axis& axis, double q, double v) {
    if (!axis.moves) return 0.0;
    const double stretch = q - axis.anchor;
    return 0.5 * axis.inertia * v * v + 0.5 * axis.stiffness * stretch * stretch;
  };
  return axis_energy(system_.x, s.x, s.vx) + axis_energy(system_.y, s.y, s.vy) + axis_energy(system_.phi, s.phi, s.omega) +
         system_.weight * s.y;
}

void EnergyAccount::book(const Segment& segment) {
  const bool first = !started_;
  started_ = true;
  if (first) ledger_.initial = mechanical(segment.begin);

  const int order = segment.order;
  const double h = segment.duration;
  if (segment.flight != nullptr) book_leap(segment);
  else book_series(segment);

  // base springs: what jumps between two segments has been dropped (or brought back)
  std::array<double, kSiteCount> at_start{}, at_end{};
  const double c0 = std::cos(segment.begin.phi), s0 = std::sin(segment.begin.phi);
  const double c1 = std::cos(segment.end.phi), s1 = std::sin(segment.end.phi);
  for (int i = 0; i < segment.loaded_count; ++i) {
    const ContactSeries& contact = segment.loaded[i];
    const auto site = static_cast<std::size_t>(contact.site);
    const Face face = segment.contacts[site].face;
    const double end_depth = value_at(contact.depth, order, h);
    base_stiffness_[site] = stiffness_of(system_, face, c1, s1);
    at_start[site] = 0.5 * stiffness_of(system_, face, c0, s0) * contact.depth[0] * contact.depth[0];
    at_end[site] = 0.5 * base_stiffness_[site] * end_depth * end_depth;
  }
  for (std::size_t site = 0; site < kSiteCount; ++site) {
    const ContactState& contact = segment.contacts[site];
    if (contact.phase == Phase::loaded || contact.base_deformation == 0.0) continue;
    // a base that recovers gives its energy to its own damper
    const double left = contact.base_deformation * std::exp(-contact.recovery_rate * h);
    at_start[site] = 0.5 * base_stiffness_[site] * contact.base_deformation * contact.base_deformation;
    at_end[site] = 0.5 * base_stiffness_[site] * left * left;
    ledger_.base_loss += at_start[site] - at_end[site];
  }
  double base_total = 0.0;
  for (std::size_t site = 0; site < kSiteCount; ++site) {
    if (first) ledger_.initial += at_start[site];
    else ledger_.release_loss += base_energy_[site] - at_start[site];
    base_energy_[site] = at_end[site];
    base_total += at_end[site];
  }
  book_contacts(segment);
  ledger_.final = mechanical(segment.end) + base_total;
}

/// Work and losses in the gripper during a segment given by its series.
void EnergyAccount::book_series(const Segment& segment) {
  const int order = segment.order;
  const double h = segment.duration;
  ledger_.excitation_work += integral_of_product(segment.drive_x, segment.vx, order, h) +
                             integral_of_product(segment.drive_y, segment.vy, order, h) +
                             integral_of_product(segment.drive_phi, segment.omega, order, h);
  const auto axis_loss = [&](const Axis& axis, const Series& v) {
    return axis.moves && axis.damping > 0.0 ? axis.damping * integral_of_product(v, v, order, h) : 0.0;
  };
  ledger_.gripper_loss +=
      axis_loss(system_.x, segment.vx) + axis_loss(system_.y, segment.vy) + axis_loss(system_.phi, segment.omega);
}

/// The same in closed form: Gauss-Legendre quadrature of eight points on panels of at most one radian.
void EnergyAccount::book_leap(const Segment& segment) {
  static constexpr double kNodes[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
  static constexpr double kWeights[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
  const Flight& flight = *segment.flight;
  const int panels = 1 + static_cast<int>(segment.duration * flight.rate());
  const double half = 0.5 * segment.duration / panels;
  State state;
  for (int panel = 0; panel < panels; ++panel) {
    for (int i = 0; i < 8; ++i) {
      const double node = i < 4 ? -kNodes[i] : kNodes[i - 4], weight = half * kWeights[i % 4];
      const double t = segment.flight_time + half * (2 * panel + 1 + node);
      flight.at(t, state);
      const Load3 drive = flight.drive_at(t);
      ledger_.excitation_work += weight * (drive.x * state.vx + drive.y * state.vy + drive.phi * state.omega);
      ledger_.gripper_loss += weight * (system_.x.damping * state.vx * state.vx + system_.y.damping * state.vy * state.vy +
                                        system_.phi.damping * state.omega * state.omega);
    }
  }
}

void EnergyAccount::book_contacts(const Segment& segment) {
  const int order = segment.order;
  const double h = segment.duration;
  for (int i = 0; i < segment.loaded_count; ++i) {
    const ContactSeries& contact = segment.loaded[i];
    const Face face = segment.contacts[static_cast<std::size_t>(contact.site)].face;
    Series rate{};
    for (int k = 0; k <= order; ++k) rate[k] = (k + 1) * contact.depth[k + 1];
    ledger_.friction_loss -= integral_of_product(contact.tangential_force, contact.slip_velocity, order, h);
    if (!is_part_face(face) || system_.isotropic) {
      const double damping = damping_of(system_, face, segment.cos_phi[0], segment.sin_phi[0]);
      if (damping > 0.0) ledger_.base_loss += damping * integral_of_product(rate, rate, order, h);
      continue;
    }
    // turning normal: h(n) d'^2 is lost, 1/2 k(n)' d^2 gained; k(n) and h(n) follow cos^2 phi
    const double sign = face == Face::bottom ? 1.0 : -1.0;
    Series damping{}, turning{}, depth2{}, rate2{};
    for (int k = 0; k <= order; ++k) {
      const double square = product_term(segment.cos_phi, segment.cos_phi, k);
      const double fixed = k > 0 ? 0.0 : face == Face::bottom ? system_.damping_x : system_.damping_y;
      damping[k] = sign * (system_.damping_y - system_.damping_x) * square + fixed;
      turning[k] = sign * (system_.stiffness_y - system_.stiffness_x) * square;
      depth2[k] = product_term(contact.depth, contact.depth, k);
      rate2[k] = product_term(rate, rate, k);
    }
    for (int k = 0; k < order; ++k) turning[k] = 0.5 * (k + 1) * turning[k + 1];
    turning[order] = 0.0;
    ledger_.base_loss += integral_of_product(damping, rate2, order, h);
    ledger_.turning += integral_of_product(turning, depth2, order, h);
  }
}

void EnergyAccount::move_anchor_y(double anchor_y, const State& state) {
  const double before = mechanical(state);
  system_.y.anchor = anchor_y;
  if (started_) ledger_.excitation_work += mechanical(state) - before;
}

EnergyLedger EnergyAccount::ledger() const {
  EnergyLedger ledger = ledger_;
  const double losses = ledger.gripper_loss + ledger.base_loss + ledger.friction_loss + ledger.release_loss;
  const double balance = ledger.final - ledger.initial - (ledger.excitation_work + ledger.turning - losses);
  ledger.exchanged = std::abs(ledger.initial) + std::abs(ledger.excitation_work) + std::abs(ledger.turning) +
                     ledger.gripper_loss + ledger.base_loss + ledger.friction_loss + std::abs(ledger.release_loss);
  ledger.residual = ledger.exchanged > 0.0 ? std::abs(balance) / ledger.exchanged : 0.0;
  return ledger;
}

}  // namespace vibratory_alignment
