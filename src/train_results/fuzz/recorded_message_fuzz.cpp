// Recorded messages as they lie in a bag, which may be damaged or forged. The first byte of the input chooses the type.

#include <ros/serialization.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fuzz.h"
#include "train_results/recorded_message.h"

namespace {

using train_brake_build::fuzz::Require;
using train_results::Bytes;

template <class Message>
void Test(const Message& repeated, const Bytes& recorded) {
  Bytes right(ros::serialization::serializationLength(repeated));
  ros::serialization::OStream stream(right.data(), static_cast<std::uint32_t>(right.size()));
  stream.next(repeated);
  Require(train_results::Compare(right, repeated).empty(), "a message is the same as itself");
  Require(train_results::ExchangeOf(right) == repeated.exchange, "a message tells its exchange");

  const bool may_be_same = recorded.size() >= right.size();  // longer, if the header's frame is not empty
  Require(may_be_same || !train_results::Compare(recorded, repeated).empty(), "a truncated message differs");
  train_results::ExchangeOf(recorded);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Bytes recorded(data + 1, data + size);
  constexpr std::size_t kVehicles = 2;
  train_brake_msgs::TrainState state;
  state.position_m.resize(kVehicles);
  state.vehicle_digest.resize(kVehicles);
  train_brake_msgs::InTrainForces forces;
  forces.coupler_force_n.resize(kVehicles - 1);
  train_brake_msgs::BrakePressures pressures;
  pressures.cylinder_pressure_pa.resize(kVehicles);
  train_brake_msgs::EnergyLedger ledger;
  ledger.element = {"air_drag", "brake_shoes"};
  ledger.dissipated_j.resize(ledger.element.size());
  switch (data[0] % 5) {
    case 0:
      Test(state, recorded);
      break;
    case 1:
      Test(forces, recorded);
      break;
    case 2:
      Test(pressures, recorded);
      break;
    case 3:
      Test(ledger, recorded);
      break;
    default:
      Test(train_brake_msgs::WagonState(), recorded);
  }
  return 0;
}
