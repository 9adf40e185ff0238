// The shortfall of a set of values, as cheaply as a search can use it: fact by fact or rather study by study, cheap
// ones first; given up when what it falls short of so far is more than it may; and only of the facts that are asked
// for.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "study/calibration.h"

namespace vibratory_alignment {

/// Values that are searched for together, and the parts of the facts that depend on them.
struct CalibrationGroup {
  std::vector<std::size_t> parameters;  ///< places in Calibration::parameters, in order
  std::vector<std::size_t> parts;       ///< places in ShortfallOfSets::parts(), in order
};

class ShortfallOfSets {
 public:
  /// Facts that need the same studies.
  struct Part {
    FactSuite suite;
    std::size_t trials = 0;  ///< that they take
  };

  /// Keeps references to the calibration and the reading, and a copy of the suite, whose trees are used by one thread
  /// at a time.
  ShortfallOfSets(const Calibration& calibration, const CalibrationReading& reading, const FactSuite& suite,
                  const Thinning& thinning);

  /// Cheap ones first. Their order and number depend on the thinning only where trials do.
  const std::vector<Part>& parts() const { return parts_; }

  /// Of those facts that `group` names. Gives up once the shortfall exceeds `most`. `go_on`: see FactRunOptions. Throws
  /// as run_calibration.
  CalibrationAnswer operator()(const std::vector<double>& values, const CalibrationGroup& group, double most,
                               const std::function<bool()>& go_on) const;

  /// All values with all facts.
  CalibrationGroup all() const;

  /// The values that settings of all studies are made of, with all facts; then those that only some studies depend on:
  /// two are in the same group when a part depends on both. A value that nothing depends on is in no group.
  std::vector<CalibrationGroup> groups() const;

 private:
  const Calibration& calibration_;
  const CalibrationReading& reading_;
  Thinning thinning_;
  std::vector<Part> parts_;
};

}  // namespace vibratory_alignment
