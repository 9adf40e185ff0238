// What dynamic_reconfigure can change (config/Aligner.cfg), against the scene: its first excitation, its pressing
// force, and the time scale. Config values are in the scene's own units, everything else is dimensionless.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <vibratory_alignment/AlignerConfig.h>

#include "model/scene.h"

namespace vibratory_alignment {

class DriveSettings {
 public:
  /// Starts with the scene's values. Throws SceneError when the scene has no start.
  DriveSettings(const Scene& scene, double time_scale);

  /// The values in force.
  const AlignerConfig& config() const { return config_; }

  /// Undoes the clamping of dynamic_reconfigure's server, which clamps every value of a request, also those that nobody
  /// has asked to change: one at the end of the range where the value in force lies beyond it becomes that in force.
  void undo_clamping(AlignerConfig& requested) const;

  /// Takes over what can be used of `requested` and sets the rest of it back to the values in force. Returns why, one
  /// line for each value refused: NaN and infinity, a waveform or force that the scene has no ground for.
  std::vector<std::string> change(AlignerConfig& requested);

  /// The scene with the values in force; those that nobody has changed to the last bit as they are there.
  Scene applied_to(Scene scene) const;

  /// All excitations of the scene, the first as it is set now; amplitude 0 while it is not enabled.
  std::vector<Excitation> excitations() const;

  /// As it is set now; nothing when the scene has none, because its start touches nothing from above.
  std::optional<double> pressing_force() const;

 private:
  std::vector<Excitation> scene_excitations_;
  double force_unit_ = 1.0, amplitude_unit_ = 1.0, frequency_unit_ = 1.0;  ///< 1 dimensionless in the scene's units
  std::optional<double> scene_pressing_force_;
  // the generated constructor leaves some members without a value
  AlignerConfig scene_config_ = AlignerConfig::__getDefault__();  ///< what the scene says
  AlignerConfig config_ = AlignerConfig::__getDefault__();        ///< what holds now
};

}  // namespace vibratory_alignment
