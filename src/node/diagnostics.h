// The node's health on /diagnostics, once a second of wall time.
//
//   solver   ERROR: the trial failed; WARN: its energy ledger does not close
//   pace     WARN: the trial cannot keep up with ~time_scale
//   trial    what is going on; always OK, for every outcome is an answer
#pragma once

#include <chrono>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include "node/pace_meter.h"
#include "trial/outcome.h"

namespace vibratory_alignment {

/// What is reported.
struct NodeStatus {
  std::string activity;  ///< waiting, paused, running or ended
  bool goal_active = false;
  TrialResult trial;         ///< so far
  std::string tau_text;      ///< where it is
  double time_scale = 0.0;   ///< asked for; 0: as fast as possible
  double sample_rate = 0.0;  ///< that goes with it [1/s]; 0: as fast as possible
  double lag = 0.0;          ///< the next sample is late by this [s]
  PaceReport pace;           ///< since the report before
};

class Diagnostics {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Diagnostics(const ros::NodeHandle& private_handle);

  /// Whether a report is due.
  bool due() const { return Clock::now() >= due_; }
  void publish(const NodeStatus& status);

  /// The trial has ended; told until the next one ends.
  void set_last_outcome(const TrialResult& result);

 private:
  using Wrapper = diagnostic_updater::DiagnosticStatusWrapper;
  void report_solver(Wrapper& wrapper);
  void report_pace(Wrapper& wrapper);
  void report_trial(Wrapper& wrapper);

  diagnostic_updater::Updater updater_;
  Clock::time_point due_;
  NodeStatus status_;
  std::string last_outcome_ = "none";
  long trials_ = 0, failures_ = 0;
};

}  // namespace vibratory_alignment
