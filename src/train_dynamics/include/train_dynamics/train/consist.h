#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "train_dynamics/coupler/connection.h"
#include "train_dynamics/vehicle/vehicle_model.h"
#include "train_dynamics/vehicle/vehicle_params.h"

namespace train_dynamics {

/// The names of the models in configurations.
inline constexpr std::initializer_list<std::pair<const char*, VehicleModel>> kVehicleModels = {
    {ModelName(VehicleModel::kTwoD), VehicleModel::kTwoD},
    {ModelName(VehicleModel::kLtd), VehicleModel::kLtd},
    {ModelName(VehicleModel::kLtdNoInertia), VehicleModel::kLtdNoInertia}};

/// The names of the states of slack in configurations.
inline constexpr std::initializer_list<std::pair<const char*, SlackState>> kSlackStates = {
    {"stretched", SlackState::kStretched}, {"middle", SlackState::kMiddle}, {"bunched", SlackState::kBunched}};

/// A run of equal vehicles, possibly in permanently joined units.
struct ConsistGroupParams {
  VehicleParams vehicle;
  int count = 1;
  int vehicles_per_unit = 1;
  ConnectionParams unit_connection;
  std::optional<VehicleModel> model = std::nullopt;
  std::optional<double> initial_speed_kmh = std::nullopt;
  double command_delay_s = 0.0;
  std::string external;
  std::string name;
  std::optional<SlackState> initial_slack = std::nullopt;
  std::optional<double> trapped_cylinder_pressure_kpa = std::nullopt;
  double initial_throttle_notch = 0.0, initial_dynamic_brake_notch = 0.0;
  bool locomotive = false;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Part("vehicle", vehicle, "vehicles", "the vehicle of the group, count times");
    v.Number("load_fraction", vehicle.load_fraction, kFraction,
             "how much of its load each vehicle of the group carries, in place of the vehicle's own");
    v.Check(vehicle.load || !vehicle.load_fraction, "load_fraction",
            "needs a vehicle with load: what it carries when it is full", {"vehicle.load"});
    v.Choice("model", model, kVehicleModels, "model of the group's vehicles; not given: that of the scenario");
    v.Text("external", external,
           "node whose services move the vehicles, in the train's namespace; empty: this program moves them");
    v.Check(external.empty() || !model, "model", "must not be given for external vehicles: their node is their model",
            {"external"});
    v.Number("initial_speed_kmh", initial_speed_kmh, Range{-400.0, 400.0, false, false},
             "speed of the group at time 0; not given: that of the scenario");
    v.Integer("count", count, Range{1, 100000, false, false}, "number of vehicles");
    v.Flag("locomotive", locomotive, "the vehicles are shown as locomotives; those with traction are, anyway");
    v.Number("command_delay_s", command_delay_s, kNonNegative,
             "delay of the driver's commands on their way to locomotives of the group");
    v.Text("name", name, "by which commands name the locomotives of the group; several groups may share it");
    v.Choice("initial_slack", initial_slack, kSlackStates,
             "where the slack of the connections in front of the group's vehicles is at time 0; not given: "
             "that of "
             "the scenario");
    v.Number("trapped_cylinder_pressure_kpa", trapped_cylinder_pressure_kpa, Range{0.0, 1000.0, false, false},
             "air that stays in the brake cylinders of the group for the whole run, whatever the driver does: the "
             "control valves are cut out, as of wagons left standing with brakes applied or of a brake that "
             "sticks; 0: they were bled; not given: the brake works");
    v.Check(!trapped_cylinder_pressure_kpa || !vehicle.brake_rigging.cut_out, "trapped_cylinder_pressure_kpa",
            "has no effect in a vehicle with brake_rigging.cut_out", {"vehicle.brake_rigging.cut_out"});
    v.Number("initial_throttle_notch", initial_throttle_notch, Range{0.0, 100.0, false, false},
             "that locomotives of the group obey at time 0, with the steady effort of their speed");
    v.Number("initial_dynamic_brake_notch", initial_dynamic_brake_notch, Range{0.0, 100.0, false, false},
             "likewise, of the dynamic brake");
    v.Check(initial_throttle_notch == 0.0 || initial_dynamic_brake_notch == 0.0, "initial_throttle_notch",
            "must be 0 beside an initial_dynamic_brake_notch", {"initial_dynamic_brake_notch"});
    v.Integer("vehicles_per_unit", vehicles_per_unit, Range{1, 100000, false, false},
              "vehicles that are permanently joined; 2: pairs, as of draw-bar wagons");
    if (vehicles_per_unit > 1) v.Part("unit_connection", unit_connection, "couplers", "connection within a unit");
    v.Check(vehicles_per_unit >= 1 && count % vehicles_per_unit == 0, "count",
            "must be a multiple of vehicles_per_unit", {"vehicles_per_unit"});
  }
};

/// A train: groups of vehicles from front to rear. `connection` joins the units.
struct TrainParams {
  std::string name;
  ConnectionParams connection;
  std::vector<ConsistGroupParams> consist;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Text("name", name, "name of the train, for people");
    v.Part("connection", connection, "couplers", "connection between units");
    v.List("consist", consist, "groups of vehicles from front to rear; may be a CSV file");
    v.Check(!consist.empty(), "consist", "must list at least one group of vehicles");
    long vehicles = 0;
    for (std::size_t i = 0; i < consist.size(); ++i) {
      const bool fitted = vehicles <= 100000;
      vehicles += consist[i].count;
      v.Check(!fitted || vehicles <= 100000, "consist[" + std::to_string(i) + "].count",
              "makes the train too long: it must have at most 100000 vehicles in all", {"consist"});
    }
  }

  int VehicleCount() const;
  /// @param index  from 0, below VehicleCount()
  const VehicleParams& VehicleAt(int index) const;
};

/// A train vehicle by vehicle. Vehicles count from 0 here, from 1 in everything that people read.
struct Consist {
  explicit Consist(const TrainParams& train);

  std::vector<VehicleParams> vehicle_types;  ///< one of each group, in their order
  std::vector<int> vehicle_type;             ///< [vehicle] index into vehicle_types and TrainParams::consist
  std::vector<int> locomotives;              ///< indices of vehicles, ascending
  std::vector<double> command_delay_s;       ///< [type of vehicle]
  std::vector<NotchCommand> initial_notch;   ///< [type of vehicle]
  std::vector<std::optional<SlackState>> initial_slack;  ///< [type of vehicle] of the connections in front of it
  std::vector<ConnectionParams> connection_types;
  std::vector<int> connection_type;  ///< [connection] between vehicles c and c + 1
  std::vector<double> centre_m;      ///< [vehicle] on the unstretched train; 0 = centre of the first, falling

  int vehicles() const { return static_cast<int>(vehicle_type.size()); }
  const VehicleParams& vehicle(int i) const { return vehicle_types[vehicle_type[i]]; }
};

}  // namespace train_dynamics
