#include "train_dynamics/brake/pneumatic/pneumatic_brake.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "train_dynamics/vehicle_number.h"

namespace train_dynamics {
namespace {

constexpr double kDischarge = 0.8;            // [A]
constexpr double kRelayBand = 10e3;           // [Pa] of error over which a relay opens fully [A]
constexpr double kRadioPatience = 45.0;       // [s] [A]
constexpr double kLapRate = 10e3;             // [Pa/s] at which a lapping remote valve feeds less [A]
constexpr double kLongestForOneValve = 38.1;  // [m] AAR S-401 [S]
constexpr double kRiseRate = 100e3;           // [Pa/s] of the equalising reservoir [A]

PipeGrid MakeGrid(const PneumaticBrakeParams& params, const std::vector<double>& vehicle_length_m) {
  std::vector<double> length, branch;
  for (double vehicle_m : vehicle_length_m) {
    const int cells = params.pipe.cells_per_vehicle;
    for (int c = 0; c < cells; ++c) {
      length.push_back(vehicle_m * params.pipe.length_ratio / cells);
      branch.push_back(params.pipe.branch_volume_l * 1e-3 / cells);
    }
  }
  return PipeGrid(params.pipe.inner_diameter_mm * 1e-3, params.pipe.temperature_k, length, branch);
}

double StepFor(const PipeGrid& grid, double longest_s) {
  double step = longest_s;
  while (step > grid.LongestStep()) step *= 0.5;
  return step;
}

// p V that a relay lets through in dt: it opens in proportion to the pressure that is still wanted, fully at
// kRelayBand. The opening follows within the step (implicitly); otherwise it would oscillate in a short cell: x = fully
// open / band, change = error x / (1 + x), at most fully open.
double RelayFlow(double conductance_rt, double dt_s, double from_pa, double to_pa, double error_pa, double volume_m3) {
  if (!(from_pa > to_pa)) return 0.0;
  const double fully = conductance_rt * dt_s * from_pa * NozzleFunction(to_pa / from_pa) / volume_m3;
  return volume_m3 * Min(fully, error_pa * fully / (kRelayBand + fully));
}

}  // namespace

double BrakeEquipmentParams::PressureShare() const {
  switch (empty_load) {
    case EmptyLoad::kNone:
      return 1.0;
    case EmptyLoad::kTwoStep:
      return load_share < change_over_share ? empty_ratio : 1.0;
    case EmptyLoad::kProportional:
      return empty_ratio + (1.0 - empty_ratio) * load_share;
  }
  return 1.0;
}

std::vector<int> PneumaticBrakeParams::ValveOfVehicle(int vehicles) const {
  std::vector<int> valve(vehicles, 0);
  for (const BrakeEquipmentParams& e : equipment) {
    if (e.valve.empty()) continue;
    const auto found =
        std::find_if(valves.begin(), valves.end(), [&](const ControlValveParams& v) { return v.name == e.valve; });
    if (found == valves.end()) throw std::invalid_argument("equipment names no valve: " + e.valve);
    const int from = VehicleIndex(e.from, vehicles), to = VehicleIndex(e.to, vehicles);
    for (int i = from; i <= to; ++i) valve[i] = static_cast<int>(found - valves.begin());
  }
  return valve;
}

std::vector<BrokenRule> PneumaticBrakeParams::BrokenRules(const std::vector<BrakeCommand>& commands, int n) const {
  std::vector<BrokenRule> broken;
  const auto at = [](const char* list, std::size_t i) { return std::string(list) + "[" + std::to_string(i) + "]"; };
  const auto outside = [&](int number) { return VehicleIndex(number, n) < 0; };
  const std::string behind =
      n > 1 ? "must be in [1, " + std::to_string(n - 1) + "]: a hose and its angle cocks are between two vehicles"
            : "has no place in a train of one vehicle";
  for (std::size_t i = 0; i < sources.size(); ++i) {
    if (outside(sources[i].vehicle))
      broken.push_back({"brake." + at("sources", i) + ".vehicle", VehicleRule(n), {kVehicleCounts}});
    for (std::size_t k = 1; k < sources[i].commands.size(); ++k) {
      if (sources[i].commands[k].time_s < sources[i].commands[k - 1].time_s)
        broken.push_back({"brake." + at("sources", i) + "." + at("commands", k) + ".time_s",
                          "must be at least that of the command before",
                          {"brake." + at("sources", i) + "." + at("commands", k - 1) + ".time_s"}});
    }
  }
  std::set<std::string> names;
  for (std::size_t i = 0; i < valves.size(); ++i) {
    if (!names.insert(valves[i].name).second)
      broken.push_back({"brake." + at("valves", i) + ".name",
                        "must be another one for each valve, \"" + valves[i].name + "\" is given twice",
                        {"brake.valves[].name"}});
  }
  std::vector<int> said_by(n, -1);
  bool good = true;
  for (std::size_t i = 0; i < equipment.size(); ++i) {
    const BrakeEquipmentParams& e = equipment[i];
    const std::string key = "brake." + at("equipment", i);
    if (!e.valve.empty() && names.count(e.valve) == 0) {
      broken.push_back({key + ".valve",
                        "must be the name of one of brake.valves, there is no \"" + e.valve + "\"",
                        {"brake.valves[].name"}});
      good = false;
    }
    const int from = VehicleIndex(e.from, n), to = VehicleIndex(e.to, n);
    if (from < 0) broken.push_back({key + ".from", VehicleRule(n), {kVehicleCounts}});
    if (to < 0) broken.push_back({key + ".to", VehicleRule(n), {kVehicleCounts}});
    if (from >= 0 && to >= 0 && from > to)
      broken.push_back({key + ".to", "must not be in front of from", {key + ".from"}});
    if (from < 0 || to < 0 || from > to) {
      good = false;
      continue;
    }
    for (int v = from; v <= to; ++v) {
      if (said_by[v] >= 0) {
        broken.push_back({key + ".from",
                          "must leave each vehicle to one entry: vehicle " + std::to_string(v + 1) + " is in brake." +
                              at("equipment", said_by[v]) + ", too",
                          {"brake.equipment[].from", "brake.equipment[].to"}});
        break;
      }
      said_by[v] = static_cast<int>(i);
    }
  }
  for (std::size_t i = 0; i < closed_angle_cocks.size(); ++i)
    if (closed_angle_cocks[i] >= n)
      broken.push_back({"brake." + at("closed_angle_cocks", i), behind, {kVehicleCounts}});
  for (std::size_t i = 0; i < parted_hoses.size(); ++i)
    if (parted_hoses[i].behind_vehicle >= n)
      broken.push_back({"brake." + at("parted_hoses", i) + ".behind_vehicle", behind, {kVehicleCounts}});
  bool direct = false;
  if (good)
    for (int valve : ValveOfVehicle(n)) direct = direct || valves[valve].kind == ControlValveKind::kDirectRelease;
  double reduction = 0.0;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const std::string key = at("commands", i) + ".reduction_kpa";
    if (commands[i].kind != BrakeCommandKind::kApply) {
      reduction = 0.0;
      continue;
    }
    const double wanted = commands[i].reduction_kpa;
    if (wanted > charged_pressure_kpa)
      broken.push_back({key,
                        "must be at most brake.charged_pressure_kpa, " + ShortestDecimal(charged_pressure_kpa),
                        {"brake.charged_pressure_kpa"}});
    if (direct && wanted < reduction)
      broken.push_back({key,
                        "must not be below that of the application before, " + ShortestDecimal(reduction) +
                            ": valves of direct release cannot let the brake down by steps; release first, or give the "
                            "vehicles valves of kind graduated_release",
                        {"brake.valves", "brake.equipment", "commands[].kind", "commands[].reduction_kpa"}});
    reduction = wanted;
  }
  return broken;
}

bool PneumaticBrakeParams::ReleasesGradually() const {
  return std::all_of(valves.begin(), valves.end(),
                     [](const ControlValveParams& valve) { return valve.kind != ControlValveKind::kDirectRelease; });
}

std::vector<Warning> PneumaticBrakeParams::Warnings(const std::vector<BrakeCommand>& /*commands*/, int n) const {
  std::vector<Warning> warnings;
  std::vector<int> of_valve(valves.size(), 0);
  int direct = 0, graduated = 0, ecp = 0;
  for (int valve : ValveOfVehicle(n)) {
    ++of_valve[valve];
    direct += valves[valve].kind == ControlValveKind::kDirectRelease;
    graduated += valves[valve].kind == ControlValveKind::kGraduatedRelease;
    ecp += valves[valve].kind == ControlValveKind::kEcp;
  }
  if (direct > 0 && graduated > 0) {
    warnings.push_back(
        {"brake.valves", "the train has " + std::to_string(direct) + " valves of direct and " +
                             std::to_string(graduated) +
                             " of graduated release: at the first rise of the pipe the direct ones release fully, the "
                             "others follow the pipe, so that parts of the train brake while others run free"});
  }
  if (ecp > 0 && ecp < n) {
    warnings.push_back({"brake.valves", "the train has " + std::to_string(ecp) + " ECP vehicles of " +
                                            std::to_string(n) +
                                            ": these brake at once, the others with the wave in the pipe"});
  }
  for (std::size_t i = 0; i < valves.size(); ++i) {
    if (of_valve[i] == 0)
      warnings.push_back(
          {"brake.valves[" + std::to_string(i) + "]", "valve \"" + valves[i].name + "\" is on no vehicle"});
  }
  return warnings;
}

PneumaticBrake::PneumaticBrake(const PneumaticBrakeParams& params, const std::vector<double>& vehicle_length_m,
                               std::vector<BrakeCommand> commands)
    : params_(params),
      grid_(MakeGrid(params, vehicle_length_m)),
      dt_s_(StepFor(grid_, 1e-3 * params.pipe.longest_step_ms)),
      flow_(grid_, kAtmospherePa + 1e3 * params.initial_pressure_kpa.value_or(params.charged_pressure_kpa)),
      commands_(std::move(commands)) {
  const int vehicles = static_cast<int>(vehicle_length_m.size());
  for (int i = 0; i < vehicles; ++i) {
    if (vehicle_length_m[i] > kLongestForOneValve)
      throw std::invalid_argument("vehicle " + std::to_string(i + 1) +
                                  " is longer than 38.1 m (125 ft), the most that one " + "control valve serves");
  }
  const int cells = params.pipe.cells_per_vehicle;
  for (const ControlValveParams& valve : params.valves) valves_.emplace_back(valve, params.pipe.temperature_k, dt_s_);
  valve_of_ = params.ValveOfVehicle(vehicles);
  cut_out_.assign(vehicles, 0);
  retainer_.assign(vehicles, Retainer::kDirect);
  pressure_share_.assign(vehicles, 1.0);
  for (const BrakeEquipmentParams& e : params.equipment) {
    for (int i = VehicleIndex(e.from, vehicles); i <= VehicleIndex(e.to, vehicles); ++i) {
      cut_out_[i] = e.cut_out;
      retainer_[i] = e.retainer;
      pressure_share_[i] = e.PressureShare();
    }
  }
  const double pressure_pa = flow_.pressure_pa.front();
  for (int i = 0; i < vehicles; ++i) {
    valve_cell_.push_back(i * cells + cells / 2);
    const ControlValve& valve = valves_[valve_of_[i]];
    states_.push_back(cut_out_[i] ? valve.Empty() : valve.Charged(pressure_pa));
    const ControlValveParams& kind = valve.params();
    if (kind.kind == ControlValveKind::kEcp) line_delay_s_ = kind.ecp.delay_s;
    all_ecp_ = all_ecp_ && kind.kind == ControlValveKind::kEcp;
    has_line_ = has_line_ || kind.kind == ControlValveKind::kEcp || kind.ep_vent_opening_mm > 0.0;
  }
  // The leakage of a charged pipe, per metre, over all of its air.
  const double charged_pa = params.charged_pressure_kpa * 1e3;
  for (int c = 0; c < grid_.cells(); ++c) {
    const double kgps = params.pipe.leakage_g_per_s_km * 1e-6 * grid_.cell_length_m[c];
    leak_share_.push_back(dt_s_ * kgps * grid_.rt_over_volume[c] / charged_pa);
  }
  const auto opening = [&](double mm) {
    return grid_.rt * NozzleConductance(mm * 1e-3, kDischarge, params.pipe.temperature_k);
  };
  charging_ = opening(params.drivers_valve.charging_opening_mm);
  exhaust_ = opening(params.drivers_valve.exhaust_opening_mm);
  emergency_ = opening(params.drivers_valve.emergency_opening_mm);
  bore_ = opening(params.pipe.inner_diameter_mm);

  SourceState told{};
  told.goal_pa = charged_pa;
  told.equalising_pa = Min(charged_pa, pressure_pa - kAtmospherePa);
  told.overcharged_to_s = -1.0;
  line_ = told;
  for (const PipeSourceParams& source : params.sources) {
    const int vehicle = VehicleIndex(source.vehicle, vehicles);
    if (vehicle < 0 || vehicle >= vehicles)
      throw std::invalid_argument("source " + source.name + " is outside the train");
    // The driver's valve and an end-of-train device are at the ends of their vehicles.
    const int in_vehicle = vehicle == 0 ? 0 : vehicle == vehicles - 1 ? cells - 1 : cells / 2;
    source_cell_.push_back(vehicle * cells + in_vehicle);
    sources_.push_back(told);
  }
  for (int behind : params.closed_angle_cocks) {
    if (behind >= vehicles)
      throw std::invalid_argument("there is no angle cock behind vehicle " + std::to_string(behind));
    flow_.open[behind * cells] = 0.0;
  }
  for (const PartedHoseParams& hose : params.parted_hoses) {
    if (hose.behind_vehicle >= vehicles)
      throw std::invalid_argument("there is no hose behind vehicle " + std::to_string(hose.behind_vehicle));
  }
  acting_pa_.assign(vehicles, 0.0);
  acting_before_pa_.assign(vehicles, 0.0);
}

void PneumaticBrake::TrapAir(int vehicle, double pressure_pa) {
  cut_out_[vehicle] = 1;
  pressure_share_[vehicle] = 1.0;
  states_[vehicle] = valves_[valve_of_[vehicle]].Empty();
  states_[vehicle].cylinder_pa = kAtmospherePa + pressure_pa;
}

void PneumaticBrake::Send(SourceState& source, double now_s, double delay_s, const BrakeCommand& command) const {
  CommandsUnderWay& way = source.under_way;
  // If the queue is full, the newest command replaces the last one.
  const int at = std::min(static_cast<int>(way.count), CommandsUnderWay::kMost - 1);
  way.entries[at] = {now_s + delay_s, static_cast<double>(command.kind),
                     command.kind == BrakeCommandKind::kApply ? command.reduction_kpa * 1e3 : 0.0};
  way.count = at + 1;
}

void PneumaticBrake::Command(const BrakeCommand& command) {
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const PipeSourceParams& p = params_.sources[i];
    if (!p.commands.empty()) continue;
    if (p.RadioIsLost(command.time_s)) continue;
    if (all_ecp_ && command.kind == BrakeCommandKind::kApply) continue;  // the pipe stays charged
    Send(sources_[i], command.time_s, p.radio_delay_s, command);
  }
  Send(line_, command.time_s, line_delay_s_, command);
}

void PneumaticBrake::OpenPipe(double /*time_s*/, int connection) {
  const int face = (connection + 1) * params_.pipe.cells_per_vehicle;
  if (std::find(parted_.begin(), parted_.end(), face) != parted_.end()) return;
  parted_.push_back(face);
  flow_.open[face] = 0.0;
}

void PneumaticBrake::Receive(SourceState& source, double now_s) const {
  CommandsUnderWay& way = source.under_way;
  while (way.count > 0.0 && way.entries[0].arrives_s <= now_s) {
    const CommandsUnderWay::Entry entry = way.entries[0];
    for (int i = 1; i < CommandsUnderWay::kMost; ++i) way.entries[i - 1] = way.entries[i];
    way.count -= 1.0;
    const double charged_pa = params_.charged_pressure_kpa * 1e3;
    const DriversValveParams& valve = params_.drivers_valve;
    switch (static_cast<BrakeCommandKind>(static_cast<int>(entry.kind))) {
      case BrakeCommandKind::kEmergency:
        if (source.emergency == 0.0) source.emergency_from_s = entry.arrives_s;
        source.emergency = 1.0;
        source.goal_pa = 0.0;
        break;
      case BrakeCommandKind::kApply:
        if (source.emergency == 0.0) source.goal_pa = Max(0.0, charged_pa - entry.reduction_pa);
        break;
      case BrakeCommandKind::kRelease:
        if (source.emergency == 1.0 && entry.arrives_s - source.emergency_from_s < valve.blocking_time_s) break;
        if (source.emergency == 1.0) source.equalising_pa = 0.0;
        source.emergency = 0.0;
        source.goal_pa = charged_pa;
        if (valve.overcharge_kpa > 0.0) source.overcharged_to_s = now_s + valve.overcharge_time_s;
        break;
    }
  }
}

// The equalising reservoir moves to its goal; after a release it is overcharged, and falls slowly from there.
void PneumaticBrake::Equalise(SourceState& source, double now_s) const {
  const DriversValveParams& valve = params_.drivers_valve;
  const double charged_pa = params_.charged_pressure_kpa * 1e3;
  double goal = source.goal_pa;
  double fall = valve.service_rate_kpa_per_s * 1e3 * dt_s_;
  if (goal == charged_pa) {
    if (now_s < source.overcharged_to_s) goal += valve.overcharge_kpa * 1e3;
    fall = valve.overcharge_decay_kpa_per_s * 1e3 * dt_s_;
  }
  source.equalising_pa = source.equalising_pa > goal ? Max(goal, source.equalising_pa - fall)
                                                     : Min(goal, source.equalising_pa + kRiseRate * dt_s_);
}

void PneumaticBrake::StepSource(int i) {
  const PipeSourceParams& p = params_.sources[i];
  SourceState& source = sources_[i];
  const double now_s = time_s();
  for (auto next = static_cast<std::size_t>(source.own_obeyed);
       next < p.commands.size() && p.commands[next].time_s <= now_s; ++next) {
    Send(source, p.commands[next].time_s, p.radio_delay_s, p.commands[next]);
    source.own_obeyed += 1.0;
  }
  Receive(source, now_s);
  const int cell = source_cell_[i];
  double& pressure = flow_.pressure_pa[cell];
  const double volume = grid_.volume_m3[cell];
  double in = 0.0, out = 0.0;
  if (p.kind == PipeSourceKind::kEndOfTrain) {
    if (p.two_way && source.emergency == 1.0) {
      const double share = p.opening_mm / params_.pipe.inner_diameter_mm;
      out = PassToPlace(bore_ * share * share, dt_s_, pressure, volume, kAtmospherePa);
    }
  } else if (source.emergency == 1.0) {
    out = PassToPlace(emergency_, dt_s_, pressure, volume, kAtmospherePa);
  } else {
    Equalise(source, now_s);
    // A remote valve without radio for this long goes to lap: it reduces its flow gradually, because a sudden end of
    // the flow would lower the pipe beside it at an emergency's rate.
    double lapped_s = 0.0;
    if (p.kind == PipeSourceKind::kRemote && p.RadioIsLost(now_s))
      lapped_s = Max(0.0, now_s - *p.radio_lost_from_s - kRadioPatience);
    const double wanted = kAtmospherePa + source.equalising_pa - kLapRate * lapped_s;
    const double error = wanted - pressure;
    const bool applied = source.goal_pa < params_.charged_pressure_kpa * 1e3;
    if (error > 0.0 && (!applied || params_.drivers_valve.pressure_maintaining)) {
      const double reservoir = kAtmospherePa + params_.drivers_valve.main_reservoir_kpa * 1e3;
      in = RelayFlow(charging_, dt_s_, reservoir, pressure, error, volume);
      pressure += in / volume;
    } else if (error < 0.0 && lapped_s == 0.0) {
      out = RelayFlow(exhaust_, dt_s_, pressure, kAtmospherePa, -error, volume);
      pressure -= out / volume;
    }
  }
  supplied_pv_ += in;
  released_pv_ += out;
  source.flow_kgps = (in - out) / (grid_.rt * dt_s_);
}

void PneumaticBrake::Step() {
  for (auto next = static_cast<std::size_t>(given_); next < commands_.size() && commands_[next].time_s <= time_s();
       ++next) {
    Command(commands_[next]);
    given_ += 1.0;
  }
  for (const PartedHoseParams& hose : params_.parted_hoses)
    if (time_s() >= hose.time_s) OpenPipe(hose.time_s, hose.behind_vehicle - 1);
  Advance(grid_, dt_s_, flow_);
  double* pressure = flow_.pressure_pa.data();
  if (params_.pipe.leakage_g_per_s_km > 0.0) {
    for (int c = 0; c < grid_.cells(); ++c) {
      const double lost = leak_share_[c] * Max(0.0, pressure[c] - kAtmospherePa);
      pressure[c] -= lost;
      released_pv_ += lost * grid_.volume_m3[c];
    }
  }
  for (int face : parted_)
    for (int cell : {face - 1, face})
      released_pv_ += PassToPlace(bore_, dt_s_, pressure[cell], grid_.volume_m3[cell], kAtmospherePa);
  for (std::size_t i = 0; i < sources_.size(); ++i) StepSource(static_cast<int>(i));

  TrainLine line;
  if (has_line_) {
    Receive(line_, time_s());
    Equalise(line_, time_s());
    const double reduction = params_.charged_pressure_kpa * 1e3 - line_.goal_pa;
    line.ecp_goal = Clamp(reduction / (params_.drivers_valve.full_service_reduction_kpa * 1e3), 0.0, 1.0);
    line.ecp_emergency = line.ep_emergency = line_.emergency == 1.0;
    line.ep_pipe_pa = kAtmospherePa + line_.equalising_pa;
  }
  for (const HeldOff& held : bail_offs_) {
    if (time_s() < held.from_s || time_s() >= held.to_s || cut_out_[held.vehicle]) continue;
    released_pv_ +=
        valves_[valve_of_[held.vehicle]].BailOff(states_[held.vehicle], pressure[valve_cell_[held.vehicle]]);
  }
  std::swap(acting_pa_, acting_before_pa_);
  for (int i = 0; i < vehicles(); ++i) {
    ControlValveState& s = states_[i];
    const int cell = valve_cell_[i];
    if (!cut_out_[i])
      released_pv_ += valves_[valve_of_[i]].Step(line, retainer_[i], s, pressure[cell], grid_.volume_m3[cell]);
    acting_pa_[i] = pressure_share_[i] * (s.cylinder_pa - kAtmospherePa);
  }
  steps_ += 1.0;
}

void PneumaticBrake::PressuresAt(double when_s, std::vector<double>& pressure_pa) {
  while (time_s() < when_s) Step();
  const double back = Clamp((time_s() - when_s) / dt_s_, 0.0, 1.0);
  pressure_pa.resize(states_.size());
  for (int i = 0; i < vehicles(); ++i) pressure_pa[i] = acting_pa_[i] - back * (acting_pa_[i] - acting_before_pa_[i]);
}

void PneumaticBrake::Record(BrakeRecordArrays& record) const {
  ForEachBrakeField([&](const char*, auto&, auto& to) { to.resize(states_.size()); }, record, record);
  for (int i = 0; i < vehicles(); ++i) {
    const bool direct = valves_[valve_of_[i]].params().kind == ControlValveKind::kDirectRelease;
    record.pipe_pressure_pa[i] = PipePressure(i);
    record.auxiliary_reservoir_pa[i] = states_[i].auxiliary_pa - kAtmospherePa;
    record.emergency_reservoir_pa[i] =
        direct ? states_[i].emergency_pa - kAtmospherePa : std::numeric_limits<double>::quiet_NaN();
    record.valve_mode[i] = states_[i].mode;
  }
}

double PneumaticBrake::PipeLength() const {
  double length = 0.0;
  for (double cell : grid_.cell_length_m) length += cell;
  return length;
}

double PneumaticBrake::FlowIntoPipe() const {
  double flow = 0.0;
  for (const SourceState& source : sources_) flow += source.flow_kgps;
  return flow;
}

double PneumaticBrake::AirMass() const {
  double pv = 0.0;
  for (int i = 0; i < vehicles(); ++i) pv += valves_[valve_of_[i]].PressureVolume(states_[i]);
  return MassOf(grid_, flow_) + pv / grid_.rt;
}

}  // namespace train_dynamics
