#include "node/sample_topic.h"

#include <ros/poll_manager.h>
#include <ros/topic_manager.h>

namespace vibratory_alignment {

SampleTopic::SampleTopic(const ros::Publisher& publisher)
    : publisher_(publisher), publication_(ros::TopicManager::instance()->lookupPublication(publisher.getTopic())) {}

void send_queued_messages() { ros::PollManager::instance()->getPollSet().signal(); }

}  // namespace vibratory_alignment
