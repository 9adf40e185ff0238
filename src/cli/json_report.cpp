#include "cli/json_report.h"

#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "model/scaling.h"

namespace vibratory_alignment {
namespace {

using nlohmann::json;

json state_object(double time, const State& state, const OutputUnits& units) {
  return {{"t", time * units.time},
          {"x", state.x * units.length},
          {"y", state.y * units.length},
          {"phi", state.phi},
          {"vx", state.vx * units.velocity},
          {"vy", state.vy * units.velocity},
          {"omega", state.omega * units.angular_velocity}};
}

json impacts_object(const std::array<long, kSpotCount>& impacts) {
  json object = json::object();
  for (int i = 0; i < kSpotCount; ++i) object[to_string(static_cast<Spot>(i))] = impacts[static_cast<size_t>(i)];
  return object;
}

json forces_object(const std::array<double, kSpotCount>& forces, double unit) {
  json object = json::object();
  for (int i = 0; i < kSpotCount; ++i) object[to_string(static_cast<Spot>(i))] = forces[static_cast<size_t>(i)] * unit;
  return object;
}

json mode_changes_array(const std::vector<ModeChange>& changes, double unit) {
  json array = json::array();
  for (const ModeChange& change : changes) {
    array.push_back({{"t", change.time * unit}, {"mode", to_string(change.mode)}});
  }
  return array;
}

json first_contact_object(const std::optional<FirstContact>& contact, const OutputUnits& units) {
  if (!contact) return nullptr;
  json object = state_object(contact->time, contact->state, units);
  object["at"] = to_string(contact->spot);
  object["approach_speed"] = contact->approach_speed * units.velocity;
  object["slip_velocity"] = contact->slip_velocity * units.velocity;
  return object;
}

json energy_object(const std::optional<EnergyLedger>& ledger, double unit) {
  if (!ledger) return nullptr;
  return {{"initial", ledger->initial * unit},
          {"final", ledger->final * unit},
          {"excitation_work", ledger->excitation_work * unit},
          {"gripper_loss", ledger->gripper_loss * unit},
          {"base_loss", ledger->base_loss * unit},
          {"friction_loss", ledger->friction_loss * unit},
          {"release_loss", ledger->release_loss * unit},
          {"turning", ledger->turning * unit},
          {"exchanged", ledger->exchanged * unit},
          {"residual", ledger->residual}};
}

json solver_object(const TrialResult& result, const OutputUnits& units) {
  json object = {{"name", result.solver_name},         {"steps", result.counts.steps},
                 {"rejected", result.counts.rejected}, {"rhs_evaluations", result.counts.rhs_evaluations},
                 {"events", result.counts.events},     {"cpu_seconds", result.cpu_seconds}};
  if (result.solver_step > 0.0) {
    object["step"] = result.solver_step * units.time;
  } else {
    object["tolerance"] = result.solver_tolerance;
  }
  if (result.solver_accuracy > 0.0) object["accuracy"] = result.solver_accuracy;
  return object;
}

}  // namespace

std::string json_report(const TrialResult& result, const Scene& scene) {
  const OutputUnits units = output_units(scene);
  json report;
  report["scene"] = result.scene;
  report["units"] = scene.units == Units::si ? "si" : "dimensionless";
  report["outcome"] = to_string(result.outcome);
  report["failure"] = result.outcome == Outcome::failed ? json(result.failure) : json(nullptr);
  report["mode"] = to_string(result.mode);
  report["mode_changes"] = mode_changes_array(result.mode_changes, units.time);
  report["duration"] = result.aligned_time ? json(*result.aligned_time * units.time) : json(nullptr);
  report["final"] = state_object(result.final_time, result.final_state, units);
  report["impacts"] = impacts_object(result.impacts);
  report["peak_force"] = forces_object(result.peak_force, units.force);
  report["force_limit_exceeded"] = result.force_limit_exceeded;
  report["first_contact"] = first_contact_object(result.first_contact, units);
  report["energy"] = energy_object(result.energy, units.energy);
  report["solver"] = solver_object(result, units);
  return report.dump(2, ' ', false, json::error_handler_t::replace);
}

}  // namespace vibratory_alignment
