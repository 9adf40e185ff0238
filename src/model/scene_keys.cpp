#include "model/scene_keys.h"

namespace vibratory_alignment {
namespace {

struct Section {
  std::string path;
  std::vector<std::string> keys;
};

std::vector<std::string> paths_of(const std::vector<Section>& sections) {
  std::vector<std::string> paths;
  for (const Section& section : sections) {
    if (!section.path.empty()) paths.push_back(section.path);
    for (const std::string& key : section.keys) paths.push_back((section.path.empty() ? "" : section.path + ".") + key);
  }
  return paths;
}

}  // namespace

const std::vector<std::string>& scene_keys() {
  static const std::vector<std::string> keys = paths_of({
      {"", {"name", "units", "contacts", "weight"}},
      {"scales", {"mass", "stiffness", "force"}},
      {"part", {"half_width", "base_distance", "mass", "inertia"}},
      {"slot", {"clearance", "depth"}},
      {"gripper", {"pressing_force"}},
      {"gripper.stiffness", {"x", "y", "phi"}},
      {"gripper.damping", {"x", "y", "phi"}},
      {"gripper.anchor", {"x", "y", "phi"}},
      {"base", {"recovery"}},
      {"base.stiffness", {"x", "y"}},
      {"base.damping", {"x", "y"}},
      {"friction", {"coefficient", "regularization"}},
      {"excitation",
       {"direction", "waveform", "amplitude", "force", "displacement", "moment", "frequency", "phase", "end_frequency",
        "sweep_time"}},
      {"initial", {"x", "y", "phi", "vx", "vy", "omega"}},
      {"trial", {"time_limit", "aligned_depth", "inserted_depth", "force_limit"}},
      {"solver", {"name", "tolerance", "accuracy", "step", "step_limit"}},
  });
  return keys;
}

}  // namespace vibratory_alignment
