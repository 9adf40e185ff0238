#include "study/trial_row.h"

#include <algorithm>
#include <exception>
#include <stdexcept>

#include "mechanics/system.h"
#include "model/scaling.h"
#include "model/scene.h"
#include "model/scene_error.h"
#include "solver/solver.h"
#include "trial/contact_impulse.h"
#include "trial/simulation.h"

namespace vibratory_alignment {
namespace {

std::size_t spot_index(Site site) { return static_cast<std::size_t>(spot_of(site)); }

/// Sums up impulses and times of contact, segment by segment. Dimensionless.
class ContactTotals {
 public:
  explicit ContactTotals(const System& system) : system_(system) {}

  void book(const Segment& segment) {
    for (int i = 0; i < segment.loaded_count; ++i)
      impulses_[spot_index(segment.loaded[static_cast<std::size_t>(i)].site)] +=
          contact_impulse(system_, segment, i, 0.0, segment.duration);
    std::array<bool, kSpotCount> touching{};
    for (std::size_t site = 0; site < kSiteCount; ++site)
      if (segment.contacts[site].touching()) touching[spot_index(static_cast<Site>(site))] = true;
    for (std::size_t spot = 0; spot < kSpotCount; ++spot)
      if (touching[spot]) times_[spot] += segment.duration;
  }

  const ContactImpulse& impulse(std::size_t spot) const { return impulses_[spot]; }
  double time(std::size_t spot) const { return times_[spot]; }

 private:
  System system_;
  std::array<ContactImpulse, kSpotCount> impulses_;
  std::array<double, kSpotCount> times_{};
};

/// A trial without a change of mode has been in its mode all the time.
double nonimpact_time(const TrialResult& result) {
  if (result.mode_changes.empty()) return result.mode == Mode::nonimpact ? result.final_time : 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < result.mode_changes.size(); ++i) {
    if (result.mode_changes[i].mode != Mode::nonimpact) continue;
    const bool last = i + 1 == result.mode_changes.size();
    sum += (last ? result.final_time : result.mode_changes[i + 1].time) - result.mode_changes[i].time;
  }
  return sum;
}

TrialRow row_of(const TrialResult& result, const ContactTotals& totals, const OutputUnits& units) {
  TrialRow row;
  row.outcome = result.outcome;
  row.reason = result.failure;
  row.mode = result.mode;
  if (result.aligned_time) row.duration = *result.aligned_time * units.time;
  row.end_time = result.final_time * units.time;
  row.nonimpact_time = nonimpact_time(result) * units.time;
  const State& end = result.final_state;
  row.end = {end.x * units.length,    end.y * units.length,    end.phi,
             end.vx * units.velocity, end.vy * units.velocity, end.omega * units.angular_velocity};
  row.impacts = result.impacts;
  for (std::size_t spot = 0; spot < kSpotCount; ++spot) {
    if (const auto& times = result.impact_times[spot]) {
      row.first_impact[spot] = times->first * units.time;
      row.last_impact[spot] = times->last * units.time;
    }
    const ContactImpulse& impulse = totals.impulse(spot);
    row.peak_force[spot] = result.peak_force[spot] * units.force;
    row.normal_impulse[spot] = impulse.normal * units.impulse;
    row.friction_impulse[spot] = impulse.friction * units.impulse;
    row.impulse_x[spot] = impulse.x * units.impulse;
    row.impulse_y[spot] = impulse.y * units.impulse;
    row.contact_time[spot] = totals.time(spot) * units.time;
  }
  return row;
}

TrialRow run(const Scene& scene, const std::atomic<bool>* stop) {
  SimulationOptions options;
  options.energy = false;
  Simulation simulation(scene, options);
  ContactTotals totals(simulation.system());
  while ((stop == nullptr || !*stop) && simulation.advance()) totals.book(simulation.segment());
  return row_of(simulation.result(), totals, output_units(scene));
}

/// All faults, without the file, which is the same for all trials.
std::string reason_of(const std::exception& error) {
  const auto* refusal = dynamic_cast<const SceneError*>(&error);
  if (refusal == nullptr) return error.what();
  std::string text;
  for (const std::string& fault : refusal->faults()) text += (text.empty() ? "" : "; ") + fault;
  return text;
}

std::string on_one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

const char* outcome_word(const TrialRow& row) { return row.refused ? "refused" : to_string(row.outcome); }

TrialRow run_trial_row(const Scene& scene, std::size_t index, const std::atomic<bool>* stop) {
  TrialRow row;
  try {
    row = run(scene, stop);
  } catch (const SceneError& error) {
    row = refused_row(index, error);
  } catch (const std::invalid_argument& error) {
    row = refused_row(index, error);
  } catch (const SolverFailure& error) {
    row.outcome = Outcome::failed;
    row.reason = reason_of(error);
  }
  row.index = index;
  row.reason = on_one_line(row.reason);
  return row;
}

TrialRow refused_row(std::size_t index, const std::exception& error) {
  TrialRow row;
  row.index = index;
  row.refused = true;
  row.reason = on_one_line(reason_of(error));
  return row;
}

}  // namespace vibratory_alignment
