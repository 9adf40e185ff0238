#include "rviz_panel/aligner_link.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/master.h>
#include <ros/service.h>
#include <ros/service_manager.h>
#include <ros/this_node.h>
#include <std_srvs/Trigger.h>
#include <vibratory_alignment/LoadScene.h>

namespace vibratory_alignment {
namespace {

constexpr std::uint32_t kQueueSize = 2000;
constexpr std::size_t kKeptSamples = 5000;  ///< until they are taken
constexpr std::chrono::milliseconds kLookInterval(1000);
constexpr std::chrono::milliseconds kPatience(3000);   ///< with a node that does not answer
constexpr std::chrono::milliseconds kStandstill(400);  ///< without a sample: the trial stands still
constexpr std::chrono::milliseconds kSilence(4000);    ///< without its diagnostics, which come once a second
constexpr double kTurn = 0.02;                         ///< of the worker [s]

template <class Entries, class Value>
void set_entry(Entries& entries, const std::string& name, Value value) {
  for (auto& entry : entries) {
    if (entry.name == name) {
      entry.value = value;
      return;
    }
  }
  entries.emplace_back();
  entries.back().name = name;
  entries.back().value = value;
}

std::string number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// Adds words about what the node has made of the changes otherwise; none: they are in force.
template <class Entries>
void tell_departures(const Entries& asked, const Entries& in_force, std::string& words) {
  for (const auto& entry : asked) {
    for (const auto& other : in_force) {
      if (other.name != entry.name || other.value == entry.value) continue;
      const double wanted = static_cast<double>(entry.value), got = static_cast<double>(other.value);
      words +=
          (words.empty() ? "" : "; ") + entry.name + ": " + number(wanted) + " is not possible, it is " + number(got);
    }
  }
}

}  // namespace

AlignerLink::AlignerLink(const std::string& node) : node_(node) {
  handle_.setCallbackQueue(&queue_);
  worker_ = std::thread([this] { work(); });
}

AlignerLink::~AlignerLink() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
    if (busy_since_) client_.shutdown();
  }
  worker_.join();
}

/// roscpp waits for the master here, without limit.
void AlignerLink::subscribe() {
  subscribers_.clear();
  subscribers_ = {handle_.subscribe(node_ + "/state", kQueueSize, &AlignerLink::on_state, this),
                  handle_.subscribe(node_ + "/result", 1, &AlignerLink::on_result, this),
                  handle_.subscribe(node_ + "/parameter_updates", 10, &AlignerLink::on_settings, this),
                  handle_.subscribe("/diagnostics", 100, &AlignerLink::on_diagnostics, this)};
}

// --- What the panel calls ------------------------------------------------------------------------------------------

void AlignerLink::trigger(const std::string& service) {
  const std::lock_guard<std::mutex> lock(mutex_);
  commands_.emplace_back(Trigger{service});
}

void AlignerLink::load_scene(const std::string& scene) {
  const std::lock_guard<std::mutex> lock(mutex_);
  commands_.emplace_back(Load{scene});
}

void AlignerLink::change(const std::string& setting, double value) {
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.changing = true;
  if (commands_.empty() || !std::holds_alternative<Changes>(commands_.back())) commands_.emplace_back(Changes());
  Changes& changes = std::get<Changes>(commands_.back());
  if (setting == "enabled") {
    set_entry(changes.bools, setting, static_cast<std::uint8_t>(value != 0.0));
  } else if (setting == "waveform") {
    set_entry(changes.ints, setting, static_cast<std::int32_t>(value));
  } else {
    set_entry(changes.doubles, setting, value);
  }
}

AlignerLink::Status AlignerLink::status() {
  const std::lock_guard<std::mutex> lock(mutex_);
  drop_hanging_call();
  const auto now = Clock::now();
  const Clock::duration gap = std::max<Clock::duration>(kStandstill, 4 * (last_arrival_ - arrival_before_));
  status_.running = !status_.result && last_arrival_ != Clock::time_point() && arrival_before_ != Clock::time_point() &&
                    now - arrival_before_ < gap;
  status_.silent = status_.presence == Presence::present && !status_.running &&
                   last_diagnostics_ != Clock::time_point() && now - last_diagnostics_ > kSilence;
  return status_;
}

std::vector<AlignerState> AlignerLink::take_samples() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(samples_, {});
}

/// A call has no time limit of its own; without its connection it ends.
void AlignerLink::drop_hanging_call() {
  if (busy_since_ && Clock::now() - *busy_since_ > kPatience) client_.shutdown();
}

// --- What the node publishes ---------------------------------------------------------------------------------------

/// Beside a node that is there a bag may be played under its name.
template <class Message>
bool AlignerLink::is_from_another(const ros::MessageEvent<const Message>& event) const {
  return status_.presence == Presence::present && event.getPublisherName() != node_;
}

/// The last one again, for a newcomer. On a clock of their own all nodes begin with the same stamp.
bool AlignerLink::is_same_sample(const AlignerState& state) const {
  return status_.state && state.header.stamp == status_.state->header.stamp && state.tau == status_.state->tau &&
         state.scene == status_.state->scene;
}

void AlignerLink::on_state(const ros::MessageEvent<const AlignerState>& event) {
  const AlignerState& state = *event.getConstMessage();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (is_from_another(event)) return;
  if (is_same_sample(state)) return;
  if (status_.result && state.header.stamp > status_.result->header.stamp) status_.result.reset();
  if (status_.state && state.tau <= status_.state->tau) {
    status_.result.reset();  // the stamps may have been set back, too
    samples_.clear();
    last_arrival_ = {};
  }
  status_.state = state;
  arrival_before_ = std::exchange(last_arrival_, Clock::now());
  if (samples_.size() < kKeptSamples) samples_.push_back(state);
}

void AlignerLink::on_result(const ros::MessageEvent<const AlignerResult>& event) {
  const AlignerResult& result = *event.getConstMessage();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (is_from_another(event)) return;
  // A latched result may be that of the trial before; that of the present one bears the stamp of its last sample.
  if (status_.state && status_.state->header.stamp > result.header.stamp) return;
  status_.result = result;
}

void AlignerLink::on_settings(const ros::MessageEvent<const dynamic_reconfigure::Config>& event) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!is_from_another(event)) keep_settings(*event.getConstMessage());
}

void AlignerLink::keep_settings(dynamic_reconfigure::Config message) {
  AlignerConfig config = AlignerConfig::__getDefault__();
  if (config.__fromMessage__(message)) status_.settings = config;
}

void AlignerLink::on_diagnostics(const ros::MessageEvent<const diagnostic_msgs::DiagnosticArray>& event) {
  if (event.getPublisherName() != node_) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  last_diagnostics_ = Clock::now();
}

// --- The worker ----------------------------------------------------------------------------------------------------

void AlignerLink::work() {
  while (!ending_ && ros::ok()) {
    queue_.callAvailable(ros::WallDuration(kTurn));
    while (!ending_ && carry_out_next()) queue_.callAvailable(ros::WallDuration(0.0));
    if (!ending_ && Clock::now() >= next_look_) look_for_node();
  }
}

/// Which master and which process of the node it is: another one may have taken the place of either between two looks.
std::string AlignerLink::identity() const {
  XmlRpc::XmlRpcValue request, response, pid;
  request[0] = ros::this_node::getName();
  std::string host;
  std::uint32_t port = 0;
  if (!ros::master::execute("getPid", request, response, pid, false) ||
      !ros::ServiceManager::instance()->lookupService(node_ + "/start", host, port))
    return "";
  return std::to_string(static_cast<int>(pid)) + " " + host + ":" + std::to_string(port);
}

void AlignerLink::look_for_node() {
  const bool master = ros::master::check();
  const bool there = master && ros::service::exists(node_ + "/start", false);
  const std::string found = there ? identity() : "";
  const bool is_other = !found.empty() && found != std::exchange(identity_, found);
  if (master && subscribers_.empty()) subscribe();
  next_look_ = Clock::now() + kLookInterval;
  bool back = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const Presence before = status_.presence;
    status_.presence = !master ? Presence::no_master : there ? Presence::present : Presence::absent;
    back = there && before != Presence::sought && (before != Presence::present || is_other);
    if (!there || back) status_.settings.reset();
    if (back) {
      status_.state.reset();
      status_.result.reset();
      samples_.clear();
      status_.answer.clear();
      status_.refused = false;
      last_arrival_ = last_diagnostics_ = {};
    }
    if (!there) {
      commands_.clear();
      status_.changing = false;
    }
  }
  if (back) subscribe();  // a new master does not know of these subscriptions
}

/// False when nothing waits.
bool AlignerLink::carry_out_next() {
  Command command;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (commands_.empty()) return false;
    command = std::move(commands_.front());
    commands_.pop_front();
  }
  std::visit([this](const auto& kind) { carry_out(kind); }, command);
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto is_change = [](const Command& waiting) { return std::holds_alternative<Changes>(waiting); };
  status_.changing = std::any_of(commands_.begin(), commands_.end(), is_change);
  return true;
}

void AlignerLink::carry_out(const Trigger& trigger) {
  std_srvs::Trigger message;
  if (call(trigger.service, message)) tell(!message.response.success, message.response.message);
}

void AlignerLink::carry_out(const Load& load) {
  LoadScene message;
  message.request.scene = load.scene;
  if (call("load_scene", message)) tell(!message.response.success, message.response.message);
}

void AlignerLink::carry_out(const Changes& changes) {
  dynamic_reconfigure::Reconfigure message;
  message.request.config = changes;
  if (!call("set_parameters", message)) return;
  const Changes& answer = message.response.config;
  std::string words;
  tell_departures(changes.doubles, answer.doubles, words);
  tell_departures(changes.ints, answer.ints, words);
  tell_departures(changes.bools, answer.bools, words);
  tell(!words.empty(), words);
  const std::lock_guard<std::mutex> lock(mutex_);
  keep_settings(answer);
}

/// False, and the user is told, if the node does not answer. Once the link ends no further call begins: nobody would
/// end it.
template <class Service>
bool AlignerLink::call(const std::string& service, Service& message) {
  ros::ServiceClient client = handle_.serviceClient<Service>(node_ + "/" + service, true);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (ending_) return false;
    client_ = client;
    busy_since_ = Clock::now();
  }
  const bool answered = client.call(message);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!answered) {
    const bool hanging = Clock::now() - *busy_since_ > kPatience;
    status_.answer = node_ + (hanging ? " does not answer" : " has no service " + service + " that answers");
    status_.refused = true;
  }
  client_ = {};
  busy_since_.reset();
  return answered;
}

void AlignerLink::tell(bool refused, const std::string& answer) {
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.refused = refused;
  status_.answer = answer;
}

}  // namespace vibratory_alignment
