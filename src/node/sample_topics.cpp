#include "node/sample_topics.h"

#include <geometry_msgs/WrenchStamped.h>
#include <ros/single_subscriber_publisher.h>
#include <tf2_msgs/TFMessage.h>
#include <vibratory_alignment/AlignerContacts.h>
#include <vibratory_alignment/AlignerState.h>

#include "node/transforms.h"

namespace vibratory_alignment {

SampleTopics::SampleTopics(const ros::NodeHandle& private_handle, const Frames& frames) : frames_(frames) {
  const auto on_join = [this](const ros::SingleSubscriberPublisher&) { transform_wanted_ = true; };
  auto options = ros::AdvertiseOptions::create<tf2_msgs::TFMessage>("/tf", kQueueSize, on_join, {}, {}, &joined_);
  transforms_ = SampleTopic(ros::NodeHandle().advertise(options));
  state_ = advertise<AlignerState>(private_handle, "state", [this] { return messages_->state(*last_, last_stamp_); });
  reaction_a1_ = advertise<geometry_msgs::WrenchStamped>(
      private_handle, "reaction/a1", [this] { return messages_->reaction(*last_, Site::a1, last_stamp_); });
  reaction_a2_ = advertise<geometry_msgs::WrenchStamped>(
      private_handle, "reaction/a2", [this] { return messages_->reaction(*last_, Site::a2, last_stamp_); });
  contacts_ = advertise<AlignerContacts>(private_handle, "contacts",
                                         [this] { return messages_->contacts(*last_, last_stamp_); });
}

/// `make` gives the message of the last sample.
template <class Message, class Make>
SampleTopic SampleTopics::advertise(ros::NodeHandle handle, const std::string& name, const Make& make) {
  const auto on_join = [make](const ros::SingleSubscriberPublisher& newcomer) { newcomer.publish(make()); };
  auto options = ros::AdvertiseOptions::create<Message>(name, kQueueSize, on_join, {}, {}, &joined_);
  return SampleTopic(publishers_[name] = handle.advertise(options));
}

bool SampleTopics::queue_transform(const Messages& messages, const ros::Time& stamp) const {
  return transforms_.queue([&] {
    tf2_msgs::TFMessage moving;
    moving.transforms = {part_transform(last_->state, messages.units().length, frames_, stamp)};
    return moving;
  });
}

void SampleTopics::publish(const Messages& messages, const Sample& sample, const ros::Time& stamp) {
  joined_.clear();  // they get this one
  last_ = sample;
  last_stamp_ = stamp;
  bool queued = queue_transform(messages, stamp);
  queued |= state_.queue([&] { return messages.state(sample, stamp); });
  queued |= reaction_a1_.queue([&] { return messages.reaction(sample, Site::a1, stamp); });
  queued |= reaction_a2_.queue([&] { return messages.reaction(sample, Site::a2, stamp); });
  queued |= contacts_.queue([&] { return messages.contacts(sample, stamp); });
  if (queued) send_queued_messages();
}

bool SampleTopics::serve_newcomers(const Messages& messages) {
  transform_wanted_ = false;
  messages_ = &messages;
  joined_.callAvailable();
  return transform_wanted_;
}

void SampleTopics::repeat_transform(const Messages& messages, const ros::Time& stamp) const {
  if (queue_transform(messages, stamp)) send_queued_messages();
}

}  // namespace vibratory_alignment
