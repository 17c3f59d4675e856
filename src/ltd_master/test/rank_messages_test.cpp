#include "ltd_master/ranks/rank_messages.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "ltd_master/ranks/late_watch.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/snapshot.h"

namespace ltd_master {
namespace {

using train_brake_msgs::StepResponse;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kCount = 3;  // vehicles of each of the two ranks

/// Replies to exchange 4 with all that may be asked for, the second of which is spoilt.
class RankMessagesTest : public testing::Test {
 protected:
  /// What the master says of them; empty: nothing.
  std::string Complaint(const std::function<void(StepResponse&)>& spoil, const std::string& model = "model=2d") {
    const auto scenario = train_dynamics::config::LoadScenario(
        std::string(TRAIN_BRAKE_CONFIG_DIR) + "/../test/short_train.yaml", {model, "detail_vehicles=[]"});
    RankMessages messages({{"/a", 0, kCount}, {"/b", kCount, kCount}}, 1, scenario.params);
    train_dynamics::ExchangeRequest request;
    request.exchange = 4;
    request.record = request.ledger = request.snapshot = true;
    for (std::uint64_t rank = 0; rank < 2; ++rank) messages.step[rank].response = Reply(rank * kCount);
    spoil(messages.step[1].response);
    try {
      messages.Unpack(request, reply_);
    } catch (const RankFailure& e) {
      return e.what();
    }
    return "";
  }

  static StepResponse Reply(std::uint64_t first) {
    StepResponse reply;
    reply.ok = true;
    reply.exchange = 4;
    train_brake_msgs::RankRecord& record = reply.record;
    const auto fill = [](const auto& field, auto& array) { array.assign(kCount * field.numbers, 1.0); };
    train_dynamics::ForEachReplyField(fill, reply);
    train_dynamics::ForEachRecordField(fill, record);
    train_dynamics::ForEachEnergy(fill, record);
    record.state_digest.assign(kCount, 1);
    record.wheelset_work_j.assign(kCount * 2 * train_dynamics::kMostWheelsets, 1.0);
    reply.snapshot = Snapshot(first, 1.0);
    return reply;
  }
  static std::vector<std::uint8_t> Snapshot(std::uint64_t first, double number) {
    return train_dynamics::Encode(train_dynamics::BlockSnapshot{5, first, {{1.0}, {number}, {1.0}}});
  }

  train_dynamics::ExchangeReply reply_{2 * kCount, {}};
};

TEST_F(RankMessagesTest, TakesWhatIsSound) {
  EXPECT_EQ(Complaint([](auto&) {}), "");
  EXPECT_EQ(reply_.fault.vehicle, -1);
  EXPECT_EQ(reply_.snapshot.size(), 6u);
  EXPECT_EQ(Complaint(
                [](auto& r) {
                  r.record.wheel_force_n = r.record.creepage = {kNaN, kNaN, kNaN};
                },
                "model=ltd"),
            "");
}

TEST_F(RankMessagesTest, AsksOfEachVehicleWhatItsModelComputes) {
  const std::string mixed = "train.consist[2].model=ltd";  // vehicle 6, the last one of rank b
  EXPECT_EQ(Complaint([](auto& r) { r.record.creepage[2] = kNaN; }, mixed), "");
  EXPECT_NE(Complaint([](auto& r) { r.record.creepage[1] = kNaN; }, mixed), "");
  EXPECT_NE(Complaint([](auto& r) { r.record.shoe_force_n[2] = kNaN; }, mixed), "");
}

TEST_F(RankMessagesTest, TakesSlidesOfItsVehiclesOnly) {
  using train_dynamics::kSlideNumbers;
  const auto slide_of = [](double vehicle) {
    return [vehicle](auto& r) {
      r.record.slides.assign(2 * kSlideNumbers, 1.0);
      r.record.slides[0] = r.record.slides[kSlideNumbers] = vehicle;
    };
  };
  EXPECT_EQ(Complaint(slide_of(5.0)), "");
  ASSERT_EQ(reply_.slides.size(), 2u);
  EXPECT_EQ(reply_.slides[1].vehicle, 5.0);
  EXPECT_EQ(Complaint(slide_of(3.0)),
            "/b (vehicles 4-6), exchange 4: replied a slide of vehicle 3, which it does not have");
  EXPECT_NE(Complaint([](auto& r) { r.record.slides.assign(5, 4.0); }).find("replied with malformed slides"),
            std::string::npos);
  EXPECT_NE(Complaint([](auto& r) { r.record.wheelset_work_j.clear(); }).find("wheelset_work_j"), std::string::npos);
}

TEST_F(RankMessagesTest, RefusesArraysOfAnotherSize) {
  EXPECT_EQ(Complaint([](auto& r) { r.record.creepage.pop_back(); }),
            "/b (vehicles 4-6), exchange 4: replied 2 values of creepage, 3 are expected");
  EXPECT_EQ(Complaint([](auto& r) { r.head_velocity_mps.clear(); }),
            "/b (vehicles 4-6), exchange 4: replied 0 values of head_velocity_mps, 3 are expected");
  EXPECT_EQ(Complaint([](auto& r) { r.record.kinetic_j.push_back(0.0); }),
            "/b (vehicles 4-6), exchange 4: replied 4 values of kinetic_j, 3 are expected");
}

TEST_F(RankMessagesTest, TakesFaultsOfTheRanksOwnVehiclesOnly) {
  for (const std::uint32_t vehicle : {4u, 6u}) {
    EXPECT_EQ(Complaint([=](auto& r) { r.fault_vehicle = vehicle; }), "");
    EXPECT_EQ(reply_.fault.vehicle, static_cast<int>(vehicle) - 1);
  }
  for (const std::uint32_t vehicle : {1u, 3u, 7u, 0x80000000u, 0xFFFFFFFFu}) {
    EXPECT_EQ(Complaint([=](auto& r) { r.fault_vehicle = vehicle; }),
              "/b (vehicles 4-6), exchange 4: replied a fault of vehicle " + std::to_string(vehicle) +
                  ", which it does not have");
  }
}

TEST_F(RankMessagesTest, NamesWhatIsNotFinite) {
  const auto of_vehicle_5 = [](const std::string& name) {
    return "/b (vehicles 4-6), exchange 4: replied " + name + " = nan for vehicle 5";
  };
  EXPECT_EQ(Complaint([](auto& r) { r.head_velocity_mps[1] = kNaN; }), of_vehicle_5("head_velocity_mps"));
  EXPECT_EQ(Complaint([](auto& r) { r.record.position_m[1] = kNaN; }), of_vehicle_5("position_m"));
  EXPECT_EQ(Complaint([](auto& r) { r.record.speed_mps[1] = kNaN; }), of_vehicle_5("speed_mps"));
  EXPECT_EQ(Complaint([](auto& r) { r.record.shoe_force_n[1] = kNaN; }), of_vehicle_5("shoe_force_n"));
  EXPECT_EQ(Complaint([](auto& r) { r.record.wheel_force_n[1] = kNaN; }), of_vehicle_5("wheel_force_n"));
  EXPECT_EQ(Complaint([](auto& r) { r.record.creepage[1] = kNaN; }), of_vehicle_5("creepage"));
  EXPECT_EQ(Complaint([](auto& r) { r.record.shoe_force_n[1] = kNaN; }, "model=ltd"), of_vehicle_5("shoe_force_n"));
  EXPECT_EQ(Complaint([](auto& r) { r.record.dissipated_j.back() = kNaN; }),
            "/b (vehicles 4-6), exchange 4: replied energies that are not finite");
  EXPECT_EQ(Complaint([](auto& r) { r.snapshot = Snapshot(kCount, kNaN); }),
            "/b (vehicles 4-6), exchange 4: replied a snapshot that is not finite");
}

}  // namespace
}  // namespace ltd_master
