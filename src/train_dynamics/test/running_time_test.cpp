// Running times of a whole freight train against those of another program: a DB V 90 with ten loaded Facs 124 over 10
// km, standstill to standstill, at most 80 km/h, braked with 0.225 m/s^2 (railtoolkit/TrainRuns.jl, its tests'
// snapshots).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "simulate.h"
#include "train_dynamics/brake/shoe_friction.h"

namespace train_dynamics {
namespace {

constexpr double kWay = 10e3, kFastest = 80.0 / 3.6, kBraking = 0.225;

/// A driver who pulls with all that the locomotive has, holds the highest speed, and brakes to stop at the end.
class Journey {
 public:
  explicit Journey(const std::string& track)
      : loaded_(config::LoadScenario(
            ScenarioFile("emergency"),
            {"model=ltd", "train=v90_10_facs", "track=" + track, "brake=single_vehicle", "commands=[]",
             "initial_speed_kmh=0", "detail_vehicles=[]", "start_position_m=-7.16"})),
        transport_(loaded_.params, loaded_.consist, 1),
        forces_(loaded_.consist, SlackState::kStretched, 0.5 * kInterval),
        track_(loaded_.params.track),
        reply_(loaded_.consist.vehicles(), {}) {
    request_.dt_s = kInterval;
    request_.steps = 1;
    const int vehicles = loaded_.consist.vehicles();
    request_.coupler_force_n.assign(vehicles + 1, 0.0);
    request_.cylinder_pressure_pa.assign(vehicles, 0.0);
    request_.traction_n.assign(vehicles, 0.0);
  }

  /// @return the running time [s]
  double Run() {
    transport_.Start(reply_);
    forces_.Begin(reply_.head_displacement_m);
    const TractionParams& traction = *loaded_.consist.vehicle(0).traction;
    for (; exchange_ < 1000000; ++exchange_) {
      const State now = Now();
      const double left_m = kWay - now.way_m;
      const double may_mps = std::min(kFastest, std::sqrt(2.0 * kBraking * std::max(0.0, left_m)));
      if (exchange_ > 1000 && (now.speed_mps < 0.02 || left_m < 0.0)) break;
      // The force that follows the speed that may be: on the braking curve its deceleration, too.
      const bool brakes = may_mps < kFastest;
      const double wanted_n =
          now.resistance_n + now.inertia_kg * ((may_mps - now.speed_mps) * 0.5 - (brakes ? kBraking : 0.0));
      const bool free = now.speed_mps < may_mps - 0.5;
      const double most_n =
          TractiveEffort(traction.tractive_effort, 8.0, now.speed_mps, loaded_.consist.vehicle(0).DrivenWeight());
      request_.traction_n[0] = free ? most_n : std::clamp(wanted_n, 0.0, most_n);
      Brake(free ? 0.0 : std::max(0.0, -wanted_n), now);
      request_.exchange = exchange_;
      forces_.Evaluate(kInterval * static_cast<double>(exchange_), reply_.head_velocity_mps, request_.coupler_force_n);
      transport_.Exchange(request_, reply_);
      forces_.CloseInterval(reply_.head_displacement_m);
    }
    EXPECT_NEAR(Now().way_m, kWay, 1.0);
    return kInterval * static_cast<double>(exchange_);
  }

 private:
  struct State {
    double way_m, speed_mps, resistance_n, inertia_kg, mass_kg;
  };

  State Now() const {
    State now{};
    for (int i = 0; i < loaded_.consist.vehicles(); ++i) {
      const VehicleParams& vehicle = loaded_.consist.vehicle(i);
      const double v = reply_.head_velocity_mps[i], m = vehicle.TotalMass();
      const double at = -7.16 + loaded_.consist.centre_m[i] + reply_.head_displacement_m[i];
      const ResistanceCoefficients c = vehicle.Resistance();
      now.mass_kg += m;
      now.inertia_kg += m + EquivalentRotationalMass(vehicle);
      now.speed_mps += m * v;
      now.way_m += m * reply_.head_displacement_m[i];
      now.resistance_n += RollingResistance(c, vehicle.Weight(), v) + AirDrag(c, vehicle.Weight(), v) +
                          vehicle.Weight() * GradeAt(track_, at);
    }
    now.speed_mps /= now.mass_kg;
    now.way_m /= now.mass_kg;
    return now;
  }

  void Brake(double force_n, const State& now) {
    for (int i = 0; i < loaded_.consist.vehicles(); ++i) {
      const VehicleParams& vehicle = loaded_.consist.vehicle(i);
      const double share_n = force_n * vehicle.TotalMass() / now.mass_kg;
      const double per_pressure = ShoeForce(vehicle.Rigging(), 1.0, reply_.head_velocity_mps[i]);
      request_.cylinder_pressure_pa[i] = share_n / per_pressure;
    }
  }

  static constexpr double kInterval = 2e-3;
  config::LoadedScenario loaded_;
  InProcessTransport transport_;
  InTrainForces forces_;
  Track track_;
  ExchangeRequest request_;
  ExchangeReply reply_;
  std::uint64_t exchange_ = 0;
};

TEST(RunningTime, MassesOfTheTrain) {
  const config::LoadedScenario loaded = config::LoadScenario(
      ScenarioFile("emergency"), {"model=ltd", "train=v90_10_facs", "detail_vehicles=[]", "brake=single_vehicle"});
  const VehicleParams& v90 = loaded.consist.vehicle(0);
  const VehicleParams& facs = loaded.consist.vehicle(1);
  EXPECT_NEAR(v90.TotalMass(), 80e3, 1e-6);
  EXPECT_NEAR(facs.TotalMass(), 84e3, 1e-6);
  EXPECT_NEAR(1.0 + EquivalentRotationalMass(v90) / v90.TotalMass(), 1.09, 5e-4);
  EXPECT_NEAR(1.0 + EquivalentRotationalMass(facs) / facs.TotalMass(), 1.03, 5e-4);
}

TEST(RunningTime, OfAV90WithTenFacsOnLevelTrack) {
  EXPECT_NEAR(Journey("level").Run(), 745.07, 0.005 * 745.07);  // an independent integration: 746.98 s
}

TEST(RunningTime, OfAV90WithTenFacsOverGrades) {
  EXPECT_NEAR(Journey("graded_10_km").Run(), 840.82,
              0.005 * 840.82);  // an independent one, as a strip: 838.8 s
}

}  // namespace
}  // namespace train_dynamics
