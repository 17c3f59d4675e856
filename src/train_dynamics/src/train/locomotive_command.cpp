#include "train_dynamics/train/locomotive_command.h"

#include <algorithm>

#include "train_dynamics/vehicle_number.h"

namespace train_dynamics {
namespace {

/// Why a locomotive cannot obey a command; empty: it can.
std::string WhyNot(const LocomotiveCommand& command, const TractionParams& traction) {
  if (command.kind == LocomotiveCommandKind::kDynamicBrake) {
    if (!traction.dynamic_brake) return "must be throttle for a locomotive without dynamic_brake";
    if (command.notch <= traction.dynamic_brake->Notches()) return "";
    return "must be at most " + std::to_string(traction.dynamic_brake->Notches()) +
           ", the highest notch of a dynamic brake of this train";
  }
  const int notches = traction.tractive_effort.throttle.Notches();
  if (command.notch <= notches) return "";
  return "must be at most " + std::to_string(notches) + ", the highest notch of a throttle of this train";
}

// What rules read of all groups.
const char kTraction[] = "train.consist[].vehicle.traction";
const char kLocomotive[] = "train.consist[].locomotive";

}  // namespace

std::vector<BrokenRule> JudgeLocomotiveCommand(const LocomotiveCommand& command, const std::string& key,
                                               const TrainParams& train) {
  std::vector<BrokenRule> broken;
  const int count = train.VehicleCount();
  std::vector<const TractionParams*> obey;
  for (std::size_t j = 0; j < command.vehicles.size(); ++j) {
    const std::string entry = key + ".vehicles[" + std::to_string(j) + "]";
    const int vehicle = VehicleIndex(command.vehicles[j], count);
    if (vehicle < 0) {
      broken.push_back({entry, VehicleRule(count), {kVehicleCounts}});
    } else if (!train.VehicleAt(vehicle).traction) {
      broken.push_back({entry, "must be a locomotive: a vehicle with traction", {kVehicleCounts, kTraction}});
    } else {
      obey.push_back(&*train.VehicleAt(vehicle).traction);
    }
  }
  if (command.vehicles.empty()) {
    for (const ConsistGroupParams& group : train.consist) {
      if (group.vehicle.traction) obey.push_back(&*group.vehicle.traction);
    }
    if (obey.empty()) {
      broken.push_back({key + ".kind",
                        "must not be throttle or dynamic_brake for a train without a locomotive: no vehicle "
                        "has traction",
                        {kTraction}});
    }
  }
  for (const TractionParams* traction : obey) {
    const std::string why_not = WhyNot(command, *traction);
    if (why_not.empty()) continue;
    const bool is_kind = why_not.find("throttle for") != std::string::npos;
    broken.push_back({key + (is_kind ? ".kind" : ".notch"), why_not, {kVehicleCounts, kTraction}});
    break;
  }
  return broken;
}

std::vector<BrokenRule> JudgeLocomotiveBrakeCommand(const LocomotiveBrakeCommand& command, const std::string& key,
                                                    const TrainParams& train, const BrakeSystemParams& brake) {
  std::vector<BrokenRule> broken;
  const int count = train.VehicleCount();
  std::vector<char> is_locomotive;
  for (const ConsistGroupParams& group : train.consist)
    is_locomotive.insert(is_locomotive.end(), group.count, group.locomotive || group.vehicle.traction ? 1 : 0);
  for (std::size_t j = 0; j < command.vehicles.size(); ++j) {
    const std::string entry = key + ".vehicles[" + std::to_string(j) + "]";
    const int vehicle = VehicleIndex(command.vehicles[j], count);
    if (vehicle < 0) {
      broken.push_back({entry, VehicleRule(count), {kVehicleCounts}});
    } else if (!is_locomotive[vehicle]) {
      broken.push_back({entry,
                        "must be a locomotive: a vehicle with traction, or of a group with locomotive: true",
                        {kVehicleCounts, kTraction, kLocomotive}});
    }
  }
  const std::string what = command.kind == LocomotiveBrakeCommandKind::kBailOff ? "bail_off" : "independent_brake";
  if (command.vehicles.empty() && std::count(is_locomotive.begin(), is_locomotive.end(), 1) == 0)
    broken.push_back(
        {key + ".kind", "must not be " + what + " for a train without a locomotive", {kTraction, kLocomotive}});
  if (command.kind == LocomotiveBrakeCommandKind::kBailOff && brake.kind != BrakeSystemKind::kPneumatic)
    broken.push_back({key + ".kind",
                      "must not be bail_off with a brake of kind empirical, which has no cylinders that could be "
                      "emptied: take a brake of kind pneumatic",
                      {"brake.kind"}});
  if (command.pressure_kpa > brake.locomotive_brake.maximum_independent_kpa)
    broken.push_back({key + ".pressure_kpa",
                      "must be at most brake.locomotive_brake.maximum_independent_kpa, " +
                          ShortestDecimal(brake.locomotive_brake.maximum_independent_kpa),
                      {"brake.locomotive_brake.maximum_independent_kpa"}});
  return broken;
}

}  // namespace train_dynamics
