#include "trial/energy.h"

#include <cmath>

#include "mechanics/contact_frame.h"
#include "mechanics/tilt.h"
#include "solver/flight.h"
#include "solver/layer_crossing.h"
#include "solver/solver.h"

namespace vibratory_alignment {
namespace {

/// Gauss-Legendre quadrature of twelve points on [-1, 1]: the nodes > 0.
constexpr double kNodes[6] = {0.1252334085114689, 0.3678314989981802, 0.5873179542866175,
                              0.7699026741943047, 0.9041172563704749, 0.9815606342467193};
constexpr double kWeights[6] = {0.2491470458134028, 0.2334925365383548, 0.2031674267230659,
                                0.1600783285433462, 0.1069393259953184, 0.0471753363865118};

/// Longest panel in radians of the flight's fastest motion: the products turn twice as fast.
constexpr double kPanel = 2.0;

/// Last digits of a place, beside the part's size.
constexpr double kPlaceRounding = 1e-15;

/// Series of this order hold for a panel. Longer ones, of straight motion, hold for two.
constexpr int kPanelOrder = 22;

}  // namespace

double EnergyAccount::mechanical(const State& s) const {
  const auto axis_energy = [](const Axis& axis, double q, double v) {
    if (!axis.moves) return 0.0;
    const double stretch = q - axis.anchor;
    return 0.5 * axis.inertia * v * v + 0.5 * axis.stiffness * stretch * stretch;
  };
  return axis_energy(system_.x, s.x, s.vx) + axis_energy(system_.y, s.y, s.vy) +
         axis_energy(system_.phi, s.phi, s.omega) + system_.weight * s.y;
}

void EnergyAccount::book(const Segment& segment) {
  const bool first = !started_;
  started_ = true;
  if (first) ledger_.initial = mechanical(segment.begin);

  const auto relaxations = relaxations_in(segment);
  if (segment.layer_crossing != nullptr) {
    const auto [count, time, weight] = segment.layer_crossing->quadrature(0.0, segment.duration);
    for (std::size_t i = 0; i < count; ++i) book_powers(segment, relaxations, time[i], weight[i]);
  } else {
    const double rate = segment.flight ? segment.flight->rate(segment.flight_time) : 0.0;
    const int panels = (segment.order > kPanelOrder ? 2 : 1) + static_cast<int>(segment.duration * rate / kPanel);
    const double half = 0.5 * segment.duration / panels;
    for (int panel = 0; panel < panels; ++panel)
      for (int i = 0; i < 12; ++i) {
        const double node = i < 6 ? -kNodes[i] : kNodes[i - 6];
        book_powers(segment, relaxations, half * (2 * panel + 1 + node), half * kWeights[i % 6]);
      }
  }

  // base springs: what jumps between two segments has been dropped (or brought back)
  std::array<double, kSiteCount> at_start{}, at_end{};
  const auto [c0, s0] = tilt_of(segment.begin.phi);
  const auto [c1, s1] = tilt_of(segment.end.phi);
  for (int i = 0; i < segment.loaded_count; ++i) {
    const ContactSeries& contact = segment.loaded[i];
    const auto site = static_cast<std::size_t>(contact.site);
    const Face face = segment.contacts[site].face;
    const double start_depth = contact_at(segment, i, 0.0).depth;
    const double end_depth = contact_at(segment, i, segment.duration).depth;
    at_start[site] = 0.5 * stiffness_of(system_, face, c0, s0) * start_depth * start_depth;
    at_end[site] = 0.5 * stiffness_of(system_, face, c1, s1) * end_depth * end_depth;
  }
  for (std::size_t site = 0; site < kSiteCount; ++site) {
    if (!relaxations[site]) continue;
    // a base that recovers gives its energy to its own damper, and what its turning normal brings in (book_powers)
    const Recovery& base = segment.recoveries[site];
    const double left = relaxations[site]->deformation_at(segment.duration);
    at_start[site] = 0.5 * stiffness_of(system_, base.face, c0, s0) * base.deformation * base.deformation;
    at_end[site] = 0.5 * stiffness_of(system_, base.face, c1, s1) * left * left;
    ledger_.base_loss += at_start[site] - at_end[site];
  }
  double base_total = 0.0;
  for (std::size_t site = 0; site < kSiteCount; ++site) {
    if (first)
      ledger_.initial += at_start[site];
    else
      ledger_.release_loss += base_energy_[site] - at_start[site];
    base_energy_[site] = at_end[site];
    base_total += at_end[site];
  }
  ledger_.final = mechanical(segment.end) + base_total;
  const double sum = ledger_.final + ledger_.excitation_work + ledger_.gripper_loss + ledger_.base_loss +
                     ledger_.friction_loss + ledger_.release_loss + ledger_.turning;
  if (!std::isfinite(sum)) throw SolverFailure("the energy is no longer finite");
}

/// How the bases go on that recover in the segment.
EnergyAccount::Relaxations EnergyAccount::relaxations_in(const Segment& segment) const {
  Relaxations relaxations;
  for (std::size_t site = 0; site < kSiteCount; ++site) {
    const Recovery& base = segment.recoveries[site];
    if (segment.contacts[site].phase != Phase::loaded && base.deformation != 0.0)
      relaxations[site].emplace(system_, segment, base);
  }
  return relaxations;
}

/// All powers at time t of the segment, times `weight`.
void EnergyAccount::book_powers(const Segment& segment, const Relaxations& relaxations, double t, double weight) {
  const State s = state_at(segment, t);
  const Load3 drive = drive_at(segment, t);
  ledger_.excitation_work += weight * (drive.x * s.vx + drive.y * s.vy + drive.phi * s.omega);
  ledger_.gripper_loss += weight * (system_.x.damping * s.vx * s.vx + system_.y.damping * s.vy * s.vy +
                                    system_.phi.damping * s.omega * s.omega);
  const bool base_turns = system_.recovery && !system_.isotropic;
  if (segment.loaded_count == 0 && !base_turns) return;
  const Tilt tilt = tilt_of(s.phi);
  // the normal of a deformed base turns: 1/2 (dk/dphi) phi' d^2
  const auto turning = [&](Face face, double depth) {
    return weight * 0.5 * stiffness_slope_of(system_, face, tilt.cos, tilt.sin) * s.omega * depth * depth;
  };
  if (base_turns)
    for (std::size_t site = 0; site < kSiteCount; ++site) {
      if (!relaxations[site]) continue;
      const double brought_in = turning(segment.recoveries[site].face, relaxations[site]->deformation_at(t));
      ledger_.turning += brought_in;
      ledger_.base_loss += brought_in;
    }
  for (int i = 0; i < segment.loaded_count; ++i) {
    const ContactSeries& contact = segment.loaded[i];
    const Face face = segment.contacts[static_cast<std::size_t>(contact.site)].face;
    const ContactValues values = contact_at(segment, i, t);
    const double damping = damping_of(system_, face, tilt.cos, tilt.sin);
    double depth = values.depth;
    if (damping > 0.0) {
      // of the velocities: the slope of a depth is its last digit over the length of the segment
      const Vec2 point = site_point(system_, s, contact.site, tilt.cos, tilt.sin);
      const ContactKinematics k = contact_kinematics(system_, s, contact.site, face, point, tilt.cos, tilt.sin);
      double force = damping * k.depth_rate;
      if (segment.coarse) {
        // what an implicit step passes over shows in its velocities, but does not act
        depth = k.depth;
        force = values.normal_force - stiffness_of(system_, face, tilt.cos, tilt.sin) * depth;
      }
      ledger_.base_loss += weight * force * k.depth_rate;
    }
    ledger_.friction_loss -= weight * values.tangential_force * values.slip_velocity;
    if (!system_.isotropic) ledger_.turning += turning(face, depth);
  }
}

void EnergyAccount::move_anchor_y(double anchor_y, const State& state) {
  const double before = mechanical(state);
  system_.y.anchor = anchor_y;
  if (!started_) return;
  const double work = mechanical(state) - before;
  ledger_.excitation_work += work;
  ledger_.final += work;
}

EnergyLedger EnergyAccount::ledger() const {
  EnergyLedger ledger = ledger_;
  const double losses = ledger.gripper_loss + ledger.base_loss + ledger.friction_loss + ledger.release_loss;
  const double balance = ledger.final - ledger.initial - (ledger.excitation_work + ledger.turning - losses);
  ledger.exchanged = std::abs(ledger.initial) + std::abs(ledger.excitation_work) + std::abs(ledger.turning) +
                     ledger.gripper_loss + ledger.base_loss + ledger.friction_loss + std::abs(ledger.release_loss);
  // a trial that ends where it began exchanges nothing: less than the last digits of a place, squared, in the spring
  const double digit = kPlaceRounding * (system_.half_width + system_.base_distance);
  ledger.residual = ledger.exchanged > system_.y.stiffness * digit * digit ? std::abs(balance) / ledger.exchanged : 0.0;
  return ledger;
}

}  // namespace vibratory_alignment
