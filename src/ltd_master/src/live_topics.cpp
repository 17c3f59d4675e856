#include "ltd_master/live_topics.h"

#include <algorithm>

namespace ltd_master {
namespace {

constexpr std::chrono::milliseconds kPeriod(50);

template <class Message>
ros::Publisher Latched(ros::NodeHandle& node, const std::string& topic) {
  constexpr int kQueue = 1;  // only the newest matters
  return node.advertise<Message>(topic, kQueue, true);
}

}  // namespace

LiveTopics::LiveTopics(const ros::NodeHandle& node)
    : node_(node, "live"),
      status_publisher_(Latched<train_brake_msgs::RunStatus>(node_, "status")),
      state_publisher_(Latched<train_brake_msgs::TrainState>(node_, "state")),
      forces_publisher_(Latched<train_brake_msgs::InTrainForces>(node_, "in_train_forces")),
      pressures_publisher_(Latched<train_brake_msgs::BrakePressures>(node_, "brake_pressures")) {}

void LiveTopics::Show(const train_dynamics::TrainRecord& record, const Pace& pace) {
  // Always kept: the run may be paused before the next one, and a subscriber may come then.
  last_ = record;
  has_record_ = held_back_ = true;
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  next_ = std::max(next_ + kPeriod, now);
  Publish(pace);
}

void LiveTopics::Settle(const Pace& pace) {
  const bool same = status_.state == pace.state && status_.real_time_factor == pace.real_time_factor &&
                    status_.wanted_real_time_factor == pace.wanted_real_time_factor;
  if (held_back_ || !same) Publish(pace);
}

std::optional<train_dynamics::TrainRecord> LiveTopics::last() const {
  return has_record_ ? std::make_optional(last_) : std::nullopt;
}

void LiveTopics::Publish(const Pace& pace) {
  status_.state = pace.state;
  status_.real_time_factor = pace.real_time_factor;
  status_.wanted_real_time_factor = pace.wanted_real_time_factor;
  if (has_record_) PublishRecord(last_);
  status_publisher_.publish(status_);
  held_back_ = false;
}

void LiveTopics::PublishRecord(const train_dynamics::TrainRecord& record) {
  train_results::Convert(record, state_);
  status_.header.stamp = state_.header.stamp;
  status_.exchange = record.exchange;
  status_.mean_speed_mps = record.mean_speed_mps;
  status_.travelled_m = record.mean_position_m - record.at_time_zero.mean_position_m;
  // The two ends of the train, which have no coupler and no force, are in the list: hence >= 0 and <= 0.
  const auto [smallest, largest] =
      std::minmax_element(record.held.coupler_force_n.begin(), record.held.coupler_force_n.end());
  status_.max_tension_n = *largest;
  status_.max_compression_n = *smallest;
  if (!held_back_) return;  // only the pace has changed
  train_results::Convert(record, forces_);
  train_results::Convert(record, pressures_);
  state_publisher_.publish(state_);
  forces_publisher_.publish(forces_);
  pressures_publisher_.publish(pressures_);
  const int vehicles = static_cast<int>(state_.position_m.size());
  for (const train_dynamics::WagonDetail& detail : record.vehicles.details) {
    ros::Publisher& publisher = wagon_publishers_[detail.vehicle];
    if (!publisher)
      publisher = Latched<train_brake_msgs::WagonState>(
          node_, train_dynamics::VehicleName(detail.vehicle, vehicles) + "/state");
    train_results::Convert(record, detail, wagon_);
    publisher.publish(wagon_);
  }
}

}  // namespace ltd_master
