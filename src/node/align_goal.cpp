#include "node/align_goal.h"

#include <cmath>
#include <optional>
#include <sstream>
#include <string>

#include "model/package_files.h"
#include "model/scaling.h"
#include "model/scene_loader.h"

namespace vibratory_alignment {
namespace {

static_assert(static_cast<int>(Waveform::sine) == AlignGoal::SINE);
static_assert(static_cast<int>(Waveform::square) == AlignGoal::SQUARE);
static_assert(static_cast<int>(Waveform::triangle) == AlignGoal::TRIANGLE);
static_assert(static_cast<int>(Waveform::chirp) == AlignGoal::CHIRP);

/// Collects what is wrong, one line for each field.
class Faults {
 public:
  template <class Value>
  void add(const char* field, const Value& value, const std::string& allowed) {
    std::ostringstream line;
    line << field << ": " << value << ": " << allowed;
    add(line.str());
  }
  void add(const std::string& line) { lines_ += (lines_.empty() ? "" : "\n") + line; }

  /// A setting: in the range that dynamic_reconfigure has for it if the goal gives it, else 0.
  void check_setting(const char* field, double value, double AlignerConfig::*setting, const char* flag, bool given) {
    const double least = AlignerConfig::__getMin__().*setting, most = AlignerConfig::__getMax__().*setting;
    if (!given) return check_unused(field, value, flag);
    if (value >= least && value <= most) return;
    std::ostringstream allowed;
    allowed << "must be a number from " << least << " to " << most;
    add(field, value, allowed.str());
  }

  void check_unused(const char* field, double value, const char* flag) {
    if (value != 0.0) add(field, value, std::string("must be 0 while ") + flag + " is false");
  }

  void check_limit(const char* field, double value) {
    if (!(std::isfinite(value) && value >= 0.0)) add(field, value, "must be a number > 0, or 0 for the scene's");
  }

  void throw_if_any() const {
    if (!lines_.empty()) throw GoalError(lines_);
  }

 private:
  std::string lines_;
};

void check_numbers(const AlignGoal& goal, Faults& faults) {
  const bool excited = goal.set_excitation;
  faults.check_setting("amplitude", goal.amplitude, &AlignerConfig::amplitude, "set_excitation", excited);
  faults.check_setting("frequency", goal.frequency, &AlignerConfig::frequency, "set_excitation", excited);
  faults.check_setting("phase", goal.phase, &AlignerConfig::phase, "set_excitation", excited);
  const int waveform = goal.waveform;
  if (!excited) {
    faults.check_unused("waveform", waveform, "set_excitation");
  } else if (waveform > AlignGoal::CHIRP) {
    faults.add("waveform", waveform, "must be 0 sine, 1 square, 2 triangle or 3 chirp");
  }
  faults.check_setting("pressing_force", goal.pressing_force, &AlignerConfig::pressing_force, "set_pressing_force",
                       goal.set_pressing_force);
  faults.check_limit("time_limit", goal.time_limit);
  faults.check_limit("force_limit", goal.force_limit);
}

/// The scene that the goal names; nothing after a fault.
std::optional<Scene> named_scene(const std::string& name, Faults& faults) {
  try {
    return load_scene_file(find_package_file(kSceneFile, name));
  } catch (const NoSuchFile& error) {
    faults.add(std::string("scene: ") + error.what());
  } catch (const SceneError& error) {
    faults.add(error.what());
  }
  return std::nullopt;
}

std::optional<double> limit(double value, double unit) {
  return value > 0.0 ? std::optional<double>(value / unit) : std::nullopt;
}

}  // namespace

GoalPlan plan_goal(const AlignGoal& goal, const Scene& scene, const DriveSettings& settings) {
  Faults faults;
  check_numbers(goal, faults);
  std::optional<Scene> named;
  if (!goal.scene.empty()) named = named_scene(goal.scene, faults);
  faults.throw_if_any();

  GoalPlan plan{named.value_or(scene), settings, {}};
  if (named) plan.settings = DriveSettings(*named, settings.config().time_scale);
  AlignerConfig config = plan.settings.config();
  if (goal.set_excitation) {
    config.enabled = true;
    config.amplitude = goal.amplitude;
    config.frequency = goal.frequency;
    config.phase = goal.phase;
    config.waveform = goal.waveform;
  }
  if (goal.set_pressing_force) config.pressing_force = goal.pressing_force;
  for (const std::string& refusal : plan.settings.change(config)) faults.add(refusal);
  faults.throw_if_any();

  const OutputUnits units = output_units(plan.scene);
  plan.limits.time = limit(goal.time_limit, units.time);
  plan.limits.force = limit(goal.force_limit, units.force);
  return plan;
}

}  // namespace vibratory_alignment
