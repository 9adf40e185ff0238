#include "study/touches.h"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>

#include "mechanics/system.h"
#include "model/scaling.h"
#include "model/scene.h"
#include "model/scene_error.h"
#include "study/design.h"
#include "study/trial_scenes.h"
#include "study/trial_table.h"
#include "trial/contact_impulse.h"
#include "trial/sampler.h"
#include "trial/simulation.h"

namespace vibratory_alignment {
namespace {

/// Follows the contacts of a trial, segment by segment. Dimensionless.
class TouchLog {
 public:
  explicit TouchLog(const System& system) : system_(system) {}

  void book(const Segment& segment) {
    for (std::size_t site = 0; site < kSiteCount; ++site) {
      const bool touching = segment.contacts[site].touching();
      if (!touching) end(site);
      if (touching && !open_[site]) begin(site, segment);
      if (touching) open_[site]->contact_time += segment.duration;
    }
    for (int i = 0; i < segment.loaded_count; ++i) {
      std::optional<Touch>& touch = open_[static_cast<std::size_t>(segment.loaded[static_cast<std::size_t>(i)].site)];
      if (!touch) continue;
      const ContactImpulse impulse = contact_impulse(system_, segment, i, 0.0, segment.duration);
      touch->normal_impulse += impulse.normal;
      touch->friction_impulse += impulse.friction;
      touch->peak_force = std::max(touch->peak_force, largest_normal_force(segment, i, 0.0, segment.duration));
    }
  }

  std::vector<Touch> finish() {
    for (std::size_t site = 0; site < kSiteCount; ++site) end(site);
    return touches_;
  }

 private:
  struct Before {
    double end = Touch::none, peak_force = Touch::none;
  };

  static std::size_t spot_index(std::size_t site) { return static_cast<std::size_t>(spot_of(static_cast<Site>(site))); }

  void begin(std::size_t site, const Segment& segment) {
    Touch touch;
    touch.spot = spot_of(static_cast<Site>(site));
    touch.time = segment.start.value();
    touch.state = segment.begin;
    const Before& before = before_[spot_index(site)];
    touch.gap = touch.time - before.end;
    touch.peak_before = before.peak_force;
    open_[site] = touch;
  }

  void end(std::size_t site) {
    if (!open_[site]) return;
    const Touch& touch = *open_[site];
    before_[spot_index(site)] = {touch.time + touch.contact_time, touch.peak_force};
    touches_.push_back(touch);
    open_[site].reset();
  }

  System system_;
  std::array<std::optional<Touch>, kSiteCount> open_;
  std::array<Before, kSpotCount> before_;
  std::vector<Touch> touches_;
};

void scale(Touch& touch, const OutputUnits& units) {
  touch.time *= units.time;
  touch.contact_time *= units.time;
  touch.gap *= units.time;
  touch.peak_force *= units.force;
  touch.peak_before *= units.force;
  touch.normal_impulse *= units.impulse;
  touch.friction_impulse *= units.impulse;
  touch.state.x *= units.length;
  touch.state.y *= units.length;
  touch.state.vx *= units.velocity;
  touch.state.vy *= units.velocity;
  touch.state.omega *= units.angular_velocity;
}

std::vector<double> values_of(const Touch& touch) {
  std::vector<double> values(kSpotCount, 0.0);
  values[static_cast<std::size_t>(touch.spot)] = 1.0;
  const State& s = touch.state;
  for (const double value : {touch.time, touch.contact_time, touch.gap, touch.peak_force, touch.peak_before,
                             touch.normal_impulse, touch.friction_impulse, s.x, s.y, s.phi, s.vx, s.vy, s.omega})
    values.push_back(value);
  return values;
}

constexpr const char* kTouchColumns[] = {
    "time", "contact_time", "gap", "peak_force", "peak_before", "normal_impulse", "friction_impulse", "x",
    "y",    "phi",          "vx",  "vy",         "omega"};

}  // namespace

std::vector<Touch> touches_of(const Scene& scene, const std::function<bool()>& go_on) {
  SimulationOptions options;
  options.energy = false;
  Simulation simulation(scene, options);
  TouchLog log(simulation.system());
  for (long segments = 0; simulation.advance(); ++segments) {
    if (segments % Sampler::kSegmentsUnasked == 0 && go_on && !go_on()) throw std::runtime_error("interrupted");
    log.book(simulation.segment());
  }
  std::vector<Touch> touches = log.finish();
  for (Touch& touch : touches) scale(touch, output_units(scene));
  return touches;
}

Table touch_columns(const Study& study) {
  Table table;
  table.names = trial_columns(study);
  for (int spot = 0; spot < kSpotCount; ++spot) table.names.emplace_back(to_string(static_cast<Spot>(spot)));
  for (const char* name : kTouchColumns) table.names.emplace_back(name);
  table.columns.resize(table.names.size());
  return table;
}

Table touch_table(const Study& study, const std::function<bool()>& go_on) {
  Table table = touch_columns(study);
  TrialScenes scenes(study);
  for (std::size_t index = 0; index < trial_count(study); ++index) {
    std::vector<Touch> touches;
    try {
      touches = touches_of(scenes.at(index), go_on);
    } catch (const SceneError&) {
      continue;
    }
    for (const Touch& touch : touches) {
      std::vector<double> values = trial_values(study, index);
      for (const double value : values_of(touch)) values.push_back(value);
      for (std::size_t i = 0; i < values.size(); ++i) table.columns[i].push_back(values[i]);
    }
  }
  return table;
}

}  // namespace vibratory_alignment
