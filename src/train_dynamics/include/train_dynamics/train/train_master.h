#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "train_dynamics/brake/brake_system.h"
#include "train_dynamics/train/breakaway_loads.h"
#include "train_dynamics/train/built_in_driver.h"
#include "train_dynamics/train/command_schedule.h"
#include "train_dynamics/train/curving_loads.h"
#include "train_dynamics/train/driver_view.h"
#include "train_dynamics/train/energy_ledger.h"
#include "train_dynamics/train/in_train_forces.h"
#include "train_dynamics/train/lockstep.h"
#include "train_dynamics/train/locomotives.h"
#include "train_dynamics/train/scenario.h"
#include "train_dynamics/train/snapshot.h"

namespace train_dynamics {

/// The train at the end of an exchange, as it is recorded. Forces are those of the interval that ended.
struct TrainRecord {
  double time_s = 0.0;
  std::uint64_t exchange = 0;    ///< number of exchanges so far
  double mean_speed_mps = 0.0;   ///< of the vehicles' momentum
  double mean_position_m = 0.0;  ///< of the vehicles' masses
  VehicleRecords vehicles;
  std::vector<SlideEvent> slides;           ///< that have ended since the last record; with a ledger, also ongoing ones
  std::vector<double> acceleration_mps2;    ///< [vehicle] mean over the record interval; NaN at time 0
  LoadArrays held;                          ///< the loads of the interval that ended
  std::vector<double> coupler_extension_m;  ///< [connection]
  std::vector<double> cylinder_pressure_pa;  ///< [vehicle] at time_s
  BrakeRecordArrays brake;                   ///< [vehicle] at time_s; empty where the brake has none of it
  std::uint64_t state_digest = 0;            ///< chained over all records so far
  std::optional<EnergyLedger> ledger;        ///< where one is due
  /// ExchangeReply::wheelset_work_j, while the record is shown: copies of it are for recorders, which have no use for
  /// that.
  const std::vector<double>* wheelset_work_j = nullptr;
  std::vector<GivenCommand> given;  ///< since the record before
  TimeZero at_time_zero;            ///< of the run, also where it was resumed later
};

/// Steps a train: computes what acts between its vehicles, exchange by exchange, and keeps the books.
///
/// Where the vehicles are computed is known to the transport only.
class TrainMaster {
 public:
  using Observer = std::function<void(const TrainRecord&)>;

  /// Keeps references: scenario, consist and transport must outlive the master.
  TrainMaster(const ScenarioParams& scenario, const Consist& consist, Transport& transport, BrakeSystem brake);

  /// Called for every record, the one at time 0 included.
  void AddObserver(Observer observer) { observers_.push_back(std::move(observer)); }

  /// Brings the vehicles to time 0 and shows the first record.
  void Start();
  /// Brings the vehicles and the books to the state of a checkpoint instead. Its record is not shown again.
  /// @throws SnapshotError if the checkpoint is not one of such a train
  void Resume(const TrainCheckpoint& checkpoint);
  /// Whether checkpoints can be requested; known after the start.
  bool GivesCheckpoints() const { return transport_.GivesSnapshots(); }
  /// Requests a checkpoint of the next exchange, which must be one that ends with a record.
  void AskForCheckpoint();
  /// The checkpoint of the last exchange, without scenario and summary, which the caller adds.
  TrainCheckpoint Checkpoint() const;
  /// Whether the next exchange ends with a record.
  bool RecordIsNext() const { return (exchange_ + 1) % scenario_.ExchangesPerRecord() == 0; }

  /// One exchange: the train moves on by one exchange interval.
  /// @throws SimulationFault naming the vehicle, the quantity and the time
  void Exchange();
  /// Gives a command for the start of the next exchange. The vehicles of the command and its notch must be checked, see
  /// JudgeLocomotiveCommand.
  /// @throws std::invalid_argument if the brake cannot obey, or for a patch of rail too many; then nothing has changed
  void Command(const DriverCommand& command);
  /// Number of patches of rail that are added during the run, past and future: at most kMostPatchesOnTheWay.
  std::size_t patches() const { return patches_; }
  const CommandSchedule& schedule() const { return schedule_; }
  /// What a driver sees at the start of the next exchange, commands that are given there not included.
  /// @param ahead_m            distance over which the driver knows the line, from the front of the train; >= 0
  /// @param is_shown_couplers  whether the view has the forces in all couplers, which no cab shows
  const DriverView& View(double ahead_m, bool is_shown_couplers = false);

  long exchanges() const { return scenario_.Exchanges(); }  ///< of the whole run, if `until` does not end it
  bool Done() const { return has_ended_ || static_cast<long>(exchange_) >= exchanges(); }
  /// Whether `until` has ended the run.
  bool EndedByUntil() const { return has_ended_; }

  double time_s() const { return static_cast<double>(exchange_) * scenario_.exchange_interval_s; }
  std::uint64_t exchange() const { return exchange_; }
  /// All 0 before Start or Resume.
  const TimeZero& at_time_zero() const { return record_.at_time_zero; }
  /// When this run began: later than 0 if it was resumed.
  double start_s() const { return static_cast<double>(first_exchange_) * scenario_.exchange_interval_s; }
  const InTrainForces& in_train_forces() const { return forces_; }
  Locomotives& locomotives() { return locomotives_; }
  const Locomotives& locomotives() const { return locomotives_; }
  std::uint64_t state_digest() const { return digest_; }

 private:
  void ShowRecord();
  /// Reports the connections that have broken since the last call to the brake.
  void OpenPipes();
  /// The built-in driver with what it knows and remembers.
  struct Driver {
    DriversTrain train;
    std::vector<double> stops_m;
    std::uint64_t period;  ///< [exchanges]
    BuiltInDriverState state;
  };
  bool DriverIsDue() const { return driver_ && exchange_ % driver_->period == 0; }
  /// Gives the locomotives' brakes the efforts of their dynamic brakes over the last exchange.
  void Blend();
  void GiveCommands();
  void Give(const GivenCommand& given);

  const ScenarioParams& scenario_;
  const Consist& consist_;
  Transport& transport_;
  BrakeSystem brake_;
  InTrainForces forces_;
  Locomotives locomotives_;
  CurvingLoads curves_;
  BreakawayLoads breakaway_;
  bool can_part_ = false;
  std::size_t opened_pipes_ = 0;
  std::size_t patches_ = 0;  ///< of rail: of the scenario's commands, and live ones
  std::uint64_t exchange_ = 0, first_exchange_ = 0;
  std::uint64_t digest_ = 0;
  ExchangeRequest request_;
  ExchangeReply reply_;
  CommandSchedule schedule_;
  std::optional<Driver> driver_;
  std::optional<RouteSight> sight_;  ///< of a driver, once there is one
  DriverView view_;
  std::vector<double> pressure_pa_;  ///< [vehicle] that the driver sees
  std::vector<GivenCommand> given_;  ///< since the last record
  bool has_ended_ = false;
  TrainRecord record_;  ///< the last one; keeps its memory from record to record
  std::vector<double> mass_kg_;
  std::vector<double> last_speed_mps_;
  std::vector<Observer> observers_;
};

}  // namespace train_dynamics
