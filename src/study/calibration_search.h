// The search for one set of values, with one reading of the paper and one seed: first over all ranges, then around the
// best set. What the stages are and why: calibration.h.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <nlopt.hpp>
#include <optional>
#include <vector>

#include "study/calibration.h"
#include "study/calibration_tally.h"
#include "study/shortfall_of_sets.h"

namespace vibratory_alignment {

class CalibrationRun {
 public:
  /// Keeps references to all of them.
  CalibrationRun(const Calibration& calibration, std::size_t reading, std::size_t seed, const FactSuite& suite,
                 CalibrationTally& tally);

  void search_all_ranges();
  void search_around(const CalibrationRound& round);
  /// With what the last round has left.
  void search_nearby();
  CalibratedSet best() const;

 private:
  /// A set, by the shares of its values in their ranges, and what is known of it so far.
  struct JudgedSet {
    std::vector<double> shares;
    std::vector<std::optional<CalibrationAnswer::Part>> parts;  ///< of the facts
    double shortfall = 0.0;                                     ///< of the parts that are known

    double shortfall_without(const CalibrationGroup& group) const;
  };

  /// What a stage of the search is to do.
  struct Stage {
    nlopt::algorithm method;
    double reach = 0.0;          ///< as a share of the ranges: of the random search, first step of the others
    std::size_t population = 0;  ///< of the random search
    std::size_t evaluations = 0;
  };

  /// The shortfall of a point of a search; no more needs to be known of one that falls short by more than `most`.
  using Objective = std::function<double(const std::vector<double>& point, double most)>;

  void begin(const Thinning& thinning);
  void seed();
  void improve(JudgedSet& set, const CalibrationGroup& group, const Stage& stage);
  void search_adapting(const CalibrationGroup& shared, const CalibrationRound& round);
  double look_at_adapted(const CalibrationGroup& shared, const std::vector<double>& point,
                         const std::vector<CalibrationGroup>& groups, const CalibrationAdaptation& adaptation);
  void minimize(const Stage& stage, const std::vector<double>& start, const std::function<bool()>& nothing_to_gain,
                const Objective& objective);
  double look_at(JudgedSet& set, const CalibrationGroup& group, const std::vector<double>& point, double most);
  bool is_shared(const CalibrationGroup& group) const;
  std::vector<double> values_of(const std::vector<double>& shares) const;
  CalibrationAnswer ask(const std::vector<double>& values, const CalibrationGroup& group, double most);

  const Calibration& calibration_;
  const CalibrationReading& reading_;
  const FactSuite& suite_;
  CalibrationTally& tally_;
  std::size_t reading_number_, seed_;
  std::unique_ptr<ShortfallOfSets> shortfall_;  ///< of the thinning at the time
  JudgedSet best_;                              ///< all of whose parts are known
  std::size_t rounds_ = 0;
  std::size_t number_ = 0;  ///< of sets looked at so far
  unsigned long stages_ = 0;
};

}  // namespace vibratory_alignment
