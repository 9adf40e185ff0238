// The schema of a scene: which keys there are, what each may be, what holds between them.
// Everything is read in the file's own units; a scene in SI units is scaled as a whole at the end.
#include "model/scene_loader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "model/scaling.h"
#include "model/setting.h"
#include "model/solver_choice.h"
#include "model/solver_names.h"
#include "model/solver_rules.h"
#include "model/tree_reader.h"
#include "model/yaml_file.h"

namespace vibratory_alignment {
namespace {

// The words for an enumerator stand at its index.
const std::vector<std::string> unit_words = {"dimensionless", "si"};
const std::vector<std::string> direction_words = {"x", "y", "phi"};
const std::vector<std::string> waveform_words = {"sine", "square", "triangle", "chirp"};
const std::vector<std::string> contact_words = {"edges", "corners", "walls"};

const NumberRule axial_stiffness_rule = {"1, the unit of stiffness in a dimensionless scene", 1.0, 1.0, true, false};

class SceneReader {
 public:
  SceneReader(const YAML::Node& tree, TreeReader::Faults& faults) : faults_(faults), root_(tree, "", faults) {}

  /// Means nothing if there are faults then.
  Scene read();

 private:
  bool is(Units units) const { return units_ == units; }
  bool lacks_walls() const { return contacts_known_ && !scene_.contacts.walls; }
  std::string unit(Quantity quantity) const { return is(Units::si) ? si_unit(quantity) : ""; }
  std::optional<double> number(TreeReader& reader, const char* key, const NumberRule& rule, Quantity quantity) const;
  double required(TreeReader& reader, const char* key, const NumberRule& rule, Quantity quantity) const;
  double number_or_zero(TreeReader& reader, const char* key, const NumberRule& rule, Quantity quantity) const;
  void refuse_unless(Units units, TreeReader& reader, const char* key) const;

  void read_units();
  void read_scales();
  void read_contacts();
  void read_part();
  void read_slot();
  void read_axes(TreeReader& gripper);
  void read_initial_state();
  void read_anchor(TreeReader& gripper);
  void read_base();
  void read_friction();
  void read_excitations();
  Excitation read_excitation(TreeReader& reader) const;
  double read_amplitude(TreeReader& reader, std::optional<Direction> direction) const;
  void read_trial();
  void read_solver();
  void choose_solver();
  void scale();

  TreeReader::Faults& faults_;
  TreeReader root_;
  std::optional<Units> units_;   ///< none: faulty; then what only one of them has is neither asked for nor refused
  bool contacts_known_ = false;  ///< false: faulty; then what needs walls is not refused
  bool names_solver_ = false;
  Scene scene_;
};

Scene SceneReader::read() {
  scene_.name = root_.line("name").value_or("");
  read_units();
  read_scales();
  read_contacts();
  read_part();
  read_slot();
  TreeReader gripper = root_.section("gripper");
  read_axes(gripper);
  read_initial_state();
  read_anchor(gripper);
  gripper.refuse_unknown_keys();
  read_base();
  read_friction();
  scene_.weight = number_or_zero(root_, "weight", not_negative_number, Quantity::force);
  read_excitations();
  read_trial();
  read_solver();
  root_.refuse_unknown_keys();
  if (faults_.empty() && is(Units::si)) scale();
  if (faults_.empty()) choose_solver();
  return scene_;
}

std::optional<double> SceneReader::number(TreeReader& reader, const char* key, const NumberRule& rule,
                                          Quantity quantity) const {
  return reader.number(key, rule, unit(quantity));
}

double SceneReader::required(TreeReader& reader, const char* key, const NumberRule& rule, Quantity quantity) const {
  return reader.required_number(key, rule, unit(quantity));
}

double SceneReader::number_or_zero(TreeReader& reader, const char* key, const NumberRule& rule,
                                   Quantity quantity) const {
  return number(reader, key, rule, quantity).value_or(0.0);
}

void SceneReader::refuse_unless(Units units, TreeReader& reader, const char* key) const {
  if (is(units)) return;
  const std::string& word = unit_words[static_cast<std::size_t>(units)];
  if (units_) reader.refuse(key, "unknown key: it is for scenes with `units: " + word + "`");
  reader.ignore(key);
}

void SceneReader::read_units() {
  const std::optional<std::size_t> word = root_.choice("units", unit_words);
  if (word) units_ = static_cast<Units>(*word);
  if (!root_.has("units")) units_ = Units::dimensionless;
  scene_.units = units_.value_or(Units::dimensionless);
}

void SceneReader::read_scales() {
  refuse_unless(Units::dimensionless, root_, "scales");
  if (!is(Units::dimensionless) || !root_.has("scales")) return;
  TreeReader scales = root_.section("scales");
  scene_.scales.emplace();
  scene_.scales->mass_kg = scales.required_number("mass", positive_number, "kg");
  scene_.scales->stiffness_n_per_m = scales.required_number("stiffness", positive_number, "N/m");
  scene_.scales->force_n = scales.required_number("force", positive_number, "N");
  scales.refuse_unknown_keys();
}

void SceneReader::read_contacts() {
  const std::size_t faults_before = faults_.size();
  for (const std::size_t word : root_.choices("contacts", contact_words)) {
    scene_.contacts.edges |= contact_words[word] == "edges";
    scene_.contacts.corners |= contact_words[word] == "corners";
    scene_.contacts.walls |= contact_words[word] == "walls";
  }
  contacts_known_ = faults_.size() == faults_before;
}

void SceneReader::read_part() {
  TreeReader part = root_.section("part");
  scene_.part.half_width = required(part, "half_width", positive_number, Quantity::length);
  scene_.part.base_distance = required(part, "base_distance", positive_number, Quantity::length);
  GripperAxis& phi = scene_.gripper.phi;
  phi.moves = part.has("inertia");
  phi.inertia = number(part, "inertia", positive_number, Quantity::inertia).value_or(1.0);
  refuse_unless(Units::si, part, "mass");
  if (is(Units::si)) scene_.gripper.y.inertia = required(part, "mass", positive_number, Quantity::mass);
  part.refuse_unknown_keys();
}

void SceneReader::read_slot() {
  TreeReader slot = root_.section("slot");
  scene_.slot.clearance = required(slot, "clearance", positive_number, Quantity::length);
  scene_.slot.depth = number(slot, "depth", positive_number, Quantity::length);
  slot.refuse_unknown_keys();
}

void SceneReader::read_axes(TreeReader& gripper) {
  GripperAxis& x = scene_.gripper.x;
  GripperAxis& y = scene_.gripper.y;
  GripperAxis& phi = scene_.gripper.phi;

  TreeReader stiffness = gripper.section("stiffness");
  y.moves = true;
  if (is(Units::si))
    y.stiffness = required(stiffness, "y", positive_number, Quantity::stiffness);
  else
    y.stiffness = stiffness.number("y", units_ ? axial_stiffness_rule : positive_number).value_or(1.0);
  x.moves = stiffness.has("x");
  if (x.moves) x.inertia = y.inertia;
  x.stiffness = number_or_zero(stiffness, "x", not_negative_number, Quantity::stiffness);
  phi.stiffness = number_or_zero(stiffness, "phi", not_negative_number, Quantity::angular_stiffness);
  stiffness.refuse_unknown_keys();

  TreeReader damping = gripper.section("damping");
  x.damping = number_or_zero(damping, "x", not_negative_number, Quantity::damping);
  y.damping = number_or_zero(damping, "y", not_negative_number, Quantity::damping);
  phi.damping = number_or_zero(damping, "phi", not_negative_number, Quantity::angular_damping);
  damping.refuse_unknown_keys();
}

void SceneReader::read_initial_state() {
  TreeReader initial = root_.section("initial");
  InitialState& state = scene_.initial;
  if (scene_.gripper.x.moves)
    state.x = required(initial, "x", any_number, Quantity::length);
  else
    state.x = number_or_zero(initial, "x", any_number, Quantity::length);
  state.y = number(initial, "y", any_number, Quantity::length);
  state.phi = number(initial, "phi", any_number, Quantity::angle);
  if (!scene_.gripper.phi.moves && !state.phi) state.phi = 0.0;
  state.vx = number_or_zero(initial, "vx", any_number, Quantity::velocity);
  state.vy = number_or_zero(initial, "vy", any_number, Quantity::velocity);
  state.omega = number_or_zero(initial, "omega", any_number, Quantity::angular_velocity);
  initial.refuse_unknown_keys();
}

void SceneReader::read_anchor(TreeReader& gripper) {
  TreeReader anchor = gripper.section("anchor");
  scene_.gripper.anchor_x = number(anchor, "x", any_number, Quantity::length).value_or(scene_.initial.x);
  scene_.gripper.anchor_y = number(anchor, "y", any_number, Quantity::length);
  scene_.gripper.anchor_phi = number_or_zero(anchor, "phi", any_number, Quantity::angle);
  scene_.gripper.pressing_force = number(gripper, "pressing_force", not_negative_number, Quantity::force);
  if (gripper.has("pressing_force") == anchor.has("y"))
    gripper.fault("pressing_force", "exactly one of gripper.pressing_force and gripper.anchor.y must be given");
  anchor.refuse_unknown_keys();
}

void SceneReader::read_base() {
  TreeReader base = root_.section("base");
  TreeReader stiffness = base.section("stiffness");
  scene_.base.stiffness_y = required(stiffness, "y", positive_number, Quantity::stiffness);
  scene_.base.stiffness_x =
      number(stiffness, "x", positive_number, Quantity::stiffness).value_or(scene_.base.stiffness_y);
  stiffness.refuse_unknown_keys();

  TreeReader damping = base.section("damping");
  scene_.base.damping_x = number_or_zero(damping, "x", not_negative_number, Quantity::damping);
  scene_.base.damping_y = number_or_zero(damping, "y", not_negative_number, Quantity::damping);
  damping.refuse_unknown_keys();

  scene_.base.recovery = base.flag("recovery").value_or(false);
  base.refuse_unknown_keys();
}

void SceneReader::read_friction() {
  if (!root_.has("friction")) return;
  TreeReader friction = root_.section("friction");
  scene_.friction.emplace();
  scene_.friction->coefficient = friction.required_number("coefficient", not_negative_number);
  scene_.friction->regularization = number(friction, "regularization", positive_number, Quantity::velocity);
  friction.refuse_unknown_keys();
}

void SceneReader::read_excitations() {
  for (TreeReader& excitation : root_.sections("excitation")) scene_.excitations.push_back(read_excitation(excitation));
  const std::size_t count = scene_.excitations.size();
  if (count > kMostExcitations)
    root_.fault("excitation", "must be a map or a list of at most " + std::to_string(kMostExcitations) +
                                  " maps; there are " + std::to_string(count));
}

Excitation SceneReader::read_excitation(TreeReader& reader) const {
  Excitation excitation;
  const auto direction = reader.choice("direction", direction_words);
  if (direction) excitation.direction = static_cast<Direction>(*direction);
  const auto waveform = reader.choice("waveform", waveform_words);
  if (waveform) excitation.waveform = static_cast<Waveform>(*waveform);

  const bool direction_known = direction || !reader.has("direction");
  excitation.amplitude = read_amplitude(reader, direction_known ? excitation.direction : std::optional<Direction>());
  excitation.frequency = required(reader, "frequency", positive_number, Quantity::frequency);
  excitation.phase = number_or_zero(reader, "phase", any_number, Quantity::angle);

  if (excitation.waveform == Waveform::chirp) {
    excitation.end_frequency = required(reader, "end_frequency", positive_number, Quantity::frequency);
    excitation.sweep_time = required(reader, "sweep_time", positive_number, Quantity::time);
  } else {
    const bool waveform_known = waveform || !reader.has("waveform");
    for (const char* key : {"end_frequency", "sweep_time"}) {
      if (waveform_known) reader.refuse(key, "only `waveform: chirp` has it");
      reader.ignore(key);
    }
  }
  reader.refuse_unknown_keys();
  return excitation;
}

/// A force, or a moment along phi. In SI units also as a displacement of the gripper, which acts through its spring.
double SceneReader::read_amplitude(TreeReader& reader, std::optional<Direction> direction) const {
  refuse_unless(Units::dimensionless, reader, "amplitude");
  for (const char* key : {"force", "displacement", "moment"}) refuse_unless(Units::si, reader, key);
  if (is(Units::dimensionless)) return reader.required_number("amplitude", any_number);
  if (!is(Units::si)) return 0.0;

  if (!direction) {
    for (const char* key : {"force", "displacement", "moment"}) reader.ignore(key);
    return 0.0;
  }
  if (*direction == Direction::phi) {
    for (const char* key : {"force", "displacement"}) reader.refuse(key, "`direction: phi` has `moment` [N m] instead");
    return required(reader, "moment", any_number, Quantity::moment);
  }
  reader.refuse("moment", "only `direction: phi` has it");
  if (reader.has("force") == reader.has("displacement"))
    reader.fault("force", "exactly one of force [N] and displacement [m] must be given");
  const double force = number_or_zero(reader, "force", any_number, Quantity::force);
  const double displacement = number_or_zero(reader, "displacement", any_number, Quantity::length);
  const GripperAxis& axis = *direction == Direction::x ? scene_.gripper.x : scene_.gripper.y;
  return reader.has("force") ? force : axis.stiffness * displacement;
}

void SceneReader::read_trial() {
  TreeReader trial = root_.section("trial");
  TrialSettings& settings = scene_.trial;
  settings.time_limit = required(trial, "time_limit", positive_number, Quantity::time);
  settings.aligned_depth = number_or_zero(trial, "aligned_depth", not_negative_number, Quantity::length);
  settings.inserted_depth = number(trial, "inserted_depth", positive_number, Quantity::length);
  settings.force_limit = number(trial, "force_limit", positive_number, Quantity::force);

  const bool has_floor = scene_.contacts.walls && scene_.slot.depth;
  if (settings.inserted_depth && lacks_walls()) trial.fault("inserted_depth", "needs `walls` among the contacts");
  if (has_floor && settings.inserted_depth.value_or(0.0) > *scene_.slot.depth)
    trial.fault("inserted_depth", "must be <= slot.depth: the floor ends the insertion");
  if (has_floor && settings.aligned_depth > *scene_.slot.depth)
    trial.fault("aligned_depth", "must be <= slot.depth: the floor ends the insertion");
  if (settings.inserted_depth && settings.aligned_depth > *settings.inserted_depth)
    trial.fault("aligned_depth", "must be <= trial.inserted_depth: a part is aligned before it is inserted");
  trial.refuse_unknown_keys();
}

void SceneReader::read_solver() {
  TreeReader solver = root_.section("solver");
  SolverSettings& settings = scene_.solver;
  std::vector<std::string> names;
  for (const SolverName& solver_name : solver_names) names.emplace_back(solver_name.name);
  const std::optional<std::size_t> chosen = solver.choice("name", names);
  if (chosen) settings.name = names[*chosen];

  settings.tolerance = solver.number("tolerance", tolerance_rule).value_or(settings.tolerance);
  settings.accuracy = solver.number("accuracy", accuracy_rule);
  settings.step = number(solver, "step", positive_number, Quantity::time);
  if (const auto limit = solver.number("step_limit", positive_whole_number))
    settings.step_limit = static_cast<long>(*limit);

  const SolverName* const known = chosen || !solver.has("name") ? find_solver(settings.name) : nullptr;
  if (known) {
    const char* unused = known->fixed_step ? "tolerance" : "step";
    const char* used = known->fixed_step ? "step" : "tolerance";
    if (solver.has(unused))
      solver.fault(unused, "solver " + settings.name + " does not use it; it has `" + used + "`");
    else if (known->fixed_step && solver.has("accuracy"))
      solver.fault("accuracy", "solver " + settings.name + " has no error control; it has `step`");
  }
  if (solver.has("accuracy") && solver.has("tolerance"))
    solver.fault("accuracy", "it chooses the tolerance; give one of solver.accuracy and solver.tolerance");
  names_solver_ = solver.has("name");
  solver.refuse_unknown_keys();
}

/// What the scene leaves open of its solver. After scaling: these are rules for dimensionless scenes.
void SceneReader::choose_solver() {
  SolverSettings& settings = scene_.solver;
  if (find_solver(settings.name)->fixed_step && !settings.step) settings.step = default_step(scene_);
  if (!settings.accuracy) return;
  if (!names_solver_) settings.name = solver_for_accuracy(scene_);
  settings.tolerance = tolerance_for_accuracy(*settings.accuracy);
}

void SceneReader::scale() {
  scene_.scales = natural_scales(scene_);
  make_dimensionless(scene_);
  visit_quantities(scene_, [this](const std::string& key_path, Quantity, double& value) {
    if (!has_sane_size(value))
      faults_.push_back(key_path + ": too large or too small, by a factor of 1e100, beside the other values");
  });
}

}  // namespace

Scene load_scene(const YAML::Node& tree, const std::string& source, const std::vector<std::string>& settings) {
  TreeReader::Faults faults;
  Scene scene = SceneReader(tree, faults).read();
  if (!faults.empty()) {
    std::vector<ValueOrigin> origins;
    for (const std::string& setting : settings) origins.push_back(origin_of_setting(setting));
    name_origins(origins, faults);
    throw SceneError(source, faults);
  }
  scene.source = source;
  if (scene.name.empty()) scene.name = std::filesystem::path(source).stem().string();
  return scene;
}

Scene load_scene_file(const std::string& path, const std::vector<std::string>& settings) {
  YAML::Node tree = read_yaml_file(path);
  for (const std::string& setting : settings) apply_setting(tree, setting);
  return load_scene(tree, path, settings);
}

}  // namespace vibratory_alignment
