// The search for one set of values, with one reading of the paper and one seed: first over all ranges, then around the
// best set. What the stages are and why: calibration.h.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "study/calibration.h"
#include "study/calibration_tally.h"
#include "study/shortfall_of_sets.h"

namespace vibratory_alignment {

class CalibrationRun {
 public:
  /// Keeps references to all but the suite.
  CalibrationRun(const Calibration& calibration, std::size_t reading, std::size_t seed, const FactSuite& suite,
                 CalibrationTally& tally);

  void search_all_ranges();
  void search_around(const CalibrationRound& round);
  /// With what the last round has left.
  void search_nearby();
  const CalibratedSet& best() const { return best_; }

 private:
  enum class Method { random_search, simplex };

  void begin(const Thinning& thinning);
  void stage(Method method, const CalibrationGroup& group, double reach, std::size_t population,
             std::size_t evaluations);
  double look_at(const CalibrationGroup& group, const std::vector<double>& shares, double most);
  double shortfall_without(const CalibrationGroup& group) const;
  CalibrationAnswer ask(const std::vector<double>& values, const CalibrationGroup& group, double most);

  const Calibration& calibration_;
  const CalibrationReading& reading_;
  const FactSuite& suite_;
  CalibrationTally& tally_;
  std::unique_ptr<ShortfallOfSets> shortfall_;  ///< of the thinning at the time
  CalibratedSet best_;
  std::vector<double> best_shares_;
  std::vector<CalibrationAnswer::Part> best_parts_;  ///< of all parts
  std::size_t number_ = 0;                           ///< of sets looked at so far
  unsigned long stages_ = 0;
};

}  // namespace vibratory_alignment
