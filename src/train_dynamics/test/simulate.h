#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/in_process_train.h"
#include "train_dynamics/train/train_master.h"

namespace train_dynamics {

inline std::string ScenarioFile(const std::string& name) {
  return std::string(TRAIN_BRAKE_CONFIG_DIR) + "/scenarios/" + name + ".yaml";
}

/// The paper's scenarios; table_one_test runs them whole, with every model.
constexpr std::array<const char*, 3> kPaperScenarios = {"emergency", "full_service", "minimum"};

/// What a whole run of a scenario came to.
struct Outcome {
  double mean_speed_kmh = 0.0;  ///< at the end; the vehicles' masses are taken to be equal
  double initial_kinetic_j = 0.0;
  double largest_residual_j = 0.0;  ///< of the energy ledger
  EnergyLedger ledger;              ///< the last
  std::uint64_t digest = 0;
  std::vector<double> record_times, accelerations;  ///< of every record; of the first vehicle
  std::vector<ForceExtremes> coupler_extremes;      ///< of every exchange
};

/// Runs one of the project's scenarios, in process.
inline Outcome Simulate(const std::string& scenario, const std::vector<std::string>& overrides, int threads = 1) {
  const config::LoadedScenario loaded = config::LoadScenario(ScenarioFile(scenario), overrides);
  InProcessTransport transport(loaded.params, loaded.consist, threads);
  TrainMaster master(loaded.params, loaded.consist, transport, loaded.pressures);
  Outcome outcome;
  double initial_j = 0.0;
  master.AddObserver([&](const TrainRecord& record) {
    outcome.record_times.push_back(record.time_s);
    outcome.accelerations.push_back(record.acceleration_mps2[0]);
    double sum = 0.0;
    for (const double v : record.vehicles.speed_mps) sum += v;
    outcome.mean_speed_kmh = 3.6 * sum / loaded.consist.vehicles();
    if (!record.ledger) return;
    outcome.ledger = *record.ledger;
    if (record.exchange == 0) {
      initial_j = record.ledger->Stored();
      outcome.initial_kinetic_j = record.ledger->kinetic_j;
    }
    outcome.largest_residual_j = std::max(outcome.largest_residual_j, std::abs(record.ledger->Residual(initial_j)));
  });
  master.Start();
  while (!master.Done()) master.Exchange();
  outcome.digest = master.state_digest();
  outcome.coupler_extremes = master.in_train_forces().Extremes();
  return outcome;
}

/// The project's aim: 1e-6 of the initial energy. And no element gives energy back.
inline void ExpectLedgerCloses(const Outcome& outcome, const std::string& what) {
  EXPECT_LT(outcome.largest_residual_j, 1e-6 * outcome.initial_kinetic_j) << what;
  EXPECT_GT(outcome.initial_kinetic_j, 0.0);
  for (const auto& [element, energy] : outcome.ledger.dissipated_j) {
    EXPECT_GE(energy, -1e-9 * outcome.initial_kinetic_j) << what << ": " << element;
  }
}

}  // namespace train_dynamics
