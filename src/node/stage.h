// One scene on the stage: the trial and everything that is made for its scene.
#pragma once

#include <optional>

#include "model/scene.h"
#include "node/drive_settings.h"
#include "node/frames.h"
#include "node/markers.h"
#include "node/messages.h"
#include "node/trial_run.h"

namespace vibratory_alignment {

/// Limits in place of the scene's, dimensionless, for one trial; none: the scene's.
struct TrialLimits {
  std::optional<double> time, force;
};

struct Stage {
  /// `settings` belong to `scene`; `interval` between two samples, dimensionless. Throws as Simulation does when the
  /// scene has no start with these settings.
  Stage(const Scene& the_scene, const DriveSettings& the_settings, const TrialLimits& limits, const Frames& frames,
        double the_interval);

  double seconds(double time) const { return time * messages.units().time; }

  Scene scene;  ///< as it was loaded
  DriveSettings settings;
  double interval;
  Messages messages;
  Markers markers;
  TrialRun trial;
};

}  // namespace vibratory_alignment
