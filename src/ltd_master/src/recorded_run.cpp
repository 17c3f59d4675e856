#include "ltd_master/recorded_run.h"

#include <fmt/format.h>
#include <ros/message_traits.h>
#include <std_msgs/String.h>

#include <map>
#include <set>
#include <vector>

#include "ltd_master/conversions.h"

namespace ltd_master {
namespace {

template <class Message>
bool IsTopicOf(const rosbag::ConnectionInfo& connection) {
  if (connection.datatype != ros::message_traits::datatype<Message>()) return false;
  if (connection.md5sum == ros::message_traits::md5sum<Message>()) return true;
  throw UnreadableBag(
      fmt::format("{} has another definition of {} than this build", connection.topic, connection.datatype));
}

/// "/train" of "/train/state".
std::string NamespaceOf(const std::string& topic) { return topic.substr(0, topic.find_last_of('/')); }

/// The connections of a bag.
std::vector<const rosbag::ConnectionInfo*> ConnectionsOf(const rosbag::Bag& bag) {
  return rosbag::View(bag).getConnections();
}

Bytes BytesOf(const rosbag::MessageInstance& message) {
  constexpr std::uint32_t kLargest = 1u << 28;
  const std::uint32_t size = message.size();
  if (size > kLargest)
    throw UnreadableBag(fmt::format("{} has a message of {} bytes", message.getTopic(), size));
  Bytes bytes(size);
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  message.write(stream);
  return bytes;
}

/// The namespace of the train that is asked for, or of the only one.
std::string FindTrain(const rosbag::Bag& bag, const std::string& asked) {
  std::set<std::string> trains;
  for (const rosbag::ConnectionInfo* connection : ConnectionsOf(bag)) {
    if (IsTopicOf<train_brake_msgs::TrainState>(*connection)) trains.insert(NamespaceOf(connection->topic));
  }
  if (trains.empty()) throw UnreadableBag("holds no train_brake_msgs/TrainState");
  if (asked.empty() && trains.size() == 1) return *trains.begin();
  if (trains.count(asked) > 0) return asked;
  throw UnreadableBag(fmt::format("{}: {}; choose one with --train",
                                  asked.empty() ? "holds several trains" : "holds no train " + asked + " but",
                                  fmt::join(trains, ", ")));
}

}  // namespace

RecordedTopic::RecordedTopic(const rosbag::Bag& bag, const std::string& topic)
    : name_(topic),
      view_(std::make_unique<rosbag::View>(bag, rosbag::TopicQuery(topic))),
      position_(view_->begin()),
      end_(view_->end()) {
  if (!done()) Load();
}

void RecordedTopic::Advance() {
  const std::uint64_t last = exchange_;
  ++position_;
  if (done()) return;
  Load();
  if (exchange_ >= last) return;
  throw UnreadableBag(fmt::format("{} falls from exchange {} to {}: the bag holds more than one run", name_,
                                  last, exchange_));
}

void RecordedTopic::Load() {
  message_ = BytesOf(*position_);
  const std::optional<std::uint64_t> exchange = ExchangeOf(message_);
  if (!exchange) throw UnreadableBag(name_ + " has a message that is too short");
  exchange_ = *exchange;
}

RecordedRun::RecordedRun(const std::string& file, const std::string& train) {
  bag_.open(file, rosbag::bagmode::Read);
  train_ = FindTrain(bag_, train);
  std::map<std::string, std::unique_ptr<RecordedTopic>*>
      places;  // by topic, which may have several connections
  for (const rosbag::ConnectionInfo* connection : ConnectionsOf(bag_)) {
    const std::string& topic = connection->topic;
    const std::string above = NamespaceOf(topic);
    if (above == train_) {
      if (IsTopicOf<train_brake_msgs::TrainState>(*connection)) places[topic] = &state_;
      if (IsTopicOf<train_brake_msgs::InTrainForces>(*connection)) places[topic] = &forces_;
      if (IsTopicOf<train_brake_msgs::BrakePressures>(*connection)) places[topic] = &pressures_;
      if (IsTopicOf<train_brake_msgs::EnergyLedger>(*connection)) places[topic] = &ledger_;
    } else if (NamespaceOf(above) == train_ && IsTopicOf<train_brake_msgs::WagonState>(*connection)) {
      places[topic] = &wagons_[above.substr(train_.size() + 1)];
    }
  }
  for (const auto& [topic, place] : places) *place = std::make_unique<RecordedTopic>(bag_, topic);
  if (state_->done()) throw UnreadableBag(state_->name() + " has no messages");
}

RecordedTopic* RecordedRun::wagon(const std::string& name) {
  const auto found = wagons_.find(name);
  return found == wagons_.end() ? nullptr : found->second.get();
}

std::optional<std::string> RecordedRun::Scenario() const {
  rosbag::View view(bag_, rosbag::TopicQuery(train_ + "/" + kScenarioTopic));
  if (view.begin() == view.end() || !view.begin()->isType<std_msgs::String>()) return std::nullopt;
  const Bytes bytes = BytesOf(*view.begin());
  constexpr std::size_t kLength = sizeof(std::uint32_t);  // before the text
  if (bytes.size() < kLength) return std::nullopt;
  return std::string(bytes.begin() + kLength, bytes.end());
}

}  // namespace ltd_master
