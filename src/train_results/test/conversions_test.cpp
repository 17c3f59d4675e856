#include "train_results/conversions.h"

#include <gtest/gtest.h>
#include <ros/message_traits.h>
#include <train_brake_msgs/Configure.h>
#include <train_brake_msgs/Step.h>

#include <cstdint>
#include <limits>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace train_results {
namespace {

using Names = std::set<std::string>;

/// The arrays of 64-bit or 32-bit floating-point numbers that a message's definition has.
template <class Message>
Names ArraysOf() {
  Names names;
  std::istringstream definition(ros::message_traits::Definition<Message>::value());
  for (std::string line; std::getline(definition, line) && line.rfind("====", 0) != 0;) {
    std::istringstream words(line);
    std::string type, name;
    words >> type >> name;
    if (type == "float64[]" || type == "float32[]") names.insert(name);
  }
  return names;
}

Names RecordNames() {
  Names names;
  train_dynamics::RecordArrays record;
  train_dynamics::ForEachRecordField(
      [&](const train_dynamics::RecordInfo& field, const auto&) { names.insert(field.name); }, record);
  return names;
}

// A field of a list that its message lacks does not compile. The other way round:

TEST(Lists, HaveEveryArrayOfTheRecordOfARank) {
  Names names = RecordNames();
  train_dynamics::VehicleEnergy energy;
  train_dynamics::ForEachEnergy([&](const train_dynamics::FieldInfo& field, const auto&) { names.insert(field.name); },
                                energy);
  names.insert({"wheelset_work_j", "slides"});  // of wheelsets, whose number varies
  EXPECT_EQ(ArraysOf<train_brake_msgs::RankRecord>(), names)
      << "vehicle/vehicle_record.h and vehicle/work.h list what RankRecord.msg has";
}

TEST(Lists, HaveEveryArrayOfSlides) {
  Names names;
  train_dynamics::SlideEvent slide;
  train_dynamics::ForEachSlideField([&](const char* name, const char*, double) { names.insert(name); }, slide);
  for (const char* of_whole_numbers : {"vehicle", "wheelset", "is_over"}) names.erase(of_whole_numbers);
  EXPECT_EQ(ArraysOf<train_brake_msgs::Slides>(), names) << "vehicle/slide_event.h lists what Slides.msg has";
}

TEST(Lists, HaveEveryArrayOfTheStateOfATrain) {
  Names names = RecordNames();
  names.insert("acceleration_mps2");  // the master's
  EXPECT_EQ(ArraysOf<train_brake_msgs::TrainState>(), names)
      << "vehicle/vehicle_record.h lists what TrainState.msg has";
}

TEST(Lists, HaveEveryArrayOfARequestAndItsReply) {
  Names names = {"coupler_force_n", "friction_patches"};  // of connections, of the rail
  train_dynamics::LoadArrays loads;
  train_dynamics::ForEachLoad([&](const train_dynamics::LoadInfo& load, const auto&) { names.insert(load.name); },
                              loads);
  EXPECT_EQ(ArraysOf<train_brake_msgs::StepRequest>(), names) << "vehicle/vehicle_loads.h lists what Step.srv has";
  names.clear();
  train_dynamics::ReplyArrays reply;
  train_dynamics::ForEachReplyField(
      [&](const train_dynamics::RecordInfo& field, const auto&) { names.insert(field.name); }, reply);
  EXPECT_EQ(ArraysOf<train_brake_msgs::StepResponse>(), names) << "vehicle/vehicle_record.h lists what Step.srv has";
  EXPECT_EQ(ArraysOf<train_brake_msgs::ConfigureResponse>(), names);
}

TEST(Conversions, TakeEveryQuantityOfARecordToTheState) {
  train_dynamics::TrainRecord record;
  record.vehicles = train_dynamics::VehicleRecords(2, {});
  double number = 1.0;
  train_dynamics::ForEachRecordField(
      [&](const train_dynamics::RecordInfo&, auto& array) {
        for (double& value : array) value = number++;
      },
      record.vehicles);
  train_brake_msgs::TrainState state;
  Convert(record, state);
  train_dynamics::ForEachRecordField(
      [](const train_dynamics::RecordInfo& field, const auto& from, const auto& to) {
        EXPECT_TRUE(std::equal(from.begin(), from.end(), to.begin(), to.end())) << field.name;
      },
      record.vehicles, state);
}

/// A message as bytes.
template <class Message>
std::vector<std::uint8_t> BytesOf(const Message& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

/// What the view of a record gives, and what its message does.
template <class View>
void ExpectTheBytesOfTheMessage(const train_dynamics::TrainRecord& record) {
  View view;
  Convert(record, view);
  std::vector<std::uint8_t> bytes(SerializedLength(view));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  Serialize(stream, view);
  typename View::Message message;
  Convert(record, message);
  EXPECT_EQ(BytesOf(message), bytes) << ros::message_traits::datatype<typename View::Message>();
}

TEST(Conversions, ViewsHaveTheBytesOfTheirMessages) {
  train_dynamics::TrainRecord record;
  for (const int vehicles : {1, 3}) {
    record.vehicles = train_dynamics::VehicleRecords(vehicles, {});
    record.time_s = 12.345678901;
    record.exchange = 12346;
    record.state_digest = 0x123456789abcdef0;
    double number = 0.1;
    const auto fill = [&](std::vector<double>& array, int count) {
      array.clear();
      for (int i = 0; i < count; ++i) array.push_back(number *= -1.3);
    };
    train_dynamics::ForEachRecordField([&](const train_dynamics::RecordInfo&, auto& array) { fill(array, vehicles); },
                                       record.vehicles);
    record.vehicles.state_digest.assign(vehicles, 0xfedcba9876543210);
    fill(record.acceleration_mps2, vehicles);
    fill(record.held.coupler_force_n, vehicles + 1);
    fill(record.coupler_extension_m, vehicles - 1);
    fill(record.cylinder_pressure_pa, vehicles);
    if (vehicles == 3) fill(record.brake.pipe_pressure_pa, vehicles);
    record.vehicles.creepage[0] = std::numeric_limits<double>::quiet_NaN();
    ExpectTheBytesOfTheMessage<TrainStateView>(record);
    ExpectTheBytesOfTheMessage<InTrainForcesView>(record);
    ExpectTheBytesOfTheMessage<BrakePressuresView>(record);
  }
}

TEST(Conversions, TakeEverySlide) {
  train_dynamics::TrainRecord record;
  record.slides.resize(2);
  record.slides[1].vehicle = 7.0;
  record.slides[1].wheelset = 3.0;
  record.slides[1].energy_j = 1.25e5;
  train_brake_msgs::Slides message;
  message.vehicle = {1, 2, 3, 4};  // of a message before
  Convert(record, message);
  ASSERT_EQ(message.vehicle.size(), 2u);
  EXPECT_EQ(message.vehicle[1], 7u);
  EXPECT_EQ(message.wheelset[1], 3u);
  EXPECT_EQ(message.energy_j, (std::vector<double>{0.0, 1.25e5}));
}

}  // namespace
}  // namespace train_results
