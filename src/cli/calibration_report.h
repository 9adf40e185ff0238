// The report of a calibration, in Markdown: how much was searched, what the best sets are and which facts they meet.
#pragma once

#include <iosfwd>

#include "study/calibration.h"

namespace vibratory_alignment {

void write_calibration_report(std::ostream& out, const Calibration& calibration, const CalibrationResult& result);

}  // namespace vibratory_alignment
