#include "solver/drive_series.h"

#include <algorithm>

namespace vibratory_alignment {

void DriveSeries::begin(const DriveForms& drives) {
  drives_ = &drives;
  known_ = -1;
  for (std::size_t i = 0; i < static_cast<std::size_t>(drives.count); ++i) {
    const DriveForm& form = drives.form[i];
    next_[i] = {form.amplitude * form.sin_phase, form.amplitude * form.cos_phase, 0.0, 0.0};
  }
}

/// s' = (nu + rate t) c, c' = -(nu + rate t) s.
void DriveSeries::extend_drive(std::size_t drive, int order, Series& series) {
  const DriveForm& form = drives_->form[drive];
  Wave wave = next_[drive];
  if (form.amplitude == 0.0) {
    std::fill(series.begin() + known_ + 1, series.begin() + order + 1, 0.0);
  } else if (form.rate == 0.0) {
    for (int k = known_ + 1; k <= order; ++k) {
      series[k] = wave.s;
      const double frequency = kInverse[k + 1] * form.frequency, s_next = frequency * wave.c;
      wave.c = -(frequency * wave.s);
      wave.s = s_next;
    }
  } else {
    for (int k = known_ + 1; k <= order; ++k) {
      series[k] = wave.s;
      const double frequency = kInverse[k + 1] * form.frequency, rate = kInverse[k + 1] * form.rate;
      wave = {frequency * wave.c + rate * wave.c_before, -(frequency * wave.s + rate * wave.s_before), wave.s, wave.c};
    }
  }
  next_[drive] = wave;
  if (known_ < 0) series[0] += form.constant;
  if (known_ < 1 && order >= 1) series[1] += form.slope;
}

void DriveSeries::extend(int order, Segment& segment) {
  Series* const axes[] = {&segment.drive_x, &segment.drive_y, &segment.drive_phi};
  bool driven[] = {false, false, false};
  for (std::size_t i = 0; i < static_cast<std::size_t>(drives_->count); ++i) {
    const auto axis = static_cast<std::size_t>(drives_->direction[i]);
    if (!driven[axis]) {
      extend_drive(i, order, *axes[axis]);
      driven[axis] = true;
      continue;
    }
    Series another;
    extend_drive(i, order, another);
    for (int k = known_ + 1; k <= order; ++k) (*axes[axis])[k] += another[k];
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!driven[axis]) std::fill(axes[axis]->begin() + known_ + 1, axes[axis]->begin() + order + 1, 0.0);
  known_ = order;
}

}  // namespace vibratory_alignment
