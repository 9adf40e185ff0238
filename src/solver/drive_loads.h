// The excitations as the solvers with a fixed step see them: loads at instants of a step. A jump or kink inside a step
// is no end of it; the load is that of its instant.
#pragma once

#include <vector>

#include "mechanics/drive.h"

namespace vibratory_alignment {

class DriveLoads {
 public:
  /// Throws std::invalid_argument for more excitations than any solver simulates.
  DriveLoads(const std::vector<Excitation>& excitations, const Instant& now);

  /// Prepares at() for a step from `start` on.
  void begin_step(const Instant& start);

  /// Force and moment of all excitations, t after the start of the step.
  Load3 at(double t) const;

  /// True when an excitation has a kink not later than `duration` after the start of the step.
  bool has_kink(double duration) const;

  /// Goes on to the laws that hold after the step, `duration` long. The next call is begin_step() or change().
  void pass(double duration);

  /// New settings from `now` on, the end of the step.
  void change(const std::vector<Excitation>& excitations, const Instant& now);

 private:
  struct Form {
    DriveForm before, after;  ///< the laws on both sides of the kink, each from its own start
    double kink = 0.0;        ///< time to it
    double second = 0.0;      ///< ... and to the next one: from there on the law is looked for
  };

  std::vector<Drive> drives_;
  Instant start_;  ///< of the step
  std::vector<Form> forms_;
};

}  // namespace vibratory_alignment
