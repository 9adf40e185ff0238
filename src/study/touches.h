// Every touch of a trial, one by one: what the sums of a TrialRow no longer show.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "mechanics/state.h"
#include "model/scene.h"
#include "study/study.h"
#include "study/table.h"
#include "trial/outcome.h"

namespace vibratory_alignment {

/// One contact from its start to its end. In the scene's own units.
struct Touch {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  Spot spot = Spot::a1;
  double time = 0.0;  ///< of its start
  double contact_time = 0.0;
  double gap = none;                                    ///< since the end of the touch before at this spot
  double peak_force = 0.0;                              ///< largest N
  double peak_before = none;                            ///< that of the touch before at this spot
  double normal_impulse = 0.0, friction_impulse = 0.0;  ///< integrals of N and T
  State state;                                          ///< at its start
};

/// The touches of a trial of the scene, in the order of their ends; with the one it starts in and the one it ends in.
/// Throws SceneError and std::invalid_argument like Simulation; a trial that fails gives those until then. `go_on` is
/// asked every Sampler::kSegmentsUnasked segments; throws std::runtime_error when it says no.
std::vector<Touch> touches_of(const Scene& scene, const std::function<bool()>& go_on = {});

/// The touches of all trials of a study as a table: index, sample and varied values of the trial; a1, a2, b1, b2 (0 or
/// 1: where it is); time, contact_time, gap, peak_force, peak_before, normal_impulse, friction_impulse, and the state
/// x ... omega at its start. Trials whose scene is refused have none. `go_on` is asked before every trial
/// and within long ones; throws std::runtime_error when it ends the table.
Table touch_table(const Study& study, const std::function<bool()>& go_on = {});

/// The same table without its rows.
Table touch_columns(const Study& study);

}  // namespace vibratory_alignment
