#include "solver/drive_loads.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "solver/motion_series.h"

namespace vibratory_alignment {

DriveLoads::DriveLoads(const std::vector<Excitation>& excitations, const Instant& now) : forms_(excitations.size()) {
  if (excitations.size() > DriveForms::kMax)
    throw std::invalid_argument("at most " + std::to_string(DriveForms::kMax) + " excitations are simulated");
  drives_.reserve(excitations.size());
  for (const Excitation& excitation : excitations) drives_.emplace_back(excitation, now);
}

void DriveLoads::begin_step(const Instant& start) {
  start_ = start;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    forms_[i].before = drives_[i].form_at(start);
    forms_[i].kink = forms_[i].second = drives_[i].time_to_kink(start);
    if (!std::isfinite(forms_[i].kink)) continue;
    Drive beyond = drives_[i];
    beyond.pass_kink();
    const Instant at_kink = start + forms_[i].kink;
    forms_[i].after = beyond.form_at(at_kink);
    forms_[i].second += beyond.time_to_kink(at_kink);
  }
}

Load3 DriveLoads::at(double t) const {
  Load3 load;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const Form& form = forms_[i];
    double value = t < form.kink ? form.before.at(t) : form.after.at(t - form.kink);
    if (t > form.second) {
      Drive beyond = drives_[i];
      beyond.go_to(start_ + t);
      value = beyond.form_at(start_ + t).at(0.0);
    }
    switch (drives_[i].direction()) {
      case Direction::x: load.x += value; break;
      case Direction::y: load.y += value; break;
      case Direction::phi: load.phi += value; break;
    }
  }
  return load;
}

bool DriveLoads::has_kink(double duration) const {
  return std::any_of(forms_.begin(), forms_.end(), [&](const Form& form) { return form.kink <= duration; });
}

void DriveLoads::pass(double duration) {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (forms_[i].second < duration)
      drives_[i].go_to(start_ + duration);
    else if (forms_[i].kink <= duration)
      drives_[i].pass_kink();
  }
}

void DriveLoads::change(const std::vector<Excitation>& excitations, const Instant& now) {
  for (std::size_t i = 0; i < drives_.size() && i < excitations.size(); ++i) drives_[i].change(excitations[i], now);
}

}  // namespace vibratory_alignment
