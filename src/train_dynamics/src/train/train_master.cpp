#include "train_dynamics/train/train_master.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "train_dynamics/train/ranks.h"

namespace train_dynamics {
namespace {

std::vector<int> ExternalVehicles(const ScenarioParams& scenario) {
  std::vector<int> vehicles;
  for (const Rank& rank : ExternalRanks(scenario.train)) {
    for (int i = 0; i < rank.count; ++i) vehicles.push_back(rank.first + i);
  }
  return vehicles;
}

}  // namespace

TrainMaster::TrainMaster(const ScenarioParams& scenario, const Consist& consist, Transport& transport,
                         BrakeSystem brake)
    : scenario_(scenario),
      consist_(consist),
      transport_(transport),
      brake_(std::move(brake)),
      forces_(consist, scenario.initial_slack,
              scenario.integrator == LtdIntegrator::kLeapfrog ? 0.5 * scenario.exchange_interval_s : 0.0,
              ExternalVehicles(scenario)),
      locomotives_(consist, TimedLocomotiveCommands(WithVehicles(scenario.commands, scenario.train))),
      curves_(scenario.track, consist, scenario.start_position_m),
      breakaway_(consist),
      reply_(consist.vehicles(), scenario.DetailedVehicles()),
      schedule_(WithVehicles(scenario.commands, scenario.train), scenario.until) {
  record_.vehicles = reply_;
  record_.acceleration_mps2.assign(consist.vehicles(), std::numeric_limits<double>::quiet_NaN());
  for (int i = 0; i < consist.vehicles(); ++i) mass_kg_.push_back(consist.vehicle(i).TotalMass());
  for (const ConnectionParams& type : consist.connection_types) can_part_ = can_part_ || type.strength_n > 0.0;
  if (scenario.driver && scenario.brake) {
    const double period = std::round(scenario.driver->period_s / scenario.exchange_interval_s);
    driver_ = Driver{MakeDriversTrain(*scenario.driver, *scenario.brake, consist),
                     StopPositions(*scenario.driver, scenario.track),
                     static_cast<std::uint64_t>(period),
                     {}};
  }
  for (const DriverCommand& command : scenario.commands) patches_ += command.IsOfRail() ? 1 : 0;
  request_.dt_s = scenario.dt_s;
  request_.steps = scenario.StepsPerExchange();
  request_.coupler_force_n.assign(consist.vehicles() + 1, 0.0);
  request_.cylinder_pressure_pa.assign(consist.vehicles(), 0.0);
}

void TrainMaster::Start() {
  transport_.Start(reply_);
  forces_.Begin(reply_.head_displacement_m);
  locomotives_.Begin(consist_, reply_.head_velocity_mps);
  request_.ledger = true;
  ShowRecord();
}

void TrainMaster::Resume(const TrainCheckpoint& checkpoint) {
  const auto per_record = static_cast<std::uint64_t>(scenario_.ExchangesPerRecord());
  if (checkpoint.exchange % per_record != 0) throw SnapshotError("does not follow a record of this scenario");
  if (static_cast<long>(checkpoint.exchange) >= scenario_.Exchanges()) {
    throw SnapshotError("leaves nothing to run: it is of exchange " + std::to_string(checkpoint.exchange) +
                        ", and duration_s ends with exchange " + std::to_string(scenario_.Exchanges()));
  }
  forces_.SetMemory(checkpoint.connections);
  OpenPipes();
  schedule_.SetMemory(checkpoint.driver);
  MemoryReader driver(checkpoint.built_in_driver);
  if (driver_) driver_->state.ForEachField(driver);
  driver.End();
  for (const GivenCommand& given : schedule_.Given()) {
    Give(given);
    if (given.is_live && given.command.IsOfRail()) ++patches_;
  }
  MemoryReader brake(checkpoint.brake);
  brake_.ForEachField(brake);
  brake.End();
  MemoryReader breakaway(checkpoint.breakaway);
  breakaway_.ForEachField(breakaway);
  breakaway.End();
  MemoryReader locomotives(checkpoint.locomotives);
  locomotives_.ForEachField(locomotives);
  locomotives.End();
  locomotives_.PassBy((static_cast<double>(checkpoint.exchange) - 0.5) * scenario_.exchange_interval_s);
  transport_.Resume(checkpoint.exchange, checkpoint.vehicles, reply_);
  last_speed_mps_ = reply_.speed_mps;
  exchange_ = first_exchange_ = checkpoint.exchange;
  digest_ = checkpoint.state_digest;
  record_.at_time_zero = checkpoint.at_time_zero;
}

void TrainMaster::AskForCheckpoint() {
  if (!RecordIsNext()) throw std::logic_error("a checkpoint must follow a record");
  request_.snapshot = true;
}

TrainCheckpoint TrainMaster::Checkpoint() const {
  TrainCheckpoint checkpoint;
  checkpoint.exchange = exchange_;
  checkpoint.state_digest = digest_;
  checkpoint.at_time_zero = record_.at_time_zero;
  checkpoint.vehicles = reply_.snapshot;
  checkpoint.connections = forces_.Memory();
  MemoryWriter brake;
  BrakeSystem(brake_).ForEachField(brake);  // of a copy: the list of fields is written for changing them, too
  checkpoint.brake = brake.Take();
  MemoryWriter locomotives;
  Locomotives(locomotives_).ForEachField(locomotives);
  checkpoint.locomotives = locomotives.Take();
  MemoryWriter breakaway;
  BreakawayLoads(breakaway_).ForEachField(breakaway);
  checkpoint.breakaway = breakaway.Take();
  checkpoint.driver = schedule_.Memory();
  MemoryWriter driver;
  if (driver_) BuiltInDriverState(driver_->state).ForEachField(driver);
  checkpoint.built_in_driver = driver.Take();
  return checkpoint;
}

void TrainMaster::Exchange() {
  const double middle_s = time_s() + 0.5 * scenario_.exchange_interval_s;
  forces_.Evaluate(middle_s, reply_.head_velocity_mps, request_.coupler_force_n);
  if (can_part_) OpenPipes();
  if (!schedule_.IsDone() || DriverIsDue()) GiveCommands();
  if (brake_.locomotives().blends()) Blend();
  brake_.PressuresAt(middle_s, request_.cylinder_pressure_pa);
  locomotives_.Advance(middle_s, scenario_.exchange_interval_s, reply_.head_velocity_mps, request_);

  curves_.Evaluate(scenario_.exchange_interval_s, reply_.head_displacement_m, reply_.head_velocity_mps, request_);
  breakaway_.Evaluate(reply_.head_displacement_m, reply_.head_velocity_mps, request_);

  const std::uint64_t next = exchange_ + 1;
  request_.exchange = exchange_;
  request_.record = RecordIsNext();
  const std::uint64_t next_record = next / scenario_.ExchangesPerRecord();
  const bool ends = request_.record && schedule_.EndIsReached();
  const bool last = ends || static_cast<long>(next) == scenario_.Exchanges();
  request_.ledger = request_.record && (last || next_record % scenario_.RecordsPerLedger() == 0);
  transport_.Exchange(request_, reply_);

  exchange_ = next;
  has_ended_ = ends;
  if (reply_.fault.vehicle >= 0) {
    throw SimulationFault("vehicle " + std::to_string(reply_.fault.vehicle + 1) + ": " + reply_.fault.what +
                          " at t = " + std::to_string(time_s()) + " s");
  }
  request_.snapshot = false;
  forces_.CloseInterval(reply_.head_displacement_m);
  if (request_.record) ShowRecord();
}

void TrainMaster::Blend() {
  LocomotiveBrakes& brakes = brake_.locomotives();
  std::size_t brake = 0;
  for (std::size_t i = 0; i < locomotives_.size(); ++i) {
    while (brakes.vehicle(brake) != locomotives_.vehicle(i)) ++brake;  // some locomotives have no drive
    brakes.SetDynamicBrake(brake, Max(0.0, -locomotives_.drive(i).effort_n));
  }
}

void TrainMaster::OpenPipes() {
  const std::vector<Parting> partings = forces_.Partings();
  for (; opened_pipes_ < partings.size(); ++opened_pipes_) {
    brake_.OpenPipe(partings[opened_pipes_].time_s, partings[opened_pipes_].connection);
  }
}

void TrainMaster::Command(const DriverCommand& command) {
  if (command.IsOfRail()) {
    if (patches_ == kMostPatchesOnTheWay) throw std::invalid_argument("kind " + RuleOfPatches());
    ++patches_;
  }
  if (command.IsOfTrainBrake()) BrakeSystem(brake_).Command(command.OfBrake(time_s()));  // of a copy: may it?
  schedule_.Add(command);
}

const DriverView& TrainMaster::View(double ahead_m, bool is_shown_couplers) {
  if (!sight_) sight_.emplace(scenario_.track, consist_, scenario_.start_position_m);
  DriverView& view = view_;
  view.exchange = exchange_;
  view.time_s = time_s();
  view.speed_mps = reply_.head_velocity_mps.front();
  sight_->Look(reply_.head_displacement_m, ahead_m, view);
  view.effort_n = 0.0;
  for (std::size_t i = 0; i < locomotives_.size(); ++i) view.effort_n += locomotives_.drive(i).effort_n;
  if (!locomotives_.empty()) {
    view.throttle_notch = locomotives_.command(0).throttle_notch;
    view.dynamic_brake_notch = locomotives_.command(0).dynamic_brake_notch;
  }
  SetBrakeHandle(scenario_.initial_reduction_kpa, scenario_.commands, schedule_.Given(), time_s(),
                 scenario_.exchange_interval_s, view);
  BrakeSystem brake(brake_);  // of a copy: looking changes nothing
  brake.PressuresAt(time_s(), pressure_pa_);
  view.cylinder_kpa = 1e-3 * pressure_pa_.front();
  view.mean_cylinder_kpa = 0.0;
  for (const double pressure_pa : pressure_pa_)
    view.mean_cylinder_kpa += 1e-3 * pressure_pa / static_cast<double>(pressure_pa_.size());
  view.brake_pipe_kpa = std::numeric_limits<double>::quiet_NaN();
  if (const PneumaticBrake* machine = brake.pneumatic()) view.brake_pipe_kpa = 1e-3 * machine->PipePressure(0);
  view.coupler_force_n.clear();
  if (is_shown_couplers) {
    InTrainForces forces = forces_;  // of a copy: the exchange evaluates them itself
    std::vector<double> force_n(request_.coupler_force_n.size());
    forces.Evaluate(time_s() + 0.5 * scenario_.exchange_interval_s, reply_.head_velocity_mps, force_n);
    view.coupler_force_n.assign(force_n.begin() + 1, force_n.end() - 1);
  }
  return view;
}

void TrainMaster::GiveCommands() {
  double mass = 0.0, momentum = 0.0;
  for (std::size_t i = 0; i < mass_kg_.size(); ++i) {
    mass += mass_kg_[i];
    momentum += mass_kg_[i] * reply_.head_velocity_mps[i];
  }
  const std::size_t known = given_.size();
  schedule_.Judge({exchange_, time_s(), scenario_.start_position_m + reply_.head_displacement_m[0], momentum / mass},
                  given_);
  for (std::size_t i = known; i < given_.size(); ++i) Give(given_[i]);
  if (!DriverIsDue()) return;
  const BuiltInDriverParams& params = *scenario_.driver;
  for (const DriverCommand& command :
       Drive(params, driver_->train, driver_->stops_m, View(params.sight_m), driver_->state)) {
    schedule_.Give({exchange_, command, false}, given_);
    Give(given_.back());
  }
}

void TrainMaster::Give(const GivenCommand& given) {
  const double at_s = static_cast<double>(given.exchange) * scenario_.exchange_interval_s;
  if (given.command.IsOfLocomotives()) {
    locomotives_.Command(given.command.OfLocomotives(at_s));
  } else if (given.command.IsOfRail()) {
    request_.friction_patches.push_back(given.command.OfRail());
  } else if (given.command.IsOfLocomotiveBrakes()) {
    brake_.Command(given.command.OfLocomotiveBrakes(at_s));
  } else {
    brake_.Command(given.command.OfBrake(at_s));
  }
}

void TrainMaster::ShowRecord() {
  TrainRecord& record = record_;
  std::swap(record.vehicles, static_cast<VehicleRecords&>(reply_));  // the next record fills all of it anew
  std::swap(record.slides, reply_.slides);
  reply_.slides.clear();
  const std::vector<double>& speed = record.vehicles.speed_mps;
  for (size_t i = 0; i < last_speed_mps_.size(); ++i) {
    record.acceleration_mps2[i] = (speed[i] - last_speed_mps_[i]) / scenario_.record_interval_s;
  }
  last_speed_mps_ = speed;

  Digest digest;
  digest.Add(digest_);
  for (std::uint64_t vehicle : record.vehicles.state_digest) digest.Add(vehicle);
  forces_.AddMemoryTo(digest);
  brake_.ForEachField(MemoryDigest(digest));
  locomotives_.ForEachField(MemoryDigest(digest));
  breakaway_.ForEachField(MemoryDigest(digest));
  if (driver_) driver_->state.ForEachField(MemoryDigest(digest));
  digest_ = digest.value();

  double mass = 0.0, momentum = 0.0, moment = 0.0;
  for (size_t i = 0; i < mass_kg_.size(); ++i) {
    mass += mass_kg_[i];
    momentum += mass_kg_[i] * speed[i];
    moment += mass_kg_[i] * record.vehicles.position_m[i];
  }
  record.time_s = time_s();
  record.exchange = exchange_;
  record.mean_speed_mps = momentum / mass;
  record.mean_position_m = moment / mass;
  record.held = request_;
  forces_.Extensions(record.coupler_extension_m);
  brake_.PressuresAt(time_s(), record.cylinder_pressure_pa);
  if (const PneumaticBrake* machine = brake_.pneumatic()) machine->Record(record.brake);
  record.state_digest = digest_;
  record.given = given_;
  given_.clear();
  record.wheelset_work_j = &reply_.wheelset_work_j;
  record.ledger.reset();
  if (request_.ledger) record.ledger = MakeEnergyLedger(time_s(), reply_.energy, forces_.Energy());
  if (exchange_ == 0) record.at_time_zero = {record.mean_position_m, record.ledger->Stored()};
  for (const Observer& observer : observers_) observer(record);
}

}  // namespace train_dynamics
