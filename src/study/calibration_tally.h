// What all searches of a calibration tell and ask: answers known from before, the count of what was looked at, and
// whether to go on.
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <vector>

#include "study/calibration.h"

namespace vibratory_alignment {

/// Called by all threads.
class CalibrationTally {
 public:
  CalibrationTally(const CalibrationOptions& options, std::size_t facts);

  std::optional<CalibrationAnswer> known(const CalibrationPlace& place, const std::vector<double>& values);
  void keep(const CalibrationPlace& place, const std::vector<double>& values, const CalibrationAnswer& answer);
  /// An answer, new or known.
  void count(const CalibrationAnswer& answer);
  /// A set all of whose facts are judged.
  void count_whole(double shortfall, std::size_t met);
  bool go_on();
  void end();
  bool ended();
  void fill(CalibrationResult& result) const;

 private:
  const CalibrationOptions& options_;
  std::mutex mutex_;
  CalibrationProgress progress_;
  std::vector<std::size_t> sets_that_meet_;
  bool ended_ = false;
};

}  // namespace vibratory_alignment
