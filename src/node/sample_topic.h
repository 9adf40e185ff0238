// A topic whose messages go out together with those of other topics, and cost nothing while nobody listens.
//
// ros::Publisher::publish() wakes roscpp's network thread for every message, and to wake a thread costs more than to
// make and serialize one. Here the messages of a sample are queued with their publications first; then the thread is
// woken once. On the wire nothing differs.
#pragma once

#include <ros/publication.h>
#include <ros/publisher.h>
#include <ros/serialization.h>

namespace vibratory_alignment {

class SampleTopic {
 public:
  SampleTopic() = default;
  explicit SampleTopic(const ros::Publisher& publisher);

  /// Queues the message that `make` returns; without subscribers it is not made, only counted. True: it is to be sent.
  template <class Make>
  bool queue(const Make& make) const {
    if (!publication_) return false;  // ROS had shut down before the topic was advertised
    if (!publication_->hasSubscribers()) {
      publication_->incrementSequence();
      return false;
    }
    ros::SerializedMessage message = ros::serialization::serializeMessage(make());
    publication_->publish(message);
    return true;
  }

 private:
  ros::Publisher publisher_;  ///< keeps the topic advertised
  ros::PublicationPtr publication_;
};

/// Has roscpp's network thread send what the topics of this process have queued.
void send_queued_messages();

}  // namespace vibratory_alignment
