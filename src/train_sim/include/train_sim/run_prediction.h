#pragma once

#include <string>

#include "train_dynamics/config/load_scenario.h"

namespace train_sim {

/// Time and memory that a run in one process needs on this machine.
struct RunPrediction {
  double exchange_s = 0.0;    ///< wall time of an exchange
  double wall_s = 0.0;        ///< of the whole run
  double memory_bytes = 0.0;  ///< of the process
  double bag_bytes = 0.0;
  std::string fault;  ///< what ended the trial early, if anything did
};

/// Makes a trial run: a few hundred exchanges from its start state, under the pressures of the middle of the run. The
/// bag is not written; its size is estimated from the messages of the first record.
RunPrediction PredictRun(const train_dynamics::config::LoadedScenario& scenario, int threads);

/// The traffic of a train distributed over wagon nodes: Step.srv over TCP.
struct TrafficPrediction {
  double calls_per_s = 0.0;  ///< of simulated time, each a request and a reply
  double bytes_to_nodes_per_s = 0.0, bytes_from_nodes_per_s = 0.0;
};
TrafficPrediction PredictTraffic(const train_dynamics::config::LoadedScenario& scenario, int nodes);

}  // namespace train_sim
