#include "node/bag_writer.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <system_error>

#include <dynamic_reconfigure/Config.h>
#include <rosbag/bag.h>
#include <std_msgs/UInt32.h>
#include <tf2_msgs/TFMessage.h>
#include <boost/make_shared.hpp>

#include "node/drive_settings.h"
#include "node/frames.h"
#include "node/markers.h"
#include "node/messages.h"
#include "node/transforms.h"

namespace vibratory_alignment {
namespace {

const std::string kNode = "/aligner";
constexpr double kTimeScale = 1.0;    ///< as the settings tell it: a stamp is simulated time
constexpr double kPictures = 1000.0;  ///< markers are written at most this often in trial.time_limit

/// Peaks and impulses of `earlier`, to which no message was given, go into `later`.
void carry_over(const Sample& earlier, Sample& later) {
  for (std::size_t i = 0; i < kSiteCount; ++i) {
    const ContactSample& from = earlier.contacts[i];
    ContactSample& to = later.contacts[i];
    to.peak_normal_force = std::max(to.peak_normal_force, from.peak_normal_force);
    to.impulse_x += from.impulse_x;
    to.impulse_y += from.impulse_y;
    to.normal_impulse += from.normal_impulse;
  }
}

}  // namespace

class BagWriter::Impl {
 public:
  Impl(const std::string& path, const Scene& scene)
      : path_(path),
        scene_(scene),
        messages_(scene, frames_with_prefix("")),
        markers_(scene, messages_.frames()),
        picture_interval_(scene.trial.time_limit / kPictures) {
    try {
      guarded([&] { bag_->open(path_, rosbag::bagmode::Write); });
    } catch (...) {
      give_up();
      throw;
    }
  }

  ~Impl() {
    if (whole_) return;
    give_up();
    std::error_code ignored;
    if (std::filesystem::is_regular_file(path_, ignored)) std::filesystem::remove(path_, ignored);
  }

  void write(const Sample& sample) {
    guarded([&] { put(sample); });
  }

  void finish(const TrialResult& result) {
    guarded([&] {
      const ros::Time stamp = stamp_at(result.final_time);
      markers_.set_outcome(result.outcome);
      write_latched(kNode + "/markers", stamp, markers_.draw(stamp));
      write_latched(kNode + "/result", stamp, messages_.result(result, stamp));
      bag_->close();
    });
    whole_ = true;
  }

 private:
  /// Closes a bag that is not wanted any more. One that cannot be closed (a full disk) is not destroyed either: its
  /// destructor would close it again, throw and end the program.
  void give_up() {
    try {
      bag_->close();
    } catch (const std::exception&) {
      static_cast<void>(bag_.release());
    }
  }

  /// Runs `work` and tells its failures with the file's name.
  template <class Work>
  void guarded(const Work& work) {
    errno = 0;
    try {
      work();
    } catch (const std::exception& error) {
      const std::string reason = errno == 0 ? "" : std::string(": ") + std::strerror(errno);
      throw std::runtime_error(path_ + ": the bag cannot be written: " + error.what() + reason);
    }
  }

  ros::Time stamp_at(double time) const { return ros::Time(kStartTime + time * messages_.units().time); }

  /// Connection header of a latched topic. rosbag takes it as it is, so it must describe the message, too.
  template <class Message>
  boost::shared_ptr<ros::M_string> latched() const {
    auto header = boost::make_shared<ros::M_string>();
    (*header)["type"] = ros::message_traits::datatype<Message>();
    (*header)["md5sum"] = ros::message_traits::md5sum<Message>();
    (*header)["message_definition"] = ros::message_traits::definition<Message>();
    (*header)["callerid"] = kNode;
    (*header)["latching"] = "1";
    return header;
  }

  template <class Message>
  void write_latched(const std::string& topic, const ros::Time& stamp, const Message& message) {
    bag_->write(topic, stamp, message, latched<Message>());
  }

  void put(Sample sample) {
    if (carried_) carry_over(*carried_, sample);
    carried_.reset();
    const ros::Time stamp = stamp_at(sample.time);
    if (stamp <= last_stamp_ || (sample.is_event && !sample.is_last)) {
      carried_ = sample;
      return;
    }
    if (last_stamp_.isZero()) {
      tf2_msgs::TFMessage fixed;
      fixed.transforms = static_transforms(scene_, messages_.frames(), {}, stamp);
      write_latched("/tf_static", stamp, fixed);
      write_latched(kNode + "/restarts", stamp, std_msgs::UInt32());
      dynamic_reconfigure::Config settings;
      DriveSettings(scene_, kTimeScale).config().__toMessage__(settings);
      write_latched(kNode + "/parameter_updates", stamp, settings);
    }
    last_stamp_ = stamp;
    tf2_msgs::TFMessage moving;
    moving.transforms = {part_transform(sample.state, messages_.units().length, messages_.frames(), stamp)};
    bag_->write("/tf", stamp, moving);
    bag_->write(kNode + "/state", stamp, messages_.state(sample, stamp));
    bag_->write(kNode + "/reaction/a1", stamp, messages_.reaction(sample, Site::a1, stamp));
    bag_->write(kNode + "/reaction/a2", stamp, messages_.reaction(sample, Site::a2, stamp));
    bag_->write(kNode + "/contacts", stamp, messages_.contacts(sample, stamp));
    markers_.add(sample);
    if (sample.time >= next_picture_) {
      next_picture_ = sample.time + picture_interval_;
      write_latched(kNode + "/markers", stamp, markers_.draw(stamp));
    }
  }

  std::string path_;
  Scene scene_;
  Messages messages_;
  Markers markers_;
  std::unique_ptr<rosbag::Bag> bag_ = std::make_unique<rosbag::Bag>();
  ros::Time last_stamp_;
  std::optional<Sample> carried_;  ///< of event instants since the last message
  double picture_interval_, next_picture_ = 0.0;
  bool whole_ = false;
};

BagWriter::BagWriter(const std::string& path, const Scene& scene) : impl_(std::make_unique<Impl>(path, scene)) {}

BagWriter::~BagWriter() = default;

void BagWriter::write(const Sample& sample) { impl_->write(sample); }

void BagWriter::finish(const TrialResult& result) { impl_->finish(result); }

}  // namespace vibratory_alignment
