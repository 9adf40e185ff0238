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
