// The topics that carry the samples: /tf, ~state, ~reaction/a1, ~reaction/a2, ~contacts.
//
// A sample goes out once, to those who listen. Who joins while the trial stands still is given the last one, with its
// stamp. (Latched topics would give it to those who join a running trial, too, and twice if it is being sent just
// then.) Poses are different: who listens to /tf expects that of the part to go on, with new stamps, as long as it is
// true.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include "node/frames.h"
#include "node/messages.h"
#include "node/sample_topic.h"
#include "trial/sampler.h"

namespace vibratory_alignment {

constexpr std::uint32_t kQueueSize = 1000;  ///< messages kept for a slow subscriber

class SampleTopics {
 public:
  SampleTopics(const ros::NodeHandle& private_handle, const Frames& frames);
  SampleTopics(const SampleTopics&) = delete;
  SampleTopics& operator=(const SampleTopics&) = delete;

  /// By private names; without /tf.
  const std::map<std::string, ros::Publisher>& publishers() const { return publishers_; }

  void publish(const Messages& messages, const Sample& sample, const ros::Time& stamp);

  /// False: there is no last sample to speak of.
  bool has_last() const { return last_.has_value(); }

  /// A new trial begins: who joins before its first sample gets nothing.
  void forget_last() { last_.reset(); }

  /// Gives the last sample to those who have joined since. True: /tf is among what they have joined.
  bool serve_newcomers(const Messages& messages);

  /// Publishes the last pose of the part once more, with a new stamp.
  void repeat_transform(const Messages& messages, const ros::Time& stamp) const;

 private:
  template <class Message, class Make>
  SampleTopic advertise(ros::NodeHandle handle, const std::string& name, const Make& make);
  bool queue_transform(const Messages& messages, const ros::Time& stamp) const;

  Frames frames_;
  ros::CallbackQueue joined_;  ///< subscribers that have come since the last sample
  std::map<std::string, ros::Publisher> publishers_;
  SampleTopic transforms_, state_, reaction_a1_, reaction_a2_, contacts_;
  std::optional<Sample> last_;
  ros::Time last_stamp_;
  const Messages* messages_ = nullptr;  ///< while newcomers are served
  bool transform_wanted_ = false;
};

}  // namespace vibratory_alignment
