// The action ~align: one goal at a time, feedback at a fixed rate of wall time, one result for each goal.
//
// It knows the protocol and what is told of a trial; the node, through two functions, runs the trial. Everything
// happens in the node's thread.
#pragma once

#include <array>
#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include <actionlib/server/action_server.h>
#include <ros/node_handle.h>
#include <vibratory_alignment/AlignAction.h>

#include "node/messages.h"
#include "trial/outcome.h"
#include "trial/sampler.h"

namespace vibratory_alignment {

class AlignServer {
 public:
  using Clock = std::chrono::steady_clock;
  /// Makes the trial of a goal ready to start. Throws with the reasons when the goal cannot be carried out.
  using Begin = std::function<void(const AlignGoal&)>;
  /// The client has cancelled its goal: stops the trial and ends the goal with preempt().
  using Stop = std::function<void()>;

  /// `feedback_rate` [1/s of wall time] > 0.
  AlignServer(const ros::NodeHandle& private_handle, double feedback_rate, Begin begin, Stop stop);

  bool active() const { return goal_.has_value(); }

  /// Books a sample for the feedback.
  void add(const Sample& sample);

  /// When the next feedback is due.
  Clock::time_point feedback_due() const { return feedback_due_; }
  void give_feedback(const Messages& messages, bool paused);

  /// The trial has ended: the goal succeeded if the part is aligned or inserted, and is aborted otherwise.
  void finish(const Messages& messages, const TrialResult& result, const std::string& text);

  /// The goal ends although the trial has not.
  void abort(const Messages& messages, const TrialResult& so_far, const std::string& text);
  void preempt(const Messages& messages, const TrialResult& so_far, const std::string& text);

  /// actionlib remembers goals and cancels by the stamps of their clients, one of which may be the end of ROS time, beyond
  /// which it cannot count: every status would throw. Such ones are taken for those of now; false if there are none.
  bool forget_times_to_come() { return server_.forget_times_to_come(); }

 private:
  class Server : public actionlib::ActionServer<AlignAction> {
   public:
    using actionlib::ActionServer<AlignAction>::ActionServer;
    bool forget_times_to_come();
  };
  void on_goal(Server::GoalHandle handle);
  void on_cancel(Server::GoalHandle handle);

  Server server_;
  Begin begin_;
  Stop stop_;
  Clock::duration feedback_interval_;
  Clock::time_point feedback_due_;
  std::optional<Server::GoalHandle> goal_;
  std::optional<Sample> sample_;                 ///< the last one of the goal's trial
  std::array<double, kSpotCount> peak_force_{};  ///< since the last feedback
};

}  // namespace vibratory_alignment
