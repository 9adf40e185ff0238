// What a goal of the action ~align asks for, checked.
#pragma once

#include <stdexcept>

#include <vibratory_alignment/AlignGoal.h>

#include "model/scene.h"
#include "node/drive_settings.h"
#include "node/stage.h"

namespace vibratory_alignment {

/// A goal that cannot be carried out; what() has one line for each fault: field, value, what is allowed.
class GoalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct GoalPlan {
  Scene scene;
  DriveSettings settings;
  TrialLimits limits;
};

/// The scene and settings in force are `scene` and `settings`. Throws GoalError with every fault, also those of the
/// scene that the goal names.
GoalPlan plan_goal(const AlignGoal& goal, const Scene& scene, const DriveSettings& settings);

}  // namespace vibratory_alignment
