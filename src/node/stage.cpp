#include "node/stage.h"

namespace vibratory_alignment {
namespace {

Scene with_limits(Scene scene, const TrialLimits& limits) {
  if (limits.time) scene.trial.time_limit = *limits.time;
  if (limits.force) scene.trial.force_limit = limits.force;
  return scene;
}

}  // namespace

Stage::Stage(const Scene& the_scene, const DriveSettings& the_settings, const TrialLimits& limits, const Frames& frames,
             double the_interval)
    : scene(the_scene),
      settings(the_settings),
      interval(the_interval),
      messages(scene, frames),
      markers(scene, frames),
      trial(with_limits(settings.applied_to(scene), limits), interval) {}

}  // namespace vibratory_alignment
