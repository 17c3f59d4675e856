#include "train_dynamics/brake/air_brake.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "train_dynamics/brake/brake_wave.h"
#include "train_dynamics/numeric/instruction_set.h"
#include "train_dynamics/numeric/monotone_cubic.h"
#include "train_dynamics/vehicle_number.h"

namespace train_dynamics {
namespace {

constexpr double kPaPerKpa = 1000.0;

std::string Index(std::size_t i) { return "[" + std::to_string(i) + "]"; }

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The effect of a command.
enum class Effect {
  kNone,
  kApplication,
  kEmergency,
  kFullRelease,
  kGraduatedRelease,
};

bool IsRelease(Effect effect) { return effect == Effect::kFullRelease || effect == Effect::kGraduatedRelease; }

/// How strong a command is beside others of the same time: its reduction, a release 0, an emergency infinite.
double StrengthOf(const BrakeCommand& command) {
  if (command.kind == BrakeCommandKind::kEmergency) return kInfinity;
  return command.kind == BrakeCommandKind::kRelease ? 0.0 : command.reduction_kpa;
}

/// The effect of each command and, for one without effect, the command that caused this.
struct Obeyed {
  Effect effect = Effect::kNone;
  std::size_t because_of = 0;  ///< index of the stronger command of the same time, or of the emergency
  bool re_applies = false;     ///< after a release, full or graduated
};
std::vector<Obeyed> Obey(const AirBrakeParams& params, const std::vector<BrakeCommand>& commands) {
  std::vector<Obeyed> obeyed(commands.size());
  double reduction_kpa = 0.0;
  bool emergency = false, released = false;
  std::size_t emergency_at = 0;
  for (std::size_t first = 0; first < commands.size();) {
    std::size_t end = first, strongest = first;
    for (; end < commands.size() && commands[end].time_s == commands[first].time_s; ++end) {
      if (StrengthOf(commands[end]) > StrengthOf(commands[strongest])) strongest = end;
    }
    for (std::size_t i = first; i < end; ++i) obeyed[i].because_of = strongest;
    first = std::max(end, first + 1);  // NaN equals no time
    const BrakeCommand& command = commands[strongest];
    Obeyed& now = obeyed[strongest];
    const bool is_release = command.kind == BrakeCommandKind::kRelease;
    if (emergency &&
        !(is_release && command.time_s >= commands[emergency_at].time_s + params.emergency.blocking_time_s)) {
      now.because_of = emergency_at;
      continue;
    }
    const double wanted_kpa = StrengthOf(command);
    emergency = command.kind == BrakeCommandKind::kEmergency;
    if (emergency) {
      now.effect = Effect::kEmergency;
      emergency_at = strongest;
    } else if (is_release) {
      now.effect = Effect::kFullRelease;
    } else if (wanted_kpa > reduction_kpa) {
      now.effect = Effect::kApplication;
    } else if (wanted_kpa < reduction_kpa) {
      now.effect = params.graduated_release ? Effect::kGraduatedRelease : Effect::kFullRelease;
    }
    now.re_applies = released && (now.effect == Effect::kApplication || emergency);
    released = released || (IsRelease(now.effect) && reduction_kpa > 0.0);
    reduction_kpa = wanted_kpa;
  }
  return obeyed;
}

/// How a command acts on the pipe and the cylinders, before distances are known.
struct Course {
  double wave_speed_mps, target_pa, rise_per_s, fall_per_s;
};

Course CourseOf(const BrakeCommand& command, Effect effect, const AirBrakeParams& params) {
  const ReleaseParams& release = params.release;
  if (effect == Effect::kFullRelease) {
    return {release.wave_speed_mps, 0.0, release.fall_rate_per_s, release.fall_rate_per_s};
  }
  if (effect == Effect::kEmergency) {
    const EmergencyApplicationParams& e = params.emergency;
    return {e.wave_speed_mps, kPaPerKpa * e.cylinder_pressure_kpa, e.rise_rate_per_s, e.rise_rate_per_s};
  }
  const ServiceApplicationParams& s = params.service;
  const double reduction = command.reduction_kpa;
  if (reduction < s.reduction_kpa.front() || reduction > s.reduction_kpa.back()) {
    throw std::invalid_argument("reduction_kpa must be in [" + std::to_string(s.reduction_kpa.front()) + ", " +
                                std::to_string(s.reduction_kpa.back()) + "], the measured range, got " +
                                std::to_string(reduction));
  }
  const double wave_speed_mps = effect == Effect::kGraduatedRelease
                                    ? release.wave_speed_mps
                                    : MonotoneCubic(s.reduction_kpa, s.wave_speed_mps, reduction);
  return {wave_speed_mps, kPaPerKpa * MonotoneCubic(s.reduction_kpa, s.cylinder_pressure_kpa, reduction),
          MonotoneCubic(s.reduction_kpa, s.rise_rate_per_s, reduction), release.fall_rate_per_s};
}

/// The places that a command acts on.
std::vector<WaveSource> SourcesOf(const AirBrakeParams& params, bool is_release,
                                  const std::vector<double>& vehicle_positions_m) {
  const int vehicles = static_cast<int>(vehicle_positions_m.size());
  std::vector<WaveSource> sources;
  for (const BrakeSourceParams& source : params.sources) {
    const int at = VehicleIndex(source.vehicle, vehicles);
    if (at < 0) {
      throw std::invalid_argument("brake source " + source.name + " stands at vehicle " +
                                  std::to_string(source.vehicle) + ", but the train has " + std::to_string(vehicles));
    }
    if (is_release && !source.releases) continue;
    sources.push_back({vehicle_positions_m[at], is_release ? source.release_delay_s : source.application_delay_s});
  }
  if (sources.empty()) throw std::invalid_argument("no brake source releases the brakes");
  return sources;
}

}  // namespace

std::vector<BrokenRule> AirBrakeParams::BrokenRules(const std::vector<BrakeCommand>& commands, int vehicles) const {
  std::vector<BrokenRule> broken;
  constexpr std::size_t kMostArrivals = 10000000;  // a second and half a gigabyte
  const std::size_t per_command = sources.size() * static_cast<std::size_t>(vehicles);
  if (commands.size() * per_command > kMostArrivals) {
    broken.push_back({"commands",
                      "must list at most " + std::to_string(kMostArrivals / per_command) + " commands for " +
                          std::to_string(vehicles) + " vehicles and " + std::to_string(sources.size()) +
                          " brake sources",
                      {"brake.sources", kVehicleCounts}});
    return broken;
  }
  const std::vector<double>& measured = service.reduction_kpa;
  const bool releases =
      std::any_of(sources.begin(), sources.end(), [](const BrakeSourceParams& source) { return source.releases; });
  const std::vector<Obeyed> obeyed = Obey(*this, commands);
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const BrakeCommand& command = commands[i];
    if (command.kind == BrakeCommandKind::kApply && !measured.empty() &&
        !(command.reduction_kpa >= measured.front() && command.reduction_kpa <= measured.back())) {
      const Range range{measured.front(), measured.back(), false, false};
      broken.push_back({"commands" + Index(i) + ".reduction_kpa",
                        range.Rule() + " (brake.service.reduction_kpa)",
                        {"brake.service.reduction_kpa"}});
    }
    if (!releases && (command.kind == BrakeCommandKind::kRelease || IsRelease(obeyed[i].effect))) {
      broken.push_back({"brake.sources",
                        "must list a source that releases the brakes, as commands" + Index(i) + " demands",
                        {"commands"}});
    }
  }
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const BrakeSourceParams& source = sources[i];
    if (VehicleIndex(source.vehicle, vehicles) >= 0) continue;
    const std::string which = source.name.empty() ? "" : " (" + source.name + ")";
    broken.push_back({"brake.sources" + Index(i) + ".vehicle", VehicleRule(vehicles) + which, {kVehicleCounts}});
  }
  return broken;
}

std::vector<Warning> AirBrakeParams::Warnings(const std::vector<BrakeCommand>& commands, int /*vehicles*/) const {
  std::vector<Warning> warnings;
  const std::vector<Obeyed> obeyed = Obey(*this, commands);
  std::size_t re_applications = 0, first = 0;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const Obeyed& command = obeyed[i];
    if (command.re_applies && re_applications++ == 0) first = i;
    if (command.because_of == i) continue;
    const BrakeCommand& other = commands[command.because_of];
    const std::string because = "commands" + Index(command.because_of);
    const std::string text = other.time_s == commands[i].time_s
                                 ? because + " at the same time is at least as strong"
                                 : "the emergency of " + because + " holds until a release at " +
                                       ShortestDecimal(other.time_s + emergency.blocking_time_s) + " s or later";
    warnings.push_back({"commands" + Index(i) + ".time_s",
                        "commands" + Index(i) + " has no effect: " + text +
                            (other.time_s == commands[i].time_s ? "" : " (brake.emergency.blocking_time_s)")});
  }
  if (re_applications > 0) {
    const std::string more =
        re_applications > 1 ? " (and " + std::to_string(re_applications - 1) + " more after it)" : "";
    warnings.push_back({"commands" + Index(first) + ".time_s",
                        "commands" + Index(first) + more +
                            " applies the brake again after a release: the empirical brake has no reservoirs that "
                            "must be recharged, so that it gives the full pressure where a real train has less"});
  }
  return warnings;
}

double EmergencyRiseRate(const EmergencyApplicationParams& p, double distance_m) {
  const double fall_per_s_m = p.rise_rate_fall_per_s / p.rise_rate_fall_length_m;
  if (distance_m <= p.rise_rate_fall_length_m) return p.rise_rate_per_s - fall_per_s_m * distance_m;
  const double least = p.rise_rate_per_s - p.rise_rate_fall_per_s;
  return least / (1.0 + fall_per_s_m * (distance_m - p.rise_rate_fall_length_m) / least);
}

double AirBrake::Phase::PressureAt(double time_s) const {
  return CylinderPressure<double>({1, 1, &begin_s, &begin_pa, &target_pa, &rate_per_s}, 0, time_s);
}

AirBrake::AirBrake(const AirBrakeParams& params, const std::vector<BrakeCommand>& commands,
                   const std::vector<double>& vehicle_positions_m)
    : params_(params), commands_(commands), positions_m_(vehicle_positions_m) {
  for (std::size_t k = 1; k < commands.size(); ++k) {
    if (commands[k].time_s < commands[k - 1].time_s) {
      throw std::invalid_argument("the times of brake commands must ascend");
    }
  }
  MakePhases();
}

void AirBrake::Command(const BrakeCommand& command) {
  const auto at = std::upper_bound(commands_.begin(), commands_.end(), command,
                                   [](const BrakeCommand& a, const BrakeCommand& b) { return a.time_s < b.time_s; });
  const std::vector<BrakeCommand> before = commands_;
  commands_.insert(at, command);
  try {
    MakePhases();
  } catch (const std::invalid_argument&) {
    commands_ = before;
    MakePhases();
    throw;
  }
}

void AirBrake::MakePhases() {
  vehicle_phases_.assign(positions_m_.size(), {Phase{}});
  const std::vector<Obeyed> obeyed = Obey(params_, commands_);
  for (std::size_t k = 0; k < commands_.size(); ++k) {
    const Effect effect = obeyed[k].effect;
    if (effect == Effect::kNone) continue;
    const Course course = CourseOf(commands_[k], effect, params_);
    const std::vector<WaveSource> sources = SourcesOf(params_, IsRelease(effect), positions_m_);
    for (std::size_t i = 0; i < positions_m_.size(); ++i) {
      const auto [arrival, distance] = FirstWave(commands_[k].time_s, positions_m_[i], sources, course.wave_speed_mps);
      std::vector<Phase>& phases = vehicle_phases_[i];
      while (phases.size() > 1 && phases.back().begin_s >= arrival) phases.pop_back();  // overtaken
      const double begin_pa = phases.back().PressureAt(arrival);
      const double target_pa = IsRelease(effect) ? course.target_pa : std::max(course.target_pa, begin_pa);
      const double rate_per_s = effect == Effect::kEmergency ? EmergencyRiseRate(params_.emergency, distance)
                                : begin_pa > target_pa       ? course.fall_per_s
                                                             : course.rise_per_s;
      phases.push_back({arrival, begin_pa, target_pa, rate_per_s, effect == Effect::kEmergency});
    }
  }
  for (const Opening& opening : openings_) AddPhases(opening);
  Arrange();
}

void AirBrake::OpenPipe(double time_s, int connection) {
  openings_.push_back({time_s, connection});
  AddPhases(openings_.back());
  Arrange();
}

void AirBrake::AddPhases(const Opening& opening) {
  const EmergencyApplicationParams& emergency = params_.emergency;
  for (int i = 0; i < vehicles(); ++i) {
    const double end_m = positions_m_[i <= opening.connection ? opening.connection : opening.connection + 1];
    const auto [arrival, distance] =
        FirstWave(opening.time_s, positions_m_[i], {{end_m, 0.0}}, emergency.wave_speed_mps);
    std::vector<Phase>& phases = vehicle_phases_[i];
    while (phases.size() > 1 && phases.back().begin_s >= arrival) phases.pop_back();
    if (phases.back().emergency) continue;
    const double begin_pa = phases.back().PressureAt(arrival);
    phases.push_back({arrival, begin_pa, std::max(kPaPerKpa * emergency.cylinder_pressure_kpa, begin_pa),
                      EmergencyRiseRate(emergency, distance), true});
  }
}

void AirBrake::Arrange() {
  constexpr Phase kReleased = {0.0, 0.0, 0.0, 0.0, false};
  constexpr Phase kNever = {kInfinity, 0.0, 0.0, 0.0, false};
  std::size_t most = 0;
  for (const std::vector<Phase>& phases : vehicle_phases_) most = std::max(most, phases.size());
  const std::size_t n = positions_m_.size();
  stride_ = PaddedToLanes(vehicles());
  for (std::vector<double>* array : {&begin_s_, &begin_pa_, &target_pa_, &rate_per_s_}) array->clear();
  for (std::size_t phase = 0; phase < most; ++phase) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(stride_); ++i) {
      const bool has = i < n && phase < vehicle_phases_[i].size();
      const Phase& p = has ? vehicle_phases_[i][phase] : phase == 0 ? kReleased : kNever;
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
  pressure_pa.resize(vehicles());
  const BrakePhases phases = Phases();
  for (int i = 0; i < vehicles(); ++i) pressure_pa[i] = CylinderPressure<double>(phases, i, time_s);
}

}  // namespace train_dynamics
