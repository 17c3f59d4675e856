#include "train_results/recorded_message.h"

#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <limits>
#include <string>

namespace train_results {
namespace {

constexpr std::size_t kHeader = 16;  // bytes of a header without a frame: number, time, length of the frame

template <class Message>
Bytes BytesOf(const Message& message) {
  Bytes bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  stream.next(message);
  return bytes;
}

train_brake_msgs::TrainState State() {
  train_brake_msgs::TrainState state;
  state.exchange = 7;
  state.position_m = state.speed_mps = {1.0, 2.0, 3.0};
  state.acceleration_mps2 = state.shoe_force_n = state.wheel_force_n = state.creepage = {1.0F, 2.0F, 3.0F};
  state.vehicle_digest = {4, 5, 6};
  state.state_digest = 8;
  return state;
}

train_brake_msgs::EnergyLedger Ledger() {
  train_brake_msgs::EnergyLedger ledger;
  ledger.element = {"air_drag", "brake_shoes"};
  ledger.dissipated_j = {1.0, 2.0};
  ledger.kinetic_j = 3.0;
  return ledger;
}

train_brake_msgs::WagonState Wagon() {
  train_brake_msgs::WagonState wagon;
  wagon.vehicle = 12;
  return wagon;
}

/// Every byte counts but for the header's running number, and so does the size.
template <class Message>
void ExpectEveryByteCounts(const Message& message) {
  const Bytes right = BytesOf(message);
  EXPECT_TRUE(Compare(right, message).empty());
  for (std::size_t i = 0; i < right.size(); ++i) {
    Bytes wrong = right;
    wrong[i] ^= 0x40u;  // of no number here does this make the same one, or -0 of 0
    EXPECT_EQ(Compare(wrong, message).empty(), i < 4) << "byte " << i;
    EXPECT_FALSE(Compare(Bytes(right.begin(), right.begin() + static_cast<long>(i)), message).empty()) << i << " bytes";
  }
  Bytes longer = right;
  longer.push_back(0);
  EXPECT_FALSE(Compare(longer, message).empty());
}

TEST(RecordedMessage, EveryByteCounts) {
  ExpectEveryByteCounts(State());
  ExpectEveryByteCounts(Ledger());
  ExpectEveryByteCounts(Wagon());
  train_brake_msgs::InTrainForces forces;
  forces.coupler_force_n = forces.coupler_extension_m = {1.0F, 2.0F};
  ExpectEveryByteCounts(forces);
  train_brake_msgs::BrakePressures pressures;
  pressures.cylinder_pressure_pa = {1.0F, 2.0F};
  ExpectEveryByteCounts(pressures);
}

TEST(RecordedMessage, DifferencesNameWhoAndWhat) {
  train_brake_msgs::TrainState state = State();
  state.speed_mps[1] = 0.1;
  state.vehicle_digest[2] = 9;
  const std::vector<Difference> found = Compare(BytesOf(state), State());
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].vehicle, 2);
  EXPECT_EQ(found[0].text, "vehicle 2: speed_mps is 0.1 in the bag, 2 now");
  EXPECT_EQ(found[1].vehicle, 3);
  EXPECT_EQ(found[1].quantity, "vehicle_digest");

  train_brake_msgs::WagonState wagon = Wagon();
  wagon.body_pitch_radps[8] = -1.0;
  wagon.nest_compression_m[3] = 0.5F;
  const std::vector<Difference> of_wagon = Compare(BytesOf(wagon), Wagon());
  ASSERT_EQ(of_wagon.size(), 2u);
  EXPECT_EQ(of_wagon[0].text, "vehicle 12, wheelset 4: body_pitch_radps is -1 in the bag, 0 now");
  EXPECT_EQ(of_wagon[1].text, "vehicle 12, rear bogie, rear half: nest_compression_m is 0.5 in the bag, 0 now");
}

TEST(RecordedMessage, ZerosOfBothSignsDiffer) {
  train_brake_msgs::TrainState recorded = State(), repeated = State();
  recorded.speed_mps[1] = -0.0;
  repeated.speed_mps[1] = 0.0;
  const std::vector<Difference> found = Compare(BytesOf(recorded), repeated);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].text, "vehicle 2: speed_mps is -0 in the bag, 0 now");
}

TEST(RecordedMessage, StampsCount) {
  train_brake_msgs::TrainState recorded = State();
  recorded.header.stamp = ros::Time(1, 500000000);
  const std::vector<Difference> found = Compare(BytesOf(recorded), State());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].text, "header.stamp is 1.5 s in the bag, 0 s now");
}

TEST(RecordedMessage, NotANumberEqualsItself) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  train_brake_msgs::TrainState recorded = State(), repeated = State();
  recorded.creepage[0] = kNan;
  repeated.creepage[0] = -kNan;
  EXPECT_TRUE(Compare(BytesOf(recorded), repeated).empty());
  EXPECT_EQ(Compare(BytesOf(recorded), State()).size(), 1u);
}

TEST(RecordedMessage, SizesAreNotTrusted) {
  Bytes bytes = BytesOf(State());
  for (std::size_t i = 0; i < 4; ++i) bytes[kHeader + 8 + i] = 0xFF;  // the number of positions
  const std::vector<Difference> found = Compare(bytes, State());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].text, "position_m is of size 4294967295 in the bag, 3 now");
  for (std::size_t i = 0; i < 4; ++i) bytes[kHeader - 4 + i] = 0xFF;  // the length of the frame
  EXPECT_EQ(ExchangeOf(bytes), std::nullopt);
  EXPECT_EQ(Compare(bytes, State()).front().text, "a message is not as long as its definition says");
}

TEST(RecordedMessage, ExchangeStandsBehindTheFrame) {
  train_brake_msgs::TrainState state = State();
  EXPECT_EQ(ExchangeOf(BytesOf(state)), 7u);
  state.header.frame_id = "train";
  EXPECT_EQ(ExchangeOf(BytesOf(state)), 7u);
  EXPECT_TRUE(Compare(BytesOf(state), State()).empty()) << "the frame is left out";
  EXPECT_EQ(ExchangeOf(Bytes(kHeader + 7)), std::nullopt);
  EXPECT_EQ(ExchangeOf({}), std::nullopt);
}

}  // namespace
}  // namespace train_results
