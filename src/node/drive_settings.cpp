#include "node/drive_settings.h"

#include <cmath>

#include "mechanics/statics.h"
#include "mechanics/system.h"
#include "model/scaling.h"

namespace vibratory_alignment {
namespace {

struct Number {
  double AlignerConfig::*value;
  const char* name;
};
constexpr Number kNumbers[] = {
    {&AlignerConfig::amplitude, "amplitude"},   {&AlignerConfig::frequency, "frequency"},
    {&AlignerConfig::phase, "phase"},           {&AlignerConfig::pressing_force, "pressing_force"},
    {&AlignerConfig::time_scale, "time_scale"},
};

/// f0 = y_touch - y_a, also for a scene that gives anchor.y; nothing when nothing can be touched from above.
std::optional<double> pressing_force_of(const Scene& scene) {
  if (scene.gripper.pressing_force) return scene.gripper.pressing_force;
  const System system = make_system(scene);
  const std::optional<double> touch = touch_height(system, system.start.x, system.start.phi);
  if (!touch) return std::nullopt;
  return *touch - system.y.anchor;
}

/// The scene's own number while the setting shows it, to the last bit; else the setting, scaled.
double chosen(double setting, double shown, double scene_value, double unit) {
  return setting == shown ? scene_value : setting / unit;
}

}  // namespace

DriveSettings::DriveSettings(const Scene& scene, double time_scale)
    : scene_excitations_(scene.excitations), scene_pressing_force_(pressing_force_of(scene)) {
  const Excitation& first = scene_excitations_.front();
  if (scene.units == Units::si) {
    const bool turns = first.direction == Direction::phi;
    force_unit_ = si_size(Quantity::force, *scene.scales);
    amplitude_unit_ = turns ? si_size(Quantity::moment, *scene.scales) : force_unit_;
    frequency_unit_ = si_size(Quantity::frequency, *scene.scales);
  }
  config_.enabled = true;
  config_.amplitude = first.amplitude * amplitude_unit_;
  config_.frequency = first.frequency * frequency_unit_;
  config_.phase = first.phase;
  config_.waveform = static_cast<int>(first.waveform);
  config_.pressing_force = scene_pressing_force_.value_or(0.0) * force_unit_;
  config_.time_scale = time_scale;
  scene_config_ = config_;
}

void DriveSettings::undo_clamping(AlignerConfig& requested) const {
  AlignerConfig clamped = config_;
  clamped.__clamp__();
  for (const Number& number : kNumbers)
    if (requested.*number.value == clamped.*number.value) requested.*number.value = config_.*number.value;
}

std::vector<std::string> DriveSettings::change(AlignerConfig& requested) {
  std::vector<std::string> refusals;
  for (const Number& number : kNumbers) {
    if (std::isfinite(requested.*number.value)) continue;
    refusals.push_back(std::string(number.name) + ": not a finite number");
    requested.*number.value = config_.*number.value;
  }

  if (requested.waveform == static_cast<int>(Waveform::chirp) && scene_excitations_.front().sweep_time <= 0.0) {
    if (requested.waveform != config_.waveform) refusals.emplace_back("waveform: the scene gives no sweep for a chirp");
    requested.waveform = config_.waveform;
  }
  if (!scene_pressing_force_ && requested.pressing_force != config_.pressing_force) {
    refusals.emplace_back("pressing_force: at the start of the scene nothing can be touched from above");
    requested.pressing_force = config_.pressing_force;
  }
  config_ = requested;
  return refusals;
}

Scene DriveSettings::applied_to(Scene scene) const {
  scene.excitations = excitations();
  if (config_.pressing_force != scene_config_.pressing_force) {
    scene.gripper.pressing_force = pressing_force();
    scene.gripper.anchor_y.reset();
  }
  return scene;
}

std::vector<Excitation> DriveSettings::excitations() const {
  std::vector<Excitation> excitations = scene_excitations_;
  Excitation& first = excitations.front();
  first.amplitude = chosen(config_.amplitude, scene_config_.amplitude, first.amplitude, amplitude_unit_);
  first.frequency = chosen(config_.frequency, scene_config_.frequency, first.frequency, frequency_unit_);
  first.phase = config_.phase;
  first.waveform = static_cast<Waveform>(config_.waveform);
  if (!config_.enabled) first.amplitude = 0.0;
  return excitations;
}

std::optional<double> DriveSettings::pressing_force() const {
  if (!scene_pressing_force_) return std::nullopt;
  return chosen(config_.pressing_force, scene_config_.pressing_force, *scene_pressing_force_, force_unit_);
}

}  // namespace vibratory_alignment
