#include "train_results/bag_recorder.h"

#include <algorithm>

namespace train_results {

using train_dynamics::ByteReader;
using train_dynamics::Bytes;
using train_dynamics::ByteWriter;

BagRecorder::BagRecorder(const std::string& file, const train_dynamics::ScenarioParams& scenario)
    : bag_(file),
      state_topic_(bag_.AddTopic<train_brake_msgs::TrainState>("/train/state")),
      forces_topic_(bag_.AddTopic<train_brake_msgs::InTrainForces>("/train/in_train_forces")),
      pressures_topic_(bag_.AddTopic<train_brake_msgs::BrakePressures>("/train/brake_pressures")),
      ledger_topic_(bag_.AddTopic<train_brake_msgs::EnergyLedger>("/train/energy_ledger")) {
  constexpr bool kLatched = true;
  const int scenario_topic = bag_.AddTopic<std_msgs::String>(std::string("/train/") + kScenarioTopic, kLatched);
  bag_.Write(scenario_topic, ros::TIME_MIN, ScenarioMessage(scenario));
}

BagRecorder::BagRecorder(const std::string& file, const Bytes& checkpoint, int vehicles)
    : bag_(file, ByteReader(checkpoint).Block()) {
  ByteReader reader(checkpoint);
  reader.Block();  // the bag's
  const auto below = [&reader](int limit, const char* what) {
    const std::uint64_t word = reader.Word();
    if (word >= static_cast<std::uint64_t>(limit)) {
      throw train_dynamics::SnapshotError(std::string("is damaged: no such ") + what);
    }
    return static_cast<int>(word);
  };
  for (int* topic : {&state_topic_, &forces_topic_, &pressures_topic_, &ledger_topic_}) {
    *topic = below(bag_.topics(), "topic");
  }
  slides_topic_ = below(bag_.topics() + 1, "topic") - 1;
  given_topic_ = below(bag_.topics() + 1, "topic") - 1;
  for (std::uint64_t count = reader.Word(); count > 0; --count) {
    const int vehicle = below(vehicles, "vehicle");
    wagon_topic_[vehicle] = below(bag_.topics(), "topic");
  }
  reader.End();
}

Bytes BagRecorder::Checkpoint() {
  ByteWriter writer;
  writer.Add(bag_.Checkpoint());
  for (const int topic : {state_topic_, forces_topic_, pressures_topic_, ledger_topic_}) {
    writer.Add(static_cast<std::uint64_t>(topic));
  }
  writer.Add(static_cast<std::uint64_t>(slides_topic_) + 1);
  writer.Add(static_cast<std::uint64_t>(given_topic_) + 1);
  writer.Add(std::uint64_t{wagon_topic_.size()});
  for (const auto& [vehicle, topic] : wagon_topic_) {
    writer.Add(static_cast<std::uint64_t>(vehicle));
    writer.Add(static_cast<std::uint64_t>(topic));
  }
  return writer.bytes();
}

template <class View>
void BagRecorder::WriteView(int topic, ros::Time time, const train_dynamics::TrainRecord& record) {
  View view;
  Convert(record, view);
  bag_.WriteView(topic, time, view);
}

void BagRecorder::Record(const train_dynamics::TrainRecord& record) {
  // A bag knows no time before this one.
  const ros::Time time = std::max(ros::TIME_MIN, ros::Time(record.time_s));
  WriteView<TrainStateView>(state_topic_, time, record);
  WriteView<InTrainForcesView>(forces_topic_, time, record);
  WriteView<BrakePressuresView>(pressures_topic_, time, record);
  if (record.ledger) {
    Convert(record, ledger_);
    bag_.Write(ledger_topic_, time, ledger_);
  }
  if (!record.slides.empty()) {
    if (slides_topic_ < 0) slides_topic_ = bag_.AddTopic<train_brake_msgs::Slides>("/train/slides");
    Convert(record, slides_);
    bag_.Write(slides_topic_, time, slides_);
  }
  for (const train_dynamics::GivenCommand& given : record.given) {
    if (given_topic_ < 0)
      given_topic_ = bag_.AddTopic<train_brake_msgs::GivenCommand>(std::string("/train/") + kGivenTopic);
    Convert(given, record.time_s, given_);
    bag_.Write(given_topic_, time, given_);
  }
  const int vehicles = static_cast<int>(record.vehicles.position_m.size());
  for (const train_dynamics::WagonDetail& detail : record.vehicles.details) {
    Convert(record, detail, wagon_);
    bag_.Write(WagonTopic(detail.vehicle, vehicles), time, wagon_);
  }
}

int BagRecorder::WagonTopic(int vehicle, int vehicles) {
  const auto [topic, is_new] = wagon_topic_.try_emplace(vehicle);
  if (is_new) {
    topic->second = bag_.AddTopic<train_brake_msgs::WagonState>(
        "/train/" + train_dynamics::VehicleName(vehicle, vehicles) + "/state");
  }
  return topic->second;
}

}  // namespace train_results
