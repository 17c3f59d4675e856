// What a train does besides moving its vehicles, and whole exchanges, for the paper's train in the middle of its
// emergency stop. One iteration is one step of 242 vehicles.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "moving_vehicles.h"
#include "time_per_step.h"
#include "train_dynamics/train/in_process_train.h"
#include "train_dynamics/train/train_master.h"

namespace train_dynamics::bench {
namespace {

/// The paper's train in the middle of its stop, or, sliding with all wheels locked, far from its end.
struct Train {
  Train(const std::string& model, bool slides, int threads)
      : scenario(Emergency(Overrides(model, slides))),
        transport(scenario.params, scenario.consist, threads),
        master(scenario.params, scenario.consist, transport, scenario.pressures),
        end_s(slides ? 70.0 : 40.0) {
    master.Start();
    while (master.time_s() < end_s - 30.0) master.Exchange();
  }

  /// Past the part of the stop that is measured: it would stand still before long.
  bool AtEnd() const { return master.time_s() >= end_s; }

  static std::vector<std::string> Overrides(const std::string& model, bool slides) {
    std::vector<std::string> overrides = {"model=" + model, "commands=[{time_s: 0, kind: emergency}]"};
    for (int part = 0; slides && part < 4; ++part) {
      overrides.push_back("train.consist[" + std::to_string(part) + "].vehicle." + kSlippery);
    }
    return overrides;
  }

  config::LoadedScenario scenario;
  InProcessTransport transport;
  TrainMaster master;
  double end_s;
};

/// A benchmark is called several times: the train goes on from call to call, and over the same part of its stop again.
class Exchange {
 public:
  Exchange(std::string model, bool slides, int threads)
      : model_(std::move(model)), slides_(slides), threads_(threads) {}

  void operator()(benchmark::State& state) {
    if (train_ == nullptr) MakeTrain();
    for (auto _ : state) {
      if (train_->AtEnd()) {
        state.PauseTiming();
        MakeTrain();
        state.ResumeTiming();
      }
      train_->master.Exchange();
    }
    ShowTimePerVehicleStep(state, kVehicles);
  }

 private:
  void MakeTrain() {
    train_ = nullptr;  // the threads of the old one end first
    train_ = std::make_shared<Train>(model_, slides_, threads_);
  }

  std::string model_;
  bool slides_;
  int threads_;
  std::shared_ptr<Train> train_;
};

void Couplers(benchmark::State& state) {
  const config::LoadedScenario scenario = Emergency({});
  InTrainForces forces(scenario.consist, SlackState::kStretched, 0.5 * kTimeStep);
  std::vector<double> displacement_m(kVehicles), velocity_mps(kVehicles), force_n(kVehicles + 1);
  for (int i = 0; i < kVehicles; ++i) {
    displacement_m[i] = 0.01 * std::sin(0.1 * i);  // draws some couplers out, pushes others in
    velocity_mps[i] = 20.0 + 0.05 * std::cos(0.1 * i);
  }
  forces.Begin(std::vector<double>(kVehicles, 0.0));
  for (auto _ : state) {
    forces.Evaluate(0.0, velocity_mps, force_n);
    forces.CloseInterval(displacement_m);
    benchmark::DoNotOptimize(force_n.data());
  }
  ShowTimePerVehicleStep(state, kVehicles);
}

void AirBrakePressure(benchmark::State& state) {
  config::LoadedScenario scenario = Emergency({});
  std::vector<double> pressure_pa;
  double time_s = 0.0;
  for (auto _ : state) {
    scenario.pressures.PressuresAt(time_s, pressure_pa);
    benchmark::DoNotOptimize(pressure_pa.data());
    time_s = time_s < 70.0 ? time_s + kTimeStep : 0.0;
  }
  ShowTimePerVehicleStep(state, kVehicles);
}

/// The pneumatic brake of the paper's train, AB valves, sources at 1 and 122 and an End-of-Train device, asked for its
/// pressures at every exchange. An emergency's first 20 s, or a service application, a release and its recharge, 120 s.
void PneumaticBrakePressure(benchmark::State& state, bool emergency) {
  const std::vector<std::string> overrides = {
      "brake=ab_distributed", emergency ? "commands=[{time_s: 0, kind: emergency}]"
                                        : "commands=[{time_s: 0, kind: apply, reduction_kpa: 100}, {time_s: 60, "
                                          "kind: release}]"};
  const double end_s = emergency ? 20.0 : 120.0;
  const config::LoadedScenario scenario = Emergency(overrides);
  std::vector<double> pressure_pa;
  BrakeSystem brake = scenario.pressures;
  double time_s = 0.0;
  for (auto _ : state) {
    if (time_s > end_s) {
      state.PauseTiming();
      brake = scenario.pressures;
      time_s = 0.0;
      state.ResumeTiming();
    }
    brake.PressuresAt(time_s, pressure_pa);
    benchmark::DoNotOptimize(pressure_pa.data());
    time_s += kTimeStep;
  }
  ShowTimePerVehicleStep(state, kVehicles);
}

/// @param with_ledger  the energies of every vehicle and their sums, too
void Report(benchmark::State& state, const std::string& model, bool with_ledger) {
  const config::LoadedScenario scenario = Emergency({"model=" + model});
  const auto block = MakeVehicleBlock(scenario.params, scenario.consist, 0, kVehicles);
  ExchangeReply reply(kVehicles, {});
  for (auto _ : state) {
    block->Report(0, with_ledger, reply);
    if (with_ledger) benchmark::DoNotOptimize(MakeEnergyLedger(0.0, reply.energy, ConnectionEnergy{}));
    benchmark::DoNotOptimize(reply.state_digest.data());
  }
  ShowTimePerVehicleStep(state, kVehicles);
}

}  // namespace
}  // namespace train_dynamics::bench

int main(int argc, char** argv) {
  using namespace train_dynamics::bench;
  benchmark::RegisterBenchmark("couplers", Couplers);
  benchmark::RegisterBenchmark("air_brake", AirBrakePressure);
  benchmark::RegisterBenchmark("pneumatic_brake/emergency", PneumaticBrakePressure, true);
  benchmark::RegisterBenchmark("pneumatic_brake/service", PneumaticBrakePressure, false);
  for (const std::string model : {"2d", "ltd"}) {
    benchmark::RegisterBenchmark(("record/" + model).c_str(), Report, model, false);
    benchmark::RegisterBenchmark(("record_with_ledger/" + model).c_str(), Report, model, true);
    // More threads make no LTD train of this length faster, so that a run has one: see UsefulThreads.
    const int most = model == "2d" ? static_cast<int>(std::thread::hardware_concurrency()) : 1;
    for (int threads = 1; threads <= most; ++threads) {
      const std::string name = "exchange/" + model + "/" + std::to_string(threads);
      benchmark::RegisterBenchmark(name.c_str(), Exchange(model, false, threads))->UseRealTime();
    }
  }
  benchmark::RegisterBenchmark("exchange_locked/2d/1", Exchange("2d", true, 1))->UseRealTime();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
