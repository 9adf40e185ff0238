// Writes a trial as a bag with the node's topics, without a ROS master: what `rosbag record` of a live node would hold,
// stamped with simulated time.
#pragma once

#include <memory>
#include <string>

#include "model/scene.h"
#include "trial/outcome.h"
#include "trial/sampler.h"

namespace vibratory_alignment {

/// The bag holds /tf, /tf_static, and of a node named /aligner: state, reaction/a1, reaction/a2, contacts, markers,
/// parameter_updates, restarts and result. Stamps are kStartTime + simulated seconds (scenes without scales: units of
/// time), so never 0. The file is created by the constructor and removed by the destructor unless finish() has made it
/// whole.
class BagWriter {
 public:
  static constexpr double kStartTime = 1.0;  ///< stamp of the trial's start [s]

  /// Throws std::runtime_error when `path` cannot be written.
  BagWriter(const std::string& path, const Scene& scene);
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// Samples in the order of time. Those at event instants get no messages: their peaks and impulses are carried over
  /// to the next regular one. Throws std::runtime_error (disk full).
  void write(const Sample& sample);

  /// Writes ~result and closes the file: the bag is whole. Throws std::runtime_error.
  void finish(const TrialResult& result);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vibratory_alignment
