// The shortfall of a set of values, as cheaply as a search can use it: the studies run one after the other, cheap ones
// first, and the set is given up when what it falls short of so far is more than it may.
#pragma once

#include <cstddef>
#include <vector>

#include "study/calibration.h"

namespace vibratory_alignment {

class ShortfallOfSets {
 public:
  struct Answer {
    double shortfall = 0.0;  ///< of all facts; when not whole of those that were looked at
    std::size_t met = 0;
    std::size_t trials = 0;
    bool whole = true;
  };

  /// Keeps a reference to the calibration and a copy of the suite, whose trees are used by one thread at a time.
  ShortfallOfSets(const Calibration& calibration, const CalibrationReading& reading, const FactSuite& suite);

  /// Gives up once the shortfall exceeds `most`. `go_on`: see FactRunOptions. Throws as run_calibration.
  Answer operator()(const std::vector<double>& values, double most, const std::function<bool()>& go_on) const;

 private:
  const Calibration& calibration_;
  const CalibrationReading& reading_;
  std::vector<FactSuite> parts_;  ///< facts that need the same studies, cheap ones first
};

}  // namespace vibratory_alignment
