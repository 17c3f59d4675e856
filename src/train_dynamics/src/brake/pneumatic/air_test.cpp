#include "train_dynamics/brake/pneumatic/air_test.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace train_dynamics {
namespace {

constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
constexpr double kPsi = 6894.76;
constexpr double kLookEvery = 0.05;  // [s]

/// The brake and its cylinders at the last time queried.
class Bench {
 public:
  Bench(const PneumaticBrakeParams& params, const std::vector<double>& length_m) : brake(params, length_m) {}

  void Run(double to_s) {
    brake.PressuresAt(to_s, cylinder_pa);
    now_s_ = to_s;
  }
  /// Runs until `done(*this)`. @return the time until then; kNever if it is more than `patience_s`
  template <class Done>
  double Until(const Done& done, double patience_s) {
    const double begin_s = now_s_;
    for (double look = 1.0; look * kLookEvery <= patience_s; look += 1.0) {
      Run(begin_s + look * kLookEvery);
      if (done(*this)) return now_s_ - begin_s;
    }
    return kNever;
  }
  void Give(BrakeCommandKind kind, double reduction_kpa = 0.0) { brake.Command({now_s_, kind, reduction_kpa}); }
  int InEmergency() const {
    int count = 0;
    for (int i = 0; i < brake.vehicles(); ++i) count += brake.valve(i).Mode() == ControlValveMode::kEmergency;
    return count;
  }

  PneumaticBrake brake;
  std::vector<double> cylinder_pa;

 private:
  double now_s_ = 0.0;
};

class Table {
 public:
  void Add(std::string test, double value, std::string unit, std::string rule, bool passed) {
    results.push_back({std::move(test), value, std::move(unit), std::move(rule), passed});
  }
  void AddTime(std::string test, double time_s, double most_s) {
    Add(std::move(test), time_s, "s", "at most " + ShortestDecimal(most_s) + " s [A]", time_s <= most_s);
  }
  std::vector<AirTestResult> results;
};

/// The least pressure of the cylinders that are not cut out.
double Least(const Bench& bench, const std::vector<char>& acts) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < acts.size(); ++i)
    if (acts[i]) least = std::min(least, bench.cylinder_pa[i]);
  return least;
}

PneumaticBrakeParams OneVehicle(PneumaticBrakeParams params, int vehicles) {
  const int valve = params.ValveOfVehicle(vehicles)[vehicles > 1 ? 1 : 0];
  params.valves = {params.valves[valve]};
  params.sources.resize(1);
  params.sources[0].vehicle = 1;
  params.equipment.clear();
  params.closed_angle_cocks.clear();
  params.parted_hoses.clear();
  params.initial_pressure_kpa.reset();
  return params;
}

void TestSingleCar(const PneumaticBrakeParams& params, double length_m, Table& table) {
  Bench car(params, {length_m});
  car.Run(1.0);
  car.Give(BrakeCommandKind::kApply, 70.0);
  car.Run(31.0);
  const double applied = car.cylinder_pa[0];
  table.Add("single car: cylinder 30 s after 70 kPa", applied / 1e3, "kPa", "at least 70 kPa [A]", applied >= 70e3);
  car.Run(91.0);
  const double lost = applied - car.cylinder_pa[0];
  table.Add("single car: cylinder's fall in a minute", lost / 1e3, "kPa", "at most 7 kPa, 1 psi [A]", lost <= 7e3);
  car.Give(BrakeCommandKind::kRelease);
  table.AddTime("single car: release to 35 kPa",
                car.Until([](const Bench& b) { return b.cylinder_pa[0] < 35e3; }, 120.0), 60.0);
}

}  // namespace

std::vector<AirTestResult> TestAirBrake(const PneumaticBrakeParams& params, const std::vector<double>& length_m) {
  Table table;
  const int n = static_cast<int>(length_m.size());
  TestSingleCar(OneVehicle(params, n), length_m[n > 1 ? 1 : 0], table);

  PneumaticBrakeParams train = params;
  train.parted_hoses.clear();
  for (PipeSourceParams& source : train.sources) source.commands.clear();
  std::vector<char> acts(n, 1);
  for (const BrakeEquipmentParams& e : train.equipment) {
    if (!e.cut_out) continue;
    for (int i = 0; i < n; ++i) {
      const int from = e.from > 0 ? e.from - 1 : n + e.from, to = e.to > 0 ? e.to - 1 : n + e.to;
      if (i >= from && i <= to) acts[i] = 0;
    }
  }
  const double charged_pa = train.charged_pressure_kpa * 1e3;

  train.initial_pressure_kpa = 0.0;
  Bench charging(train, length_m);
  table.AddTime("charging: tail at 95 % of the charged pressure",
                charging.Until([&](const Bench& b) { return b.brake.TailPressure() > 0.95 * charged_pa; }, 3600.0),
                3600.0);

  train.initial_pressure_kpa.reset();
  Bench leakage(train, length_m);
  leakage.Run(600.0);
  const double flow = leakage.brake.FlowIntoPipe();
  // 60 ft3/min of free air.
  table.Add("leakage: flow of the driver's valves after 10 min", flow * 1e3, "g/s", "at most 34.1 g/s, 60 CFM [S]",
            flow <= 34.1e-3);
  const double gradient = leakage.brake.HeadPressure() - leakage.brake.TailPressure();
  table.Add("leakage: gradient, head less tail", gradient / 1e3, "kPa", "at most 103 kPa, 15 psi [S]",
            gradient <= 103.4e3);
  PneumaticBrakeParams lapped = train;
  lapped.drivers_valve.pressure_maintaining = false;
  Bench fall(lapped, length_m);
  fall.Give(BrakeCommandKind::kApply, 100.0);
  fall.Run(180.0);
  const double before = fall.brake.TailPressure();
  fall.Run(240.0);
  // Four minutes have passed since the reduction: a pipe that is empty by then no longer falls, but has fallen.
  const double tail_pa = fall.brake.TailPressure();
  const double lost = std::max(before - tail_pa, (charged_pa - 100e3 - tail_pa) / 4.0);
  table.Add("leakage: tail's fall in a minute of lap", lost / 1e3, "kPa", "at most 34.5 kPa, 5 psi [M: 49 CFR 232.205]",
            lost <= 5.0 * kPsi);

  Bench service(train, length_m);
  service.Run(1.0);
  service.Give(BrakeCommandKind::kApply, train.drivers_valve.full_service_reduction_kpa);
  service.Run(301.0);
  const double final_pa = Least(service, acts);
  Bench again(train, length_m);
  again.Run(1.0);
  again.Give(BrakeCommandKind::kApply, train.drivers_valve.full_service_reduction_kpa);
  table.AddTime("full service: last cylinder at 95 % of its pressure",
                again.Until([&](const Bench& b) { return Least(b, acts) > 0.95 * final_pa; }, 300.0), 240.0);
  service.Give(BrakeCommandKind::kRelease);
  table.AddTime(
      "release: last cylinder below 40 kPa",
      service.Until([](const Bench& b) { return *std::max_element(b.cylinder_pa.begin(), b.cylinder_pa.end()) < 40e3; },
                    900.0),
      300.0);
  table.Add("service and release: valves in emergency", service.InEmergency(), "-", "none [A]",
            service.InEmergency() == 0);

  Bench emergency(train, length_m);
  emergency.Run(1.0);
  emergency.Give(BrakeCommandKind::kEmergency);
  std::vector<double> arrival(n, kNever);
  emergency.Until(
      [&](const Bench& b) {
        bool all = true;
        for (int i = 0; i < n; ++i) {
          if (std::isnan(arrival[i]) && b.cylinder_pa[i] > 10e3) arrival[i] = b.brake.time_s() - 1.0;
          all = all && (!acts[i] || !std::isnan(arrival[i]));
        }
        return all;
      },
      60.0);
  int reached = 0, acting = 0;
  for (int i = 0; i < n; ++i) acting += acts[i], reached += acts[i] && !std::isnan(arrival[i]);
  table.Add("emergency: cylinders that fill", reached, "of " + std::to_string(acting), "all", reached == acting);
  const auto& valves = train.ValveOfVehicle(n);
  const bool pneumatic =
      std::all_of(valves.begin(), valves.end(), [&](int v) { return train.valves[v].kind != ControlValveKind::kEcp; });
  const bool head_only = train.sources.size() == 1;
  // Over the first vehicles the wave builds up, and the closed tail reflects it: a short train gives no speed.
  const int first = std::max(20, n / 4);
  if (n >= 50 && pneumatic && head_only && reached == n) {
    double way = 0.0;
    for (int i = first; i < n - 1; ++i) way += 0.5 * (length_m[i] + length_m[i + 1]);
    const double speed = way / (arrival[n - 1] - arrival[first]);
    const bool direct = std::any_of(valves.begin(), valves.end(),
                                    [&](int v) { return train.valves[v].kind == ControlValveKind::kDirectRelease; });
    const double least = direct ? 200.0 : 150.0;
    table.Add("emergency: speed of its front along the train", speed, "m/s",
              "at least " + ShortestDecimal(least) + " m/s [A]", speed >= least);
  }
  emergency.Run(61.0);
  const double filled = Least(emergency, acts);
  Bench timing(train, length_m);
  timing.Run(1.0);
  timing.Give(BrakeCommandKind::kEmergency);
  table.AddTime("emergency: last cylinder at 95 % of its pressure",
                timing.Until([&](const Bench& b) { return Least(b, acts) > 0.95 * filled; }, 60.0), 60.0);
  return table.results;
}

}  // namespace train_dynamics
