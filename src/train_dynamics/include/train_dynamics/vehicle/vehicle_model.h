#pragma once

namespace train_dynamics {

/// How the motion of a vehicle is computed. A train may have vehicles of different models.
enum class VehicleModel {
  kTwoD,         ///< bodies in the vertical plane along the track: vehicle/wagon.h
  kLtd,          ///< one DoF, with the equivalent rotational mass: vehicle/ltd_vehicle.h
  kLtdNoInertia  ///< one DoF, without it
};

/// The name of a model in configurations and on command lines.
constexpr const char* ModelName(VehicleModel model) {
  switch (model) {
    case VehicleModel::kLtd:
      return "ltd";
    case VehicleModel::kLtdNoInertia:
      return "ltd-no-inertia";
    default:
      return "2d";
  }
}

}  // namespace train_dynamics
