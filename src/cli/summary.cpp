#include "cli/summary.h"

#include <cstdarg>
#include <cstdio>
#include <vector>

#include "model/scaling.h"

namespace vibratory_alignment {
namespace {

/// printf into a string; long texts are cut.
__attribute__((format(printf, 1, 2))) std::string format(const char* pattern, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

/// A unit in which people read a quantity: `factor` of them make one dimensionless unit.
struct ReadingUnit {
  double factor;
  const char* name;
};

struct ReadingUnits {
  ReadingUnit time, length, angle, velocity, angular_velocity, force;
};

ReadingUnits si_units(const Scales& scales) {
  const OutputUnits units = si_output_units(scales);
  return {{1e3 * units.time, "ms"},       {1e3 * units.length, "mm"},        {1.0, "rad"},
          {1e3 * units.velocity, "mm/s"}, {units.angular_velocity, "rad/s"}, {units.force, "N"}};
}

constexpr ReadingUnits kDimensionless = {{1, ""}, {1, ""}, {1, ""}, {1, ""}, {1, ""}, {1, ""}};

/// Collects the lines; every quantity is given in each of the unit systems that the scene has.
class Report {
 public:
  explicit Report(const Scene& scene) {
    if (scene.units == Units::dimensionless) systems_.push_back(kDimensionless);
    if (scene.scales) systems_.push_back(si_units(*scene.scales));
  }

  /// "7.1423 (35.71 ms)"
  std::string in_line(double value, ReadingUnit ReadingUnits::*quantity) const {
    std::string text = one(value, systems_.front().*quantity, "%.5g");
    if (systems_.size() > 1) text += " (" + one(value, systems_.back().*quantity, "%.4g") + ")";
    return text;
  }

  void text(const char* label, const std::string& value) { line(format("%-14s", label) + value); }

  /// A row of numbers in columns, one column group a unit system.
  void row(const char* label, double value, ReadingUnit ReadingUnits::*quantity) {
    std::string text = format("  %-12s", label);
    for (const ReadingUnits& system : systems_) {
      text += format("%14.7g %-6s", value * (system.*quantity).factor, (system.*quantity).name);
    }
    line(text);
  }

  /// A row of the four spots.
  template <class Value>
  void spots(const char* label, const std::array<Value, kSpotCount>& values, double factor, const char* unit) {
    std::string text = format("%-14s", label);
    for (const Value value : values) text += format("%12.6g", static_cast<double>(value) * factor);
    line(text + " " + unit);
  }

  void forces(const std::array<double, kSpotCount>& values) {
    const char* label = "Peak force";
    for (const ReadingUnits& system : systems_) {
      spots(label, values, system.force.factor, system.force.name);
      label = "";
    }
  }

  void blank() { line(""); }
  const std::string& str() const { return text_; }

 private:
  void line(const std::string& text) { text_ += text.substr(0, text.find_last_not_of(' ') + 1) + "\n"; }

  static std::string one(double value, const ReadingUnit& unit, const char* pattern) {
    char number[32];
    std::snprintf(number, sizeof number, pattern, value * unit.factor);
    return *unit.name == 0 ? number : format("%s %s", number, unit.name);
  }

  std::vector<ReadingUnits> systems_;
  std::string text_;
};

/// Words for a trial that was ended before its outcome, by its time limit or by --until.
std::string ended_early(const TrialResult& result, const Scene& scene, const Report& report) {
  const std::string what = result.aligned_time ? "not inserted " : "not aligned ";
  if (result.final_time >= scene.trial.time_limit) return what + "within the time limit";
  return what + "by " + report.in_line(result.final_time, &ReadingUnits::time) + ", where the trial was to end";
}

/// Words for an outcome, without the alignment that an earlier part of the trial may have seen.
std::string outcome_words(const TrialResult& result, const Scene& scene, const Report& report) {
  switch (result.outcome) {
    case Outcome::running: return "still running at " + report.in_line(result.final_time, &ReadingUnits::time);
    case Outcome::aligned: return "aligned";
    case Outcome::inserted: return "inserted";
    case Outcome::jammed: return "jammed: at rest in the slot before it was inserted";
    case Outcome::stalled: return "stalled: the motion has settled without alignment";
    case Outcome::time_limit: return ended_early(result, scene, report);
    case Outcome::failed: return "failed: " + result.failure;
  }
  return to_string(result.outcome);
}

std::string outcome_text(const TrialResult& result, const Scene& scene, const Report& report) {
  const std::string words = outcome_words(result, scene, report);
  if (!result.aligned_time) return words;
  const std::string after = " after " + report.in_line(*result.aligned_time, &ReadingUnits::time);
  return result.outcome == Outcome::aligned ? words + after : words + "; aligned" + after;
}

std::string energy_text(const EnergyLedger& energy) {
  const bool closes = energy.residual <= kLargestResidual;
  return format("balance closes to %.2g of what was exchanged", energy.residual) +
         (closes ? "" : ": the motion is not to be trusted");
}

std::string mode_text(const TrialResult& result, const Report& report) {
  std::string text = to_string(result.mode);
  if (result.mode_changes.size() < 2) return text;
  constexpr std::size_t kShown = 6;
  const char* separator = ": ";
  for (std::size_t i = 0; i < result.mode_changes.size() && i < kShown; ++i) {
    const ModeChange& change = result.mode_changes[i];
    text +=
        separator + std::string(to_string(change.mode)) + " from " + report.in_line(change.time, &ReadingUnits::time);
    separator = ", ";
  }
  if (result.mode_changes.size() > kShown) text += format(", ... (%zu changes in all)", result.mode_changes.size() - 1);
  return text;
}

std::string first_contact_text(const std::optional<FirstContact>& contact, const Report& report) {
  if (!contact) return "none";
  return format("%s at ", to_string(contact->spot)) + report.in_line(contact->time, &ReadingUnits::time) +
         ", approach speed " + report.in_line(contact->approach_speed, &ReadingUnits::velocity) + ", slip velocity " +
         report.in_line(contact->slip_velocity, &ReadingUnits::velocity);
}

std::string solver_text(const TrialResult& result, const Report& report) {
  std::string text = result.solver_name + ", ";
  text += result.solver_step > 0.0 ? "step " + report.in_line(result.solver_step, &ReadingUnits::time)
                                   : format("tolerance %.3g", result.solver_tolerance);
  if (result.solver_accuracy > 0.0) text += format(", for accuracy %.3g", result.solver_accuracy);
  return text + format("; %ld steps (%ld rejected), %ld evaluations, %ld events, %.3g ms of CPU time",
                       result.counts.steps, result.counts.rejected, result.counts.rhs_evaluations, result.counts.events,
                       1e3 * result.cpu_seconds);
}

}  // namespace

std::string summary(const TrialResult& result, const Scene& scene) {
  Report report(scene);
  const State& state = result.final_state;
  report.text("Scene",
              result.scene +
                  (scene.units == Units::si
                       ? ""
                       : " (dimensionless" + std::string(scene.scales ? ", in brackets and on the right: SI)" : ")")));
  report.text("Outcome", outcome_text(result, scene, report));
  report.text("Mode", mode_text(result, report));
  report.text("First contact", first_contact_text(result.first_contact, report));
  report.blank();
  report.text("At the end", "");
  report.row("time", result.final_time, &ReadingUnits::time);
  report.row("x", state.x, &ReadingUnits::length);
  report.row("y", state.y, &ReadingUnits::length);
  report.row("tilt phi", state.phi, &ReadingUnits::angle);
  report.row("vx", state.vx, &ReadingUnits::velocity);
  report.row("vy", state.vy, &ReadingUnits::velocity);
  report.row("omega", state.omega, &ReadingUnits::angular_velocity);
  report.blank();
  report.text("", format("%12s%12s%12s%12s", "edge a1", "edge a2", "corner b1", "corner b2"));
  report.spots("Impacts", result.impacts, 1.0, "");
  report.forces(result.peak_force);
  if (result.force_limit_exceeded) {
    report.text("", "The force limit " + report.in_line(scene.trial.force_limit.value_or(0.0), &ReadingUnits::force) +
                        " was exceeded.");
  }
  report.blank();
  if (result.energy) report.text("Energy", energy_text(*result.energy));
  report.text("Solver", solver_text(result, report));
  return report.str();
}

}  // namespace vibratory_alignment
