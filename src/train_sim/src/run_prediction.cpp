#include "train_sim/run_prediction.h"

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <sys/resource.h>
#include <train_brake_msgs/Step.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "train_dynamics/train/in_process_train.h"
#include "train_dynamics/train/ranks.h"
#include "train_results/conversions.h"
#include "train_run/train_run.h"

namespace train_sim {
namespace {

using train_dynamics::ScenarioParams;
using train_dynamics::TrainRecord;
using train_dynamics::config::LoadedScenario;

/// Number of records and of energy ledgers in a run, the start's and the end's included.
struct Counts {
  explicit Counts(const ScenarioParams& p) {
    const auto after_start = p.Exchanges() / p.ExchangesPerRecord();  // whole ones
    records = 1.0 + static_cast<double>(after_start);
    ledgers = std::ceil(static_cast<double>(after_start) / p.RecordsPerLedger()) + 1.0;
  }
  double records, ledgers;
};

/// The bag of a run from the messages of its first record.
class BagEstimate {
 public:
  BagEstimate(const TrainRecord& first, const ScenarioParams& scenario) : count_(scenario) {
    train_brake_msgs::TrainState state;
    train_results::Convert(first, state);
    Add(state, count_.records);
    train_brake_msgs::InTrainForces forces;
    train_results::Convert(first, forces);
    Add(forces, count_.records);
    train_brake_msgs::BrakePressures pressures;
    train_results::Convert(first, pressures);
    Add(pressures, count_.records);
    train_brake_msgs::EnergyLedger ledger;
    train_results::Convert(first, ledger);
    Add(ledger, count_.ledgers);
    Add(train_results::ScenarioMessage(scenario), 1.0);
    for (const train_dynamics::WagonDetail& detail : first.vehicles.details) {
      train_brake_msgs::WagonState wagon;
      train_results::Convert(first, detail, wagon);
      Add(wagon, count_.records);
    }
  }

  double bytes() const { return bytes_; }
  double bytes_per_record() const { return bytes_ / count_.records; }

 private:
  template <class Message>
  void Add(const Message& message, double count) {
    constexpr double kAround = 58.0;         // a message's own header and its entry in the index
    constexpr double kConnection = 2 * 200;  // a topic is described in its first chunk and at the end
    const auto definition = static_cast<double>(std::string(ros::message_traits::definition(message)).size());
    bytes_ += count * (kAround + ros::serialization::serializationLength(message)) + kConnection + 2.0 * definition;
  }

  Counts count_;
  double bytes_ = 4096.0;  ///< of the file's header
};

/// The largest memory that this process has had.
double PeakMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  constexpr double kUnit = 1024.0;
  return kUnit * static_cast<double>(usage.ru_maxrss);
}

}  // namespace

RunPrediction PredictRun(const LoadedScenario& scenario, int threads) {
  constexpr std::uint64_t kExchanges = 300;
  constexpr double kLongest = 0.3;         // [s]
  constexpr double kQueuedRecords = 64.0;  // see train_results::RecorderThread
  const ScenarioParams& params = scenario.params;
  RunPrediction prediction;
  train_dynamics::InProcessTransport vehicles(params, scenario.consist, threads);
  train_dynamics::BrakeSystem brake = scenario.pressures;
  brake.MoveAhead(0.5 * params.duration_s);
  train_run::TrainRun run(params, scenario.consist, vehicles, std::move(brake));
  double queue_bytes = 0.0;
  run.AddObserver([&](const TrainRecord& record) {
    if (record.exchange > 0) return;
    const BagEstimate bag(record, params);
    prediction.bag_bytes = bag.bytes();
    queue_bytes = kQueuedRecords * bag.bytes_per_record();
  });
  // By batches, of which the median is taken: other load of the machine disturbs single ones.
  const int batch = std::min(params.ExchangesPerRecord(), 50);
  std::vector<double> batch_s;
  double this_batch_s = 0.0, all_s = 0.0;
  const train_dynamics::TrainMaster& master = run.master();
  train_run::RunHooks hooks;
  hooks.exchanged = [&](double wall_s) {
    this_batch_s += wall_s;
    all_s += wall_s;
    if (master.exchange() % batch != 0 && !master.Done()) return;
    batch_s.push_back(this_batch_s);
    this_batch_s = 0.0;
  };
  // Ends with a batch, except at the end of the run.
  hooks.ends = [&] { return this_batch_s == 0.0 && (master.exchange() >= kExchanges || all_s > kLongest); };
  run.Go(hooks);
  prediction.fault = run.fault();
  if (!batch_s.empty()) {
    const auto median = batch_s.begin() + static_cast<long>(batch_s.size() / 2);
    std::nth_element(batch_s.begin(), median, batch_s.end());
    prediction.exchange_s = *median / batch;
  }
  prediction.wall_s = prediction.exchange_s * static_cast<double>(params.Exchanges());
  prediction.memory_bytes = PeakMemory() + queue_bytes;
  return prediction;
}

TrafficPrediction PredictTraffic(const LoadedScenario& scenario, int nodes) {
  constexpr double kRequestPrefix = 4.0, kReplyPrefix = 5.0;  // of TCPROS
  const ScenarioParams& params = scenario.params;
  const int vehicles = scenario.consist.vehicles();
  const double exchanges_per_s = 1.0 / params.exchange_interval_s, records_per_s = 1.0 / params.record_interval_s;
  TrafficPrediction traffic;
  traffic.calls_per_s = nodes * exchanges_per_s;
  for (const train_dynamics::Rank& rank : train_dynamics::SplitRanks(vehicles, nodes)) {
    train_brake_msgs::StepRequest request;
    train_dynamics::ResizeLoads(rank.count, false, request);
    train_brake_msgs::StepResponse reply;
    train_dynamics::ResizeReply(rank.count, reply);
    traffic.bytes_to_nodes_per_s +=
        exchanges_per_s * (kRequestPrefix + ros::serialization::serializationLength(request));
    traffic.bytes_from_nodes_per_s += exchanges_per_s * (kReplyPrefix + ros::serialization::serializationLength(reply));
  }
  constexpr double kRecordBytes = 8.0 * (train_dynamics::kRecordNumbers + 1);  // of a vehicle, and its digest
  const double wagon_bytes = ros::serialization::serializationLength(train_brake_msgs::WagonState());
  traffic.bytes_from_nodes_per_s +=
      records_per_s * (kRecordBytes * vehicles + wagon_bytes * static_cast<double>(params.DetailedVehicles().size()));
  return traffic;
}

}  // namespace train_sim
