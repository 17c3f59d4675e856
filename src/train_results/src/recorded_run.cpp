#include "train_results/recorded_run.h"

#include <fmt/format.h>
#include <ros/message_traits.h>
#include <std_msgs/String.h>
#include <train_brake_msgs/bounded_stream.h>

#include <set>

#include "train_results/conversions.h"
#include "train_results/recorded_message.h"

namespace train_results {
namespace {

template <class Message>
bool IsOf(const BagFile::Topic& topic) {
  if (topic.type != ros::message_traits::datatype<Message>()) return false;
  if (topic.md5sum == ros::message_traits::md5sum<Message>()) return true;
  throw UnreadableBag(fmt::format(
      "{} has another definition of {} than this version, train_brake {}; use the version that wrote the bag",
      topic.name, topic.type, TRAIN_BRAKE_VERSION));
}

/// The text of a std_msgs/String.
std::optional<std::string> TextOf(const Bytes& message) {
  constexpr std::size_t kLength = sizeof(std::uint32_t);  // before the text
  if (message.size() < kLength) return std::nullopt;
  return std::string(message.begin() + kLength, message.end());
}

/// "/train" of "/train/state".
std::string NamespaceOf(const std::string& topic) { return topic.substr(0, topic.find_last_of('/')); }

/// The namespace of the requested train, or of the only one.
std::string FindTrain(const BagFile& bag, const std::string& asked) {
  std::set<std::string> trains;
  for (const BagFile::Topic& topic : bag.topics()) {
    if (IsOf<train_brake_msgs::TrainState>(topic) && !topic.messages.empty()) trains.insert(NamespaceOf(topic.name));
  }
  if (trains.empty()) throw UnreadableBag("holds no train_brake_msgs/TrainState");
  if (asked.empty() && trains.size() == 1) return *trains.begin();
  if (trains.count(asked) > 0) return asked;
  throw UnreadableBag(fmt::format("{}: {}; choose one with --train",
                                  asked.empty() ? "holds several trains" : "holds no train " + asked + " but",
                                  fmt::join(trains, ", ")));
}

}  // namespace

RecordedTopic::RecordedTopic(BagFile& bag, const BagFile::Topic& topic) : bag_(bag), topic_(topic) {
  if (!done()) Load();
}

void RecordedTopic::Advance() {
  const std::uint64_t last = exchange_;
  ++next_;
  if (done()) return;
  Load();
  if (exchange_ >= last) return;
  throw UnreadableBag(
      fmt::format("{} falls from exchange {} to {}: the bag holds more than one run", name(), last, exchange_));
}

void RecordedTopic::Load() {
  message_ = bag_.Read(topic_.messages[next_]);
  const std::optional<std::uint64_t> exchange = ExchangeOf(message_);
  if (!exchange) throw UnreadableBag(name() + " has a message that is too short");
  exchange_ = *exchange;
}

RecordedRun::RecordedRun(const std::string& file, const std::string& train)
    : bag_(file), train_(FindTrain(bag_, train)) {
  for (const BagFile::Topic& topic : bag_.topics()) {
    const std::string above = NamespaceOf(topic.name);
    std::unique_ptr<RecordedTopic>* place = nullptr;
    if (above == train_) {
      if (IsOf<train_brake_msgs::TrainState>(topic)) place = &state_;
      if (IsOf<train_brake_msgs::InTrainForces>(topic)) place = &forces_;
      if (IsOf<train_brake_msgs::BrakePressures>(topic)) place = &pressures_;
      if (IsOf<train_brake_msgs::EnergyLedger>(topic)) place = &ledger_;
      if (IsOf<train_brake_msgs::Slides>(topic)) place = &slides_;
    } else if (NamespaceOf(above) == train_ && IsOf<train_brake_msgs::WagonState>(topic)) {
      place = &wagons_[above.substr(train_.size() + 1)];
    }
    if (place != nullptr) *place = std::make_unique<RecordedTopic>(bag_, topic);
  }
}

RecordedTopic* RecordedRun::wagon(const std::string& name) {
  const auto found = wagons_.find(name);
  return found == wagons_.end() ? nullptr : found->second.get();
}

std::vector<train_dynamics::DriverCommand> RecordedRun::LiveCommands() {
  std::vector<train_dynamics::DriverCommand> commands;
  for (const BagFile::Topic& topic : bag_.topics()) {
    if (topic.name != train_ + "/" + kGivenTopic || !IsOf<train_brake_msgs::GivenCommand>(topic)) continue;
    for (const auto& place : topic.messages) {
      Bytes bytes = bag_.Read(place);
      train_brake_msgs::GivenCommand given;
      try {
        train_brake_msgs::ReadMessage(bytes.data(), static_cast<std::uint32_t>(bytes.size()), given);
        if (given.live) commands.push_back(CommandOf(given.command, given.exchange));
      } catch (const std::exception& e) {
        throw UnreadableBag(topic.name + " has a command that cannot be read: " + e.what());
      }
    }
  }
  return commands;
}

std::optional<std::string> RecordedRun::Scenario() {
  for (const BagFile::Topic& topic : bag_.topics()) {
    if (topic.name != train_ + "/" + kScenarioTopic || !IsOf<std_msgs::String>(topic) || topic.messages.empty())
      continue;
    if (const auto text = TextOf(bag_.Read(topic.messages.front()))) return text;
  }
  return std::nullopt;
}

std::string WriterOf(const std::string& file) {
  BagFile bag(file);
  for (const BagFile::Topic& topic : bag.topics()) {
    const bool is_scenario = topic.type == ros::message_traits::datatype<std_msgs::String>() &&
                             topic.name == NamespaceOf(topic.name) + "/" + kScenarioTopic;
    if (!is_scenario || topic.messages.empty()) continue;
    const std::string text = TextOf(bag.Read(topic.messages.front())).value_or("");
    const std::string line = text.substr(0, text.find('\n'));
    if (line.rfind("# train_brake ", 0) == 0) return line.substr(2);
  }
  return "";
}

}  // namespace train_results
