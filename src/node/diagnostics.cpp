#include "node/diagnostics.h"

namespace vibratory_alignment {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr std::chrono::seconds kInterval(1);
constexpr double kLargestLag = 0.1;  ///< [s of wall time]

}  // namespace

Diagnostics::Diagnostics(const ros::NodeHandle& private_handle)
    : updater_(ros::NodeHandle(), private_handle), due_(Clock::now() + kInterval) {
  updater_.setHardwareID("none");
  updater_.add("solver", this, &Diagnostics::report_solver);
  updater_.add("pace", this, &Diagnostics::report_pace);
  updater_.add("trial", this, &Diagnostics::report_trial);
}

void Diagnostics::publish(const NodeStatus& status) {
  status_ = status;
  due_ += kInterval;
  if (due()) due_ = Clock::now() + kInterval;
  updater_.force_update();  // update() would wait for ROS time, which may be simulated
}

void Diagnostics::set_last_outcome(const TrialResult& result) {
  last_outcome_ = to_string(result.outcome);
  ++trials_;
  if (result.outcome == Outcome::failed) ++failures_;
}

void Diagnostics::report_solver(Wrapper& wrapper) {
  const TrialResult& trial = status_.trial;
  wrapper.summary(DiagnosticStatus::OK, trial.solver_name);
  if (trial.energy && trial.energy->residual > kLargestResidual) {
    wrapper.summary(DiagnosticStatus::WARN, "the energy ledger does not close");
  }
  if (trial.outcome == Outcome::failed) wrapper.summary(DiagnosticStatus::ERROR, "failed: " + trial.failure);
  wrapper.add("solver", trial.solver_name);
  wrapper.add("tolerance", trial.solver_tolerance);
  wrapper.add("step (dimensionless)", trial.solver_step);
  wrapper.add("steps", trial.counts.steps);
  wrapper.add("rejected steps", trial.counts.rejected);
  wrapper.add("events", trial.counts.events);
  if (trial.energy) wrapper.add("energy residual", trial.energy->residual);
  wrapper.add("trials ended", trials_);
  wrapper.add("trials failed", failures_);
}

void Diagnostics::report_pace(Wrapper& wrapper) {
  const PaceReport& pace = status_.pace;
  const bool behind = status_.lag > kLargestLag || pace.dropped > 0.0;
  if (behind) {
    wrapper.summary(DiagnosticStatus::WARN, "cannot keep up with time_scale: simulated time runs slower");
  } else if (pace.running == 0.0) {
    wrapper.summary(DiagnosticStatus::OK, "not running");
  } else {
    wrapper.summary(DiagnosticStatus::OK, status_.time_scale == 0.0 ? "as fast as possible" : "keeps up");
  }
  wrapper.add("simulated per wall time, asked for", status_.time_scale);
  wrapper.add("simulated per wall time", pace.real_time_factor());
  wrapper.add("samples per second, asked for", status_.sample_rate);
  wrapper.add("samples per second", pace.rate());
  wrapper.add("lag [s]", status_.lag);
  wrapper.add("lost [s]", pace.dropped);
}

void Diagnostics::report_trial(Wrapper& wrapper) {
  wrapper.summary(DiagnosticStatus::OK, status_.activity);
  wrapper.add("scene", status_.trial.scene);
  wrapper.add("at", status_.tau_text);
  wrapper.add("outcome", to_string(status_.trial.outcome));
  wrapper.add("mode", to_string(status_.trial.mode));
  wrapper.add("last outcome", last_outcome_);
  wrapper.add("goal of ~align active", status_.goal_active);
}

}  // namespace vibratory_alignment
