// Two wagons meet: the train's own run against an independent integration of the two masses and their gears.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "simulate.h"

namespace train_dynamics {
namespace {

struct Impact {
  double peak_n = 0.0, restitution = 0.0, lost_j = 0.0;
};

// Two equal masses with two equal friction gears in series between them, stepped by 1 us; the law as written in the
// data sheets' words: a stick spring between a loading and an unloading branch.
Impact Independent(double mass_kg, double speed_mps) {
  const double t = std::tan(22.0 * std::acos(-1.0) / 180.0), mu = 0.28;
  const double up = t / (t - mu), down = t / (t + mu);
  const double stick = 1e9, stick_damping = 2.6e6, dt = 1e-6;
  double closing = speed_mps, q = 0.0, memory = 0.0, last_d = 0.0;  // q: compression beyond the slack
  Impact impact;
  for (double time = 0.0; time < 2.0; time += dt) {
    const double d = std::max(0.0, 0.5 * q), rate = 0.5 * closing;  // of one gear
    const double spring = 20e3 * std::min(d / 1e-3, 1.0) + 8e6 * d;
    memory = std::clamp(memory + stick * (d - last_d), spring * down, spring * up);
    last_d = d;
    double force = 0.0;
    if (d > 0.0) force = std::clamp(memory + stick_damping * rate, spring * down, spring * up);
    if (d > 0.083) force += 1e8 * (d - 0.083);
    impact.peak_n = std::max(impact.peak_n, force);
    impact.lost_j += force * closing * dt;
    closing -= dt * 2.0 * force / mass_kg;
    q += dt * closing;
    if (q < 0.0 && closing < 0.0) break;
  }
  impact.restitution = -closing / speed_mps;
  return impact;
}

Impact InTheTrain(double speed_kmh, const std::string& model, double* mass_kg) {
  std::vector<std::string> overrides = {"model=" + model, "ledger_interval_s=0.001",
                                        "train.consist[1].initial_speed_kmh=" + std::to_string(speed_kmh)};
  for (const char* vehicle : {"train.consist[0].vehicle", "train.consist[1].vehicle"}) {
    overrides.push_back(std::string(vehicle) + "=ore_wagon");
    for (const char* term : {"constant_n_per_kn", "linear_n_per_kn_kmh", "quadratic_n_per_kn_kmh2"}) {
      overrides.push_back(std::string(vehicle) + ".propulsion_resistance." + term + "=0");
    }
  }
  const config::LoadedScenario loaded = config::LoadScenario(ScenarioFile("impact"), overrides);
  InProcessTransport transport(loaded.params, loaded.consist, 1);
  TrainMaster master(loaded.params, loaded.consist, transport, loaded.pressures);
  Impact impact;
  *mass_kg = LtdVehicle(loaded.consist.vehicle(0), model == "ltd").inertia_kg;
  master.AddObserver([&](const TrainRecord& record) {
    // The rebound ends where the wagons part fastest: afterwards the coupler is pulled.
    const double parting = record.vehicles.speed_mps[0] - record.vehicles.speed_mps[1];
    if (!record.ledger || parting <= impact.restitution * speed_kmh / 3.6) return;
    impact.restitution = parting / (speed_kmh / 3.6);
    for (const auto& [element, energy] : record.ledger->dissipated_j) {
      if (element == "draft_gears") impact.lost_j = energy;
    }
  });
  master.Start();
  while (!master.Done()) master.Exchange();
  impact.peak_n = -master.in_train_forces().Extremes()[0].compression_n;
  return impact;
}

TEST(Impact, OfTwoWagonsMeetsAnIndependentIntegration) {
  for (const double speed_kmh : {5.0, 8.0}) {
    double mass_kg = 0.0;
    const Impact run = InTheTrain(speed_kmh, "ltd", &mass_kg);
    const Impact other = Independent(mass_kg, speed_kmh / 3.6);
    EXPECT_NEAR(run.peak_n, other.peak_n, 0.01 * other.peak_n) << speed_kmh;
    EXPECT_NEAR(run.restitution, other.restitution, 0.01) << speed_kmh;
    EXPECT_NEAR(run.lost_j, other.lost_j, 0.01 * other.lost_j) << speed_kmh;
  }
}

TEST(Impact, PeaksBelowTheStopFollowFromTheEnergy) {
  // 2 * 3.2575 U_s(d) = m v^2 / 4: [O] 171.66 t at 5 km/h: 1470.8 kN.
  double mass_kg = 0.0;
  const Impact run = InTheTrain(5.0, "ltd", &mass_kg);
  EXPECT_NEAR(mass_kg, 171.66e3, 5.0);
  EXPECT_NEAR(run.peak_n, 1470.8e3, 0.005 * 1470.8e3);
}

// Two wagons of 129.7 t, the rear one at v; the largest compression [N].
double Peak(double speed_kmh, std::vector<std::string> overrides) {
  overrides.insert(overrides.end(),
                   {"model=ltd-no-inertia", "train.consist[1].initial_speed_kmh=" + std::to_string(speed_kmh)});
  for (const char* vehicle : {"train.consist[0].vehicle", "train.consist[1].vehicle"}) {
    overrides.push_back(std::string(vehicle) + ".carbody.mass_kg=117186");
    for (const char* term : {"constant_n_per_kn", "linear_n_per_kn_kmh", "quadratic_n_per_kn_kmh2"}) {
      overrides.push_back(std::string(vehicle) + ".propulsion_resistance." + term + "=0");
    }
  }
  const config::LoadedScenario loaded = config::LoadScenario(ScenarioFile("impact"), overrides);
  EXPECT_NEAR(loaded.consist.vehicle(0).TotalMass(), 129.7e3, 1.0);
  InProcessTransport transport(loaded.params, loaded.consist, 1);
  TrainMaster master(loaded.params, loaded.consist, transport, loaded.pressures);
  master.Start();
  while (!master.Done()) master.Exchange();
  return -master.in_train_forces().Extremes()[0].compression_n;
}

TEST(Impact, GearsAreUsedUpAtTheSpeedOfTheirEnergy) {
  // v = sqrt(8 E / m), E per gear. [O] TF-880, 61.72 kJ: 7.02 km/h; a gear of 36 000 ft-lb (48.81 kJ): 6.25 km/h. There
  // the gear is at the end of its travel, and a tenth faster it is solid.
  const double tf880_n = 2.52e6;
  EXPECT_NEAR(Peak(7.02, {"train.connection=tf880"}), tf880_n, 0.015 * tf880_n);
  EXPECT_GT(Peak(1.1 * 7.02, {"train.connection=tf880"}), 1.1 * tf880_n);

  // A linear spring that takes 48.81 kJ over 83 mm while it is loaded: F_0 d + k d^2 / 2 times t / (t - mu).
  const double t = std::tan(22.0 * std::acos(-1.0) / 180.0), loading = t / (t - 0.28);
  const double d = 0.083, preload = 20e3;
  const double k = 2.0 * (48.81e3 / loading - preload * (d - 0.5e-3)) / (d * d);
  const double end_n = loading * (preload + k * d);
  const std::vector<std::string> gear = {"train.connection.draft_gear.spring_stiffness_n_per_m=" + std::to_string(k)};
  EXPECT_NEAR(Peak(6.25, gear), end_n, 0.015 * end_n);
  EXPECT_GT(Peak(1.1 * 6.25, gear), 1.1 * end_n);
}

}  // namespace
}  // namespace train_dynamics
