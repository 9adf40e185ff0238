// Excitations in closed form for tests.
#pragma once

#include <cmath>

#include "mechanics/drive.h"

namespace vibratory_alignment::test {

inline DriveForm ramp(double constant, double slope = 0.0) {
  DriveForm form;
  form.constant = constant;
  form.slope = slope;
  return form;
}

inline DriveForm sine(double amplitude, double frequency, double phase) {
  DriveForm form;
  form.amplitude = amplitude;
  form.frequency = frequency;
  form.sin_phase = std::sin(phase);
  form.cos_phase = std::cos(phase);
  return form;
}

}  // namespace vibratory_alignment::test
