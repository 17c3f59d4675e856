#include "train_dynamics/brake/air_brake.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "train_dynamics/numeric/monotone_cubic.h"

namespace train_dynamics {
namespace {

constexpr double kPaPerKpa = 1000.0;
constexpr int kLanes = 8;  // the stride of the phases is a multiple of

/// How a command acts on the pipe and the cylinders, before distances are known.
struct CommandEffect {
  double wave_speed_mps, target_pa, rate_per_s, rate_fall_per_s_m;
  bool is_release;
};

CommandEffect EffectOf(const BrakeCommand& command, const AirBrakeParams& params) {
  if (command.kind == BrakeCommandKind::kRelease) {
    return {params.release.wave_speed_mps, 0.0, params.release.fall_rate_per_s, 0.0, true};
  }
  if (command.kind == BrakeCommandKind::kEmergency) {
    const EmergencyApplicationParams& e = params.emergency;
    return {e.wave_speed_mps, kPaPerKpa * e.cylinder_pressure_kpa, e.rise_rate_per_s,
            e.rise_rate_fall_per_s / e.rise_rate_fall_length_m, false};
  }
  const ServiceApplicationParams& s = params.service;
  const double reduction = command.reduction_kpa;
  if (reduction < s.reduction_kpa.front() || reduction > s.reduction_kpa.back()) {
    throw std::invalid_argument("reduction_kpa must be in [" + std::to_string(s.reduction_kpa.front()) +
                                ", " + std::to_string(s.reduction_kpa.back()) +
                                "], the measured range, got " + std::to_string(reduction));
  }
  return {MonotoneCubic(s.reduction_kpa, s.wave_speed_mps, reduction),
          kPaPerKpa * MonotoneCubic(s.reduction_kpa, s.cylinder_pressure_kpa, reduction),
          MonotoneCubic(s.reduction_kpa, s.rise_rate_per_s, reduction), 0.0, false};
}

/// Index from 0 of a source's vehicle.
int SourceIndex(const BrakeSourceParams& source, int vehicles) {
  const int index = source.vehicle > 0 ? source.vehicle - 1 : vehicles + source.vehicle;
  if (index < 0 || index >= vehicles) {
    throw std::invalid_argument("brake source " + source.name + " stands at vehicle " +
                                std::to_string(source.vehicle) + ", but the train has " +
                                std::to_string(vehicles));
  }
  return index;
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The pressure from `begin_s` on tends from `begin_pa` to `target_pa`.
struct Phase {
  double begin_s, begin_pa, target_pa, rate_per_s;

  double PressureAt(double time_s) const {
    return CylinderPressure<double>({1, 1, &begin_s, &begin_pa, &target_pa, &rate_per_s}, 0, time_s);
  }
};
constexpr Phase kReleased = {0.0, 0.0, 0.0, 0.0};
constexpr Phase kNever = {kInfinity, 0.0, 0.0, 0.0};

}  // namespace

AirBrake::AirBrake(const AirBrakeParams& params, const std::vector<BrakeCommand>& commands,
                   const std::vector<double>& vehicle_positions_m) {
  const int n = static_cast<int>(vehicle_positions_m.size());
  std::vector<std::vector<Phase>> vehicles(n, {kReleased});
  double last_time = 0.0;
  for (const BrakeCommand& command : commands) {
    if (command.time_s < last_time) throw std::invalid_argument("the times of brake commands must ascend");
    last_time = command.time_s;
    const CommandEffect effect = EffectOf(command, params);
    for (int i = 0; i < n; ++i) {
      double arrival = kInfinity, distance = 0.0;
      for (const BrakeSourceParams& source : params.sources) {
        const int at = SourceIndex(source, n);
        if (effect.is_release && !source.releases) continue;
        const double d = std::abs(vehicle_positions_m[i] - vehicle_positions_m[at]);
        const double delay = effect.is_release ? source.release_delay_s : source.application_delay_s;
        const double t = command.time_s + delay + d / effect.wave_speed_mps;
        if (t < arrival) arrival = t, distance = d;
      }
      if (arrival == kInfinity) throw std::invalid_argument("no brake source releases the brakes");
      const double rate = effect.rate_per_s - effect.rate_fall_per_s_m * distance;
      if (!(rate > 0.0)) {
        throw std::invalid_argument("the emergency rise rate falls to zero " + std::to_string(distance) +
                                    " m from its source; rise_rate_fall_per_s is too large for this train");
      }
      std::vector<Phase>& phases = vehicles[i];
      while (phases.size() > 1 && phases.back().begin_s >= arrival) phases.pop_back();  // overtaken
      const double begin_pa = phases.back().PressureAt(arrival);
      const double target_pa = effect.is_release ? 0.0 : std::max(effect.target_pa, begin_pa);
      phases.push_back({arrival, begin_pa, target_pa, rate});
    }
  }
  std::size_t most = 0;
  for (const std::vector<Phase>& phases : vehicles) most = std::max(most, phases.size());
  vehicles_ = n;
  stride_ = (n + kLanes - 1) / kLanes * kLanes;
  for (std::size_t phase = 0; phase < most; ++phase) {
    for (int i = 0; i < stride_; ++i) {
      const bool has = i < n && phase < vehicles[i].size();
      const Phase& p = has ? vehicles[i][phase] : phase == 0 ? kReleased : kNever;
      begin_s_.push_back(p.begin_s);
      begin_pa_.push_back(p.begin_pa);
      target_pa_.push_back(p.target_pa);
      rate_per_s_.push_back(p.rate_per_s);
    }
  }
}

BrakePhases AirBrake::Phases() const {
  const int phases = stride_ > 0 ? static_cast<int>(begin_s_.size()) / stride_ : 0;
  return {phases, stride_, begin_s_.data(), begin_pa_.data(), target_pa_.data(), rate_per_s_.data()};
}

void AirBrake::PressuresAt(double time_s, std::vector<double>& pressure_pa) const {
  pressure_pa.resize(vehicles_);
  const BrakePhases phases = Phases();
  for (int i = 0; i < vehicles_; ++i) pressure_pa[i] = CylinderPressure<double>(phases, i, time_s);
}

}  // namespace train_dynamics
