#include "solver/drive_series.h"

#include <algorithm>
#include <cstring>

namespace vibratory_alignment {

Load3 load_at(const DriveForms& drives, double t) {
  Load3 load;
  for (int i = 0; i < drives.count; ++i) {
    const double value = drives.form[i].at(t);
    (drives.direction[i] == Direction::x ? load.x : drives.direction[i] == Direction::y ? load.y : load.phi) += value;
  }
  return load;
}

void DriveSeries::begin(const DriveForms& drives) {
  drives_ = &drives;
  known_ = -1;
  for (std::size_t i = 0; i < static_cast<std::size_t>(drives.count); ++i) {
    const DriveForm& form = drives.form[i];
    Wave& wave = waves_[i];
    if (form.rate == 0.0) {
      set_powers(form.frequency, wave);
      continue;
    }
    wave.frequency = NAN;
    wave.s = form.amplitude * form.sin_phase;
    wave.c = form.amplitude * form.cos_phase;
    wave.s_before = wave.c_before = 0.0;
  }
}

void DriveSeries::set_powers(double frequency, Wave& wave) {
  if (wave.frequency == frequency) return;
  wave.frequency = frequency;
  wave.terms[0] = 1.0;
  for (std::size_t k = 1; k < wave.terms.size(); ++k) wave.terms[k] = wave.terms[k - 1] * (frequency * kInverse[k]);
}

/// s' = (nu + rate t) c, c' = -(nu + rate t) s.
void DriveSeries::extend_chirp(const DriveForm& form, int order, Wave& wave) const {
  for (int k = known_ + 1; k <= order; ++k) {
    wave.terms[k] = wave.s;
    const double frequency = kInverse[k + 1] * form.frequency, rate = kInverse[k + 1] * form.rate;
    const double s = frequency * wave.c + rate * wave.c_before, c = -(frequency * wave.s + rate * wave.s_before);
    wave.s_before = wave.s;
    wave.c_before = wave.c;
    wave.s = s;
    wave.c = c;
  }
}

/// Powers `from` to `order` of a drive, four at a time, into the series of its axis: of its first drive, or added.
void DriveSeries::put(const DriveForm& form, const Wave& wave, bool first, int from, int order, Series& series) const {
  // the derivatives of a sine are its sine and cosine, again and again
  const double s = form.amplitude * form.sin_phase, c = form.amplitude * form.cos_phase;
  const Quad factor = form.rate == 0.0 ? Quad{s, c, -s, -c} : Quad{1.0, 1.0, 1.0, 1.0};
  for (int k = from; k <= order; k += 4) {
    Quad terms, before{};
    std::memcpy(&terms, &wave.terms[k], sizeof terms);
    if (!first) std::memcpy(&before, &series[k], sizeof before);
    const Quad sum = before + factor * terms;
    std::memcpy(&series[k], &sum, sizeof sum);
  }
  if (from > 0) return;
  series[0] += form.constant;
  series[1] += form.slope;
}

void DriveSeries::extend(int order, Segment& segment) {
  if (order <= known_) return;
  const int from = (known_ + 1) / 4 * 4;
  Series* const axes[] = {&segment.drive_x, &segment.drive_y, &segment.drive_phi};
  bool driven[] = {false, false, false};
  for (std::size_t i = 0; i < static_cast<std::size_t>(drives_->count); ++i) {
    const auto axis = static_cast<std::size_t>(drives_->direction[i]);
    const DriveForm& form = drives_->form[i];
    if (form.rate != 0.0) extend_chirp(form, order, waves_[i]);
    put(form, waves_[i], !driven[axis], from, order, *axes[axis]);
    driven[axis] = true;
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!driven[axis]) std::fill(axes[axis]->begin() + from, axes[axis]->begin() + order + 1, 0.0);
  known_ = order;
}

}  // namespace vibratory_alignment
