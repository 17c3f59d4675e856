#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "train_dynamics/track/track.h"
#include "train_dynamics/vehicle/wagon.h"
#include "train_dynamics/vehicle/wagon_step.h"

namespace train_dynamics {

constexpr double kStep = 1e-3;           // [s] the project's step
constexpr double kFullPressure = 430e3;  // [Pa]

// Cylinder pressure of one vehicle after an emergency command at time 0.
inline double EmergencyPressure(double time_s) { return kFullPressure * (1.0 - std::exp(-0.238 * time_s)); }

// A vehicle under way, with its books.
template <int kPerBogie>
class RideOn {
 public:
  RideOn(const VehicleParams& params, const Track& on, double speed, double origin = 0.0)
      : wagon(params), track(on), state(StaticEquilibrium(wagon, origin, speed)) {
    Rebook();
  }

  void Step(double dt) {
    if (loads_at) loads = loads_at(time_s + 0.5 * dt);
    const double head = CouplerHead(wagon, state.position);
    StepWagon(wagon, track, loads, dt, state, &output);
    coupler_work_ += (loads.front_coupler_n - loads.rear_coupler_n) * (CouplerHead(wagon, state.position) - head);
    time_s += dt;
  }
  void Run(double duration, double dt = kStep) {
    for (long i = std::lround(duration / dt); i > 0; --i) Step(dt);
  }

  double Energy() const { return KineticEnergy(wagon, state) + PotentialEnergy(wagon, track, state); }
  double Dissipated() const { return std::accumulate(state.work.dissipated.begin(), state.work.dissipated.end(), 0.0); }
  // What the books miss [J].
  double Residual() const {
    return Energy() + Dissipated() - initial_energy - state.work.gravity - state.work.traction - coupler_work_;
  }
  // Takes the present state as the initial one.
  void Rebook() { initial_energy = Energy(); }

  double Creep() const { return std::accumulate(output.creep_force_n.begin(), output.creep_force_n.end(), 0.0); }
  double Shoes() const { return std::accumulate(output.shoe_force_n.begin(), output.shoe_force_n.end(), 0.0); }
  double Speed() const { return state.velocity.x[kCarbody]; }
  double Distance() const { return state.position.x[kCarbody]; }

  BogieVehicle<kPerBogie> wagon;
  Track track;
  VehicleLoads<double> loads;
  std::function<VehicleLoads<double>(double time_s)> loads_at;
  WagonState<double, kPerBogie> state;
  WagonOutput<double, kPerBogie> output;
  double time_s = 0.0;
  double initial_energy = 0.0;

 private:
  double coupler_work_ = 0.0;
};

using Ride = RideOn<2>;

inline VehicleLoads<double> EmergencyLoads(double time_s) {
  VehicleLoads<double> loads;
  loads.cylinder_pressure_pa = EmergencyPressure(time_s);
  return loads;
}

// The largest difference between the coordinates of two states.
template <int kPerBogie>
double Difference(const BodyVector<double, kPerBogie>& a, const BodyVector<double, kPerBogie>& b) {
  double largest = 0.0;
  for (int i = 0; i < kBodiesOf<kPerBogie>; ++i) {
    largest =
        std::max({largest, std::abs(a.x[i] - b.x[i]), std::abs(a.z[i] - b.z[i]), std::abs(a.pitch[i] - b.pitch[i])});
  }
  return largest;
}

// The state of a vehicle seen from the other side of the track.
template <int kPerBogie>
BodyVector<double, kPerBogie> Mirrored(const BodyVector<double, kPerBogie>& q) {
  const auto other = [](int body) {
    if (body == kCarbody) return static_cast<int>(kCarbody);
    if (body >= kWheelset1) return kWheelset1 + kBodiesOf<kPerBogie> - 1 - body;
    return body % 2 == 1 ? body + 1 : body - 1;  // front and rear bolster, front and rear frame
  };
  BodyVector<double, kPerBogie> mirrored;
  for (int i = 0; i < kBodiesOf<kPerBogie>; ++i) {
    mirrored.x[i] = -q.x[other(i)];
    mirrored.z[i] = q.z[other(i)];
    mirrored.pitch[i] = -q.pitch[other(i)];
  }
  return mirrored;
}

// Largest distance between a vehicle's run and the mirror image of the mirrored run.
template <int kPerBogie = 2>
double MirrorError(const VehicleParams& params) {
  TrackParams track, mirrored_track;
  track.grades = {{-1e3, -1.0}, {30.0, 0.5}};
  mirrored_track.grades = {{-1e3, -0.5}, {-30.0, 1.0}};
  track.dips = {{20.0, 0.03, 10.0}};
  mirrored_track.dips = {{-30.0, 0.03, 10.0}};
  track.friction_patches = {{35.0, 45.0, 0.03}};
  mirrored_track.friction_patches = {{-45.0, -35.0, 0.03}};
  RideOn<kPerBogie> forward(params, track, 12.0, 5.0), backward(params, mirrored_track, -12.0, -5.0);
  forward.loads_at = [](double t) {
    VehicleLoads<double> loads = EmergencyLoads(t);
    loads.front_coupler_n = 3e4 * std::sin(3.0 * t);
    loads.rear_coupler_n = 1e4;
    loads.traction_n = t < 1.0 ? 2e4 : 0.0;
    loads.dynamic_brake_n = 5e3;
    loads.curving_resistance_n = 1e3;
    return loads;
  };
  backward.loads_at = [&forward](double t) {
    VehicleLoads<double> loads = forward.loads_at(t);
    std::swap(loads.front_coupler_n, loads.rear_coupler_n);
    loads.traction_n = -loads.traction_n;
    return loads;
  };
  double error = 0.0;
  for (int ms = 0; ms < 50000; ++ms) {
    forward.Step(kStep);
    backward.Step(kStep);
    error = std::max(error, Difference(forward.state.position, Mirrored(backward.state.position)));
  }
  EXPECT_GT(forward.Distance(), 50.0);        // over the dip and the patch
  EXPECT_LT(std::abs(forward.Speed()), 0.1);  // to the stop
  for (const auto* ride : {&forward, &backward}) EXPECT_LT(std::abs(ride->Residual()), 1e-6 * ride->initial_energy);
  return error;
}

}  // namespace train_dynamics
