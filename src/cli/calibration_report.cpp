#include "cli/calibration_report.h"

#include <cstdio>
#include <ostream>
#include <string>

#include "cli/ledger_report.h"

namespace vibratory_alignment {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

void write_searches(std::ostream& out, const Calibration& calibration, const CalibrationResult& result) {
  out << "| reading | seed | rounds | shortfall in the search | facts met on the whole studies "
         "|\n|---|---|---|---|---|\n";
  for (const CalibratedSet& set : result.best) {
    out << "| " << calibration.readings[set.reading].name << " | " << set.seed << " | " << set.rounds << " | "
        << number(set.shortfall) << " | ";
    if (set.results.empty())
      out << "not judged |\n";
    else
      out << set.met() << " of " << set.results.size() << " |\n";
  }
}

void write_counts(std::ostream& out, const CalibrationResult& result) {
  out << "| facts met on the thinned studies | sets |\n|---|---|\n";
  for (std::size_t n = result.sets_that_meet.size(); n-- > 0;)
    if (result.sets_that_meet[n] > 0) out << "| " << n << " | " << result.sets_that_meet[n] << " |\n";
}

void write_settings(std::ostream& out, const Calibration& calibration, const CalibratedSet& best) {
  const FactSettings settings = settings_of(calibration, calibration.readings[best.reading], best.values);
  out << "```\n";
  for (const std::string& setting : settings.all) out << "all: " << setting << "\n";
  for (const auto& [study, own] : settings.of_study)
    for (const std::string& setting : own) out << study << ": " << setting << "\n";
  out << "```\n";
}

}  // namespace

void write_calibration_report(std::ostream& out, const Calibration& calibration, const CalibrationResult& result) {
  const CalibratedSet& best = result.best.front();
  out << result.evaluations << " sets of " << calibration.parameters.size() << " values were looked at, "
      << result.trials << " trials. The searches began with one in " << calibration.search.thinning.grid
      << " values of a range and one in " << calibration.search.thinning.samples
      << " samples of the studies; the best sets were judged on the whole studies.\n\n";
  write_searches(out, calibration, result);
  out << "\nHow many sets meet how many facts, of those that were not given up on the way:\n\n";
  write_counts(out, result);
  out << "\n## The best set\n\nReading: " << calibration.readings[best.reading].name << ".\n\n";
  out << "| value | found | searched from | to | other searches that went through rounds |\n|---|---|---|---|---|\n";
  for (std::size_t i = 0; i < best.values.size(); ++i) {
    const CalibrationParameter& parameter = calibration.parameters[i];
    out << "| " << parameter.name << " | " << number(best.values[i]) << " | " << number(parameter.from) << " | "
        << number(parameter.to) << " | ";
    for (std::size_t other = 1; other < result.best.size() && result.best[other].rounds > 0; ++other)
      out << (other > 1 ? ", " : "") << number(result.best[other].values[i]);
    out << " |\n";
  }
  out << "\nIts facts, on the whole studies:\n\n";
  out << ledger_markdown(result.book, best.results);
  out << "\nIts settings of the scenes, by study:\n\n";
  write_settings(out, calibration, best);
}

}  // namespace vibratory_alignment
