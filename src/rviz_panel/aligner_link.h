// The panel's link to an aligner: knows whether the node is there, keeps what it publishes, and hands commands to it.
//
// Everything that can wait for the node or the master happens in a thread of its own; what the panel calls returns at
// once, and the node has the commands in the order in which they were given. A node that was away and comes back, with
// its master or without, is found within a second or two.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <dynamic_reconfigure/Config.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <vibratory_alignment/AlignerConfig.h>
#include <vibratory_alignment/AlignerResult.h>
#include <vibratory_alignment/AlignerState.h>

namespace vibratory_alignment {

class AlignerLink {
 public:
  enum class Presence { sought, no_master, absent, present };

  struct Status {
    Presence presence = Presence::sought;
    bool running = false;                   ///< samples come in
    bool silent = false;                    ///< the node is present, and publishes not even its diagnostics any more
    std::optional<AlignerConfig> settings;  ///< in force
    bool changing = false;                  ///< they are about to be changed: changes are on their way to the node
    std::optional<AlignerState> state;      ///< the last sample
    std::optional<AlignerResult> result;    ///< of the trial whose last sample that is
    std::string answer;                     ///< to the last command; empty: none yet
    bool refused = false;                   ///< that answer is a refusal
  };

  /// `node`: name of the aligner, as in "/aligner". ROS must have been initialized.
  explicit AlignerLink(const std::string& node);
  ~AlignerLink();
  AlignerLink(const AlignerLink&) = delete;
  AlignerLink& operator=(const AlignerLink&) = delete;

  const std::string& node() const { return node_; }

  /// Calls a service of the node: start, pause, step or reset.
  void trigger(const std::string& service);

  /// Scene of the package or path of a file.
  void load_scene(const std::string& scene);

  /// Changes one setting; the others stay as they are, whoever has changed them. Changes that wait one after the other
  /// go together, and of several of one setting the last one counts.
  void change(const std::string& setting, double value);

  /// Puts a refusal of the panel's own in the place of the node's answers.
  void refuse(const std::string& why) { tell(true, why); }

  Status status();

  /// Samples since the last call, at most some thousands.
  std::vector<AlignerState> take_samples();

 private:
  using Clock = std::chrono::steady_clock;
  struct Trigger {
    std::string service;
  };
  struct Load {
    std::string scene;
  };
  using Changes = dynamic_reconfigure::Config;
  using Command = std::variant<Trigger, Load, Changes>;

  void work();
  void subscribe();
  void look_for_node();
  bool carry_out_next();
  void carry_out(const Trigger& trigger);
  void carry_out(const Load& load);
  void carry_out(const Changes& changes);
  template <class Service>
  bool call(const std::string& service, Service& message);
  void tell(bool refused, const std::string& answer);
  void drop_hanging_call();

  std::string identity() const;
  template <class Message>
  bool is_from_another(const ros::MessageEvent<const Message>& event) const;
  bool is_same_sample(const AlignerState& state) const;
  void on_state(const ros::MessageEvent<const AlignerState>& event);
  void on_result(const ros::MessageEvent<const AlignerResult>& event);
  void on_settings(const ros::MessageEvent<const dynamic_reconfigure::Config>& event);
  void keep_settings(dynamic_reconfigure::Config message);
  void on_diagnostics(const ros::MessageEvent<const diagnostic_msgs::DiagnosticArray>& event);

  const std::string node_;
  ros::CallbackQueue queue_;
  ros::NodeHandle handle_;
  // of the worker
  std::vector<ros::Subscriber> subscribers_;
  Clock::time_point next_look_{};
  std::string identity_;  ///< of the node and its master when last seen

  std::mutex mutex_;  ///< of all that follows
  Status status_;
  std::vector<AlignerState> samples_;
  Clock::time_point last_arrival_{}, arrival_before_{};
  Clock::time_point last_diagnostics_{};  ///< of the node
  std::deque<Command> commands_;          ///< that wait
  ros::ServiceClient client_;             ///< of the call that is under way
  std::optional<Clock::time_point> busy_since_;

  std::atomic<bool> ending_{false};
  std::thread worker_;
};

}  // namespace vibratory_alignment
