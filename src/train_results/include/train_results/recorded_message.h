#pragma once

#include <train_brake_msgs/BrakePressures.h>
#include <train_brake_msgs/EnergyLedger.h>
#include <train_brake_msgs/InTrainForces.h>
#include <train_brake_msgs/Slides.h>
#include <train_brake_msgs/TrainState.h>
#include <train_brake_msgs/WagonState.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "train_results/bag_file.h"

/// Compares recorded messages, as bytes, with the expected ones. The bytes are not trusted: no size that they announce
/// is allocated.
namespace train_results {

/// A recorded value that differs from that of the repeated run.
struct Difference {
  int vehicle = 0;       ///< from 1; 0: not of a single vehicle
  std::string quantity;  ///< the field's name
  std::string text;      ///< "vehicle 101, front bolster: body_z_m is 0.0012 in the bag, 0.0013 now"
};

/// The field `exchange` of a message that begins with a header and this field; nothing if it is too short for both.
std::optional<std::uint64_t> ExchangeOf(const Bytes& message);

/// Compares all fields but the header, in the order and with the names of the definition; NaN equals NaN.
/// @return where they differ; ends with the first array whose size differs
std::vector<Difference> Compare(const Bytes& recorded, const train_brake_msgs::TrainState& repeated);
std::vector<Difference> Compare(const Bytes& recorded, const train_brake_msgs::InTrainForces& repeated);
std::vector<Difference> Compare(const Bytes& recorded, const train_brake_msgs::BrakePressures& repeated);
std::vector<Difference> Compare(const Bytes& recorded, const train_brake_msgs::EnergyLedger& repeated);
std::vector<Difference> Compare(const Bytes& recorded, const train_brake_msgs::Slides& repeated);
std::vector<Difference> Compare(const Bytes& recorded, const train_brake_msgs::WagonState& repeated);

}  // namespace train_results
