#include "answer_checks.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include "../support/mirror.h"
#include "mechanics/system.h"

namespace vibratory_alignment::hunt {
namespace {

/// Error that a step may leave in a place, beside the tolerance times the part's lengths.
constexpr double kStepShare = 1e-3;

Fault fault(Invariant invariant, const std::string& what, double value) {
  std::ostringstream text;
  text.precision(10);
  text << what << " = " << value;
  return {invariant, text.str()};
}

/// Energies that the ledger adds up: their last digits are its own.
double energy_terms(const Scene& scene, const EnergyLedger& e) {
  return std::abs(e.initial) + std::abs(e.final) + e.exchanged + std::abs(scene.weight * scene.part.base_distance);
}

double size_of(const System& s, const State& q) {
  return std::abs(q.x) + std::abs(q.y) + s.half_width + s.base_distance;
}

double difference_of_places(const System& s, const State& p, const State& q) {
  const double place = std::max({std::abs(p.x - q.x), std::abs(p.y - q.y), std::abs(p.phi - q.phi) * s.half_width});
  return place / size_of(s, p);
}

/// Of a time that is known by a place: as far as the part goes in it, beside its size, where that is less.
double difference_of_times(const System& s, const Landmark& a, const Landmark& b, Compared compared) {
  const double apart = std::abs(a.time - b.time);
  if (compared == Compared::places_and_rates) return apart;
  return apart * std::min(1.0, std::max(speed_of(s, a.state), speed_of(s, b.state)) / size_of(s, a.state));
}

double difference_of_rates(const System& s, double fastest, const State& p, const State& q) {
  const double rate =
      std::max({std::abs(p.vx - q.vx), std::abs(p.vy - q.vy), std::abs(p.omega - q.omega) * s.half_width});
  return rate / (fastest + 1e-3);
}

}  // namespace

bool has_settled(const Trace& trace) {
  return trace.result.outcome == Outcome::stalled || trace.result.outcome == Outcome::jammed;
}

std::string refusal(const TrialResult& result) {
  if (result.outcome != Outcome::failed) return {};
  const std::string step_limit = "step limit";
  if (result.failure.rfind(step_limit, 0) == 0) return step_limit;
  return result.failure.substr(0, result.failure.find(" at time"));
}

std::optional<Fault> check_ending(const TrialResult& r, Range range) {
  if (r.outcome == Outcome::running) return Fault{Invariant::ends, "no outcome"};
  const std::string reason = refusal(r);
  if (range != Range::wild && !reason.empty() && reason != "step limit") return Fault{Invariant::ends, r.failure};
  return {};
}

std::optional<Fault> check_finite(const TrialResult& r) {
  const State& q = r.final_state;
  double sum = r.final_time + q.x + q.y + q.phi + q.vx + q.vy + q.omega;
  for (const double peak : r.peak_force) sum += peak;
  if (r.energy) sum += r.energy->final + r.energy->exchanged + r.energy->residual;
  if (!std::isfinite(sum)) return fault(Invariant::finite, "result", sum);
  return {};
}

std::optional<Fault> check_energy(const Scene& scene, const Trace& trace) {
  const EnergyLedger& e = *trace.result.energy;
  // the gripper's spring knows its energy to the last digits of a place, contacts to the error that steps leave in it
  const double reach = scene.part.half_width + scene.part.base_distance, digit = 1e-15 * reach;
  const auto& peaks = trace.result.peak_force;
  const double noise = 1e-12 * energy_terms(scene, e) + scene.gripper.y.stiffness * digit * digit +
                       kStepShare * scene.solver.tolerance * reach * *std::max_element(peaks.begin(), peaks.end()) +
                       trace.energy_noise;
  const double errors = takes_implicit_steps(scene) ? kStepErrors : 10.0;
  const double allowed = errors * scene.solver.tolerance * e.exchanged + noise;
  const double losses = e.gripper_loss + e.base_loss + e.friction_loss + e.release_loss;
  const double balance = e.final - e.initial - (e.excitation_work + e.turning - losses);
  if (!(std::abs(balance) <= allowed))
    return fault(Invariant::ledger_closes, "balance / exchanged", balance / e.exchanged);
  for (const auto& [name, loss] : {std::pair<const char*, double>{"gripper loss", e.gripper_loss},
                                   {"base loss", e.base_loss},
                                   {"friction loss", e.friction_loss}})
    if (loss < -allowed) return fault(Invariant::losses, name, loss);
  return {};
}

std::optional<Fault> check_same(const TrialResult& a, const TrialResult& b) {
  if (digest(a) == digest(b)) return {};
  return fault(Invariant::output_rate, "change of the final x", b.final_state.x - a.final_state.x);
}

double difference(const System& system, const Trace& a, const Trace& b, Compared compared) {
  const bool refused = a.result.outcome == Outcome::failed || b.result.outcome == Outcome::failed;
  if (!refused && (a.touches.size() != b.touches.size() || a.all_touches != b.all_touches)) return INFINITY;
  const double fastest = std::max(a.fastest, b.fastest);
  const auto between = [&](const Landmark& p, const Landmark& q) {
    const double known_by_place =
        std::max(difference_of_places(system, p.state, q.state), difference_of_times(system, p, q, compared));
    return compared == Compared::places_and_rates
               ? std::max(known_by_place, difference_of_rates(system, fastest, p.state, q.state))
               : known_by_place;
  };
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(a.touches.size(), b.touches.size()); ++i)
    largest = std::max(largest, between(a.touches[i], b.touches[i]));
  for (std::size_t i = 0; i < std::min(a.places.size(), b.places.size()); ++i)
    largest = std::max(largest, difference_of_places(system, a.places[i], b.places[i]));
  if (refused || !a.all_touches) return largest;
  if (compared == Compared::places_but_settling && (has_settled(a) || has_settled(b))) return largest;
  if (a.result.outcome != b.result.outcome) return INFINITY;
  // a motion that has settled ends with the step in which that is noticed: another one where the steps are others
  if (compared == Compared::places && has_settled(a) && a.result.final_time != b.result.final_time) return largest;
  return std::max(largest,
                  between({a.result.final_time, a.result.final_state}, {b.result.final_time, b.result.final_state}));
}

Trace mirrored(Trace trace) {
  for (Landmark& touch : trace.touches) touch.state = test::mirrored(touch.state);
  for (State& place : trace.places) place = test::mirrored(place);
  trace.result.final_state = test::mirrored(trace.result.final_state);
  std::swap(trace.result.impacts[0], trace.result.impacts[1]);
  std::swap(trace.result.impacts[2], trace.result.impacts[3]);
  return trace;
}

}  // namespace vibratory_alignment::hunt
