#include "scene_text.h"

#include <cstdio>
#include <cstdlib>
#include <vector>

#include "model/scene_loader.h"
#include "model/setting.h"
#include "model/yaml_file.h"

namespace vibratory_alignment::hunt {
namespace {

/// As few digits as give back the same double.
std::string number(double value) {
  char text[40];
  for (int digits = 1; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  return text;
}

/// A map on one line, {key: value, ...}.
class Flow {
 public:
  Flow& put(const std::string& key, const std::string& value) {
    text_ += (text_.empty() ? "" : ", ") + key + ": " + value;
    return *this;
  }
  Flow& put(const std::string& key, double value) { return put(key, number(value)); }
  Flow& put(const std::string& key, const std::optional<double>& value) { return value ? put(key, *value) : *this; }
  std::string text() const { return "{" + text_ + "}"; }

 private:
  std::string text_;
};

std::string gripper_text(const Gripper& g) {
  Flow stiffness, damping, anchor;
  if (g.x.moves) stiffness.put("x", g.x.stiffness);
  if (g.phi.stiffness != 0.0) stiffness.put("phi", g.phi.stiffness);
  damping.put("x", g.x.damping).put("y", g.y.damping).put("phi", g.phi.damping);
  anchor.put("x", g.anchor_x).put("y", g.anchor_y).put("phi", g.anchor_phi);
  return Flow()
      .put("stiffness", stiffness.text())
      .put("damping", damping.text())
      .put("anchor", anchor.text())
      .put("pressing_force", g.pressing_force)
      .text();
}

std::string base_text(const Base& base) {
  return Flow()
      .put("stiffness", Flow().put("x", base.stiffness_x).put("y", base.stiffness_y).text())
      .put("damping", Flow().put("x", base.damping_x).put("y", base.damping_y).text())
      .put("recovery", base.recovery ? "true" : "false")
      .text();
}

std::string contacts_text(const ContactFeatures& contacts) {
  std::string text;
  const auto add = [&](bool present, const char* name) {
    if (present) text += (text.empty() ? "" : ", ") + std::string(name);
  };
  add(contacts.edges, "edges");
  add(contacts.corners, "corners");
  add(contacts.walls, "walls");
  return "[" + text + "]";
}

std::string excitation_text(const Excitation& e) {
  static constexpr const char* kDirections[] = {"x", "y", "phi"};
  static constexpr const char* kWaveforms[] = {"sine", "square", "triangle", "chirp"};
  Flow flow;
  flow.put("amplitude", e.amplitude).put("frequency", e.frequency).put("phase", e.phase);
  flow.put("direction", kDirections[static_cast<int>(e.direction)]);
  flow.put("waveform", kWaveforms[static_cast<int>(e.waveform)]);
  if (e.waveform == Waveform::chirp) flow.put("end_frequency", e.end_frequency).put("sweep_time", e.sweep_time);
  return flow.text();
}

std::vector<Excitation> at_least_one(const std::vector<Excitation>& excitations) {
  if (!excitations.empty()) return excitations;
  Excitation none;
  none.frequency = 1.0;
  return {none};
}

std::string list_text(const std::vector<Excitation>& excitations) {
  std::string text;
  for (const Excitation& e : at_least_one(excitations)) text += (text.empty() ? "" : ", ") + excitation_text(e);
  return "[" + text + "]";
}

std::string change_text(const Change& change) {
  Flow flow;
  flow.put("time", change.time);
  if (change.excitations) flow.put("excitation", list_text(*change.excitations));
  flow.put("pressing_force", change.pressing_force);
  if (change.cut_late) flow.put("cut_late", "true");
  return flow.text();
}

/// `scene`: the tree whose excitations are changed.
Change read_change(const YAML::Node& change, const YAML::Node& scene, const std::string& path) {
  Change c;
  c.time = change["time"].as<double>();
  if (const YAML::Node excitation = change["excitation"]) {
    YAML::Node tree = scene;
    set_value(tree, "excitation", excitation, path);
    c.excitations = load_scene(tree, path).excitations;
  }
  if (const YAML::Node press = change["pressing_force"]) c.pressing_force = press.as<double>();
  if (const YAML::Node late = change["cut_late"]) c.cut_late = late.as<bool>();
  return c;
}

}  // namespace

std::string scene_text(const Scene& s) {
  Flow part, slot, initial, trial;
  part.put("half_width", s.part.half_width).put("base_distance", s.part.base_distance);
  if (s.gripper.phi.moves) part.put("inertia", s.gripper.phi.inertia);
  slot.put("clearance", s.slot.clearance).put("depth", s.slot.depth);
  initial.put("x", s.initial.x).put("y", s.initial.y).put("phi", s.initial.phi);
  initial.put("vx", s.initial.vx).put("vy", s.initial.vy).put("omega", s.initial.omega);
  trial.put("time_limit", s.trial.time_limit).put("aligned_depth", s.trial.aligned_depth);
  trial.put("inserted_depth", s.trial.inserted_depth);

  std::string text = "name: " + s.name + "\nunits: dimensionless\n";
  const auto section = [&](const char* key, const std::string& value) {
    text += std::string(key) + ": " + value + "\n";
  };
  section("part", part.text());
  section("slot", slot.text());
  section("gripper", gripper_text(s.gripper));
  section("base", base_text(s.base));
  section("contacts", contacts_text(s.contacts));
  if (s.friction)
    section(
        "friction",
        Flow().put("coefficient", s.friction->coefficient).put("regularization", s.friction->regularization).text());
  section("weight", number(s.weight));
  text += "excitation:\n";
  for (const Excitation& e : at_least_one(s.excitations)) text += "  - " + excitation_text(e) + "\n";
  section("initial", initial.text());
  section("trial", trial.text());
  section("solver", Flow()
                        .put("name", s.solver.name)
                        .put("tolerance", s.solver.tolerance)
                        .put("step_limit", std::to_string(s.solver.step_limit))
                        .text());
  return text;
}

std::string trial_text(const Trial& trial) {
  std::string text = scene_text(trial.scene);
  if (!trial.changes.empty()) text += "changes:\n";
  for (const Change& change : trial.changes) text += "  - " + change_text(change) + "\n";
  return text;
}

Trial load_trial_file(const std::string& path) {
  YAML::Node tree = read_yaml_file(path);
  const YAML::Node changes = tree["changes"];
  tree.remove("changes");
  Trial trial = load_scene(tree, path);
  try {
    for (const YAML::Node& change : changes) trial.changes.push_back(read_change(change, tree, path));
  } catch (const YAML::Exception& error) {
    throw SceneError(path, {"changes: " + error.msg});
  }
  return trial;
}

}  // namespace vibratory_alignment::hunt
