#include "study/calibration_tally.h"

#include <limits>

namespace vibratory_alignment {

CalibrationTally::CalibrationTally(const CalibrationOptions& options, std::size_t facts)
    : options_(options), sets_that_meet_(facts + 1) {
  progress_.best_shortfall = std::numeric_limits<double>::infinity();
}

std::optional<CalibrationAnswer> CalibrationTally::known(const CalibrationPlace& place,
                                                         const std::vector<double>& values) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!options_.known) return std::nullopt;
  return options_.known(place, values);
}

void CalibrationTally::keep(const CalibrationPlace& place, const std::vector<double>& values,
                            const CalibrationAnswer& answer) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (options_.keep) options_.keep(place, values, answer);
}

void CalibrationTally::count(const CalibrationAnswer& answer) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++progress_.evaluations;
  progress_.trials += answer.trials;
  if (options_.progress) options_.progress(progress_);
}

void CalibrationTally::count_whole(double shortfall, std::size_t met) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++sets_that_meet_[met];
  if (!(shortfall < progress_.best_shortfall)) return;
  progress_.best_shortfall = shortfall;
  progress_.best_met = met;
}

bool CalibrationTally::go_on() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!ended_ && options_.go_on && !options_.go_on()) ended_ = true;
  return !ended_;
}

void CalibrationTally::end() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ended_ = true;
}

bool CalibrationTally::ended() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return ended_;
}

void CalibrationTally::fill(CalibrationResult& result) const {
  result.evaluations = progress_.evaluations;
  result.trials = progress_.trials;
  result.sets_that_meet = sets_that_meet_;
}

}  // namespace vibratory_alignment
