// Scenes as YAML text, for the tests of the loader.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/scene_loader.h"
#include "model/setting.h"

namespace vibratory_alignment::scene_text {

/// No more than what a dimensionless scene must give.
inline const std::string least = R"(
part: {half_width: 0.7, base_distance: 0.9}
slot: {clearance: 0.09}
gripper: {pressing_force: 0.2}
base: {stiffness: {y: 2500}}
contacts: [edges]
excitation: {amplitude: 1.0, frequency: 20.0}
trial: {time_limit: 5}
)";

/// A scene that has every section and key of a dimensionless scene.
inline const std::string full = R"(
name: full
units: dimensionless
scales: {mass: 0.1, stiffness: 4000.0, force: 8.0}
part: {half_width: 0.6, base_distance: 0.9, inertia: 0.2}
slot: {clearance: 0.09, depth: 1.0}
gripper:
  stiffness: {x: 0.08, y: 1, phi: 60.0}
  damping: {x: 0.02, y: 0.05, phi: 0.03}
  anchor: {x: 0.2, phi: 0.0}
  pressing_force: 0.2
base: {stiffness: {x: 1.0e4, y: 1.0e4}, damping: {x: 20.0, y: 20.0}, recovery: false}
contacts: [edges, corners, walls]
friction: {coefficient: 0.2, regularization: 2.0e-3}
weight: 0.0
excitation: {amplitude: 1.0, frequency: 20.0, phase: 0.0, waveform: sine, direction: y}
initial: {x: 0.2, y: 0.895, phi: 0.025, vx: 0, vy: 0, omega: 0}
trial: {time_limit: 20.0, aligned_depth: 0.02, inserted_depth: 0.9, force_limit: 50.0}
solver: {name: event, tolerance: 1.0e-8, step_limit: 1000}
)";

/// No more than what a scene in SI units must give.
inline const std::string least_si = R"(
units: si
part: {mass: 0.1, half_width: 1.0e-3, base_distance: 2.0e-3}
slot: {clearance: 1.0e-4}
gripper: {stiffness: {y: 4000}, pressing_force: 1.6}
base: {stiffness: {y: 4.0e6}}
contacts: [edges]
excitation: {force: 8.0, frequency: 100.0}
trial: {time_limit: 0.1}
)";

/// The scene of the text, after settings as --set has them.
inline Scene load(const std::string& text, const std::vector<std::string>& settings = {}) {
  YAML::Node tree = YAML::Load(text);
  for (const std::string& setting : settings) apply_setting(tree, setting);
  return load_scene(tree, "folder/scene.yaml");
}

/// The faults that the scene is refused for; none if it is not.
inline std::vector<std::string> faults(const std::string& text, const std::vector<std::string>& settings = {}) {
  try {
    load(text, settings);
  } catch (const SceneError& error) {
    return error.faults();
  }
  return {};
}

/// A file that lasts as long as the object.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& content) {
    const int descriptor = mkstemp(&path_[0]);
    if (descriptor < 0) throw std::runtime_error("cannot make " + path_);
    close(descriptor);
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TemporaryFile() { std::remove(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_ = ::testing::TempDir() + "scene_XXXXXX";
};

}  // namespace vibratory_alignment::scene_text
