#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "train_dynamics/numeric/digest.h"
#include "train_dynamics/track/friction_map.h"
#include "train_dynamics/train/snapshot.h"
#include "train_dynamics/vehicle/slide_event.h"
#include "train_dynamics/vehicle/vehicle_loads.h"
#include "train_dynamics/vehicle/vehicle_record.h"
#include "train_dynamics/vehicle/wagon.h"
#include "train_dynamics/vehicle/work.h"

/// The exchange between the master, which computes what acts between vehicles, and the ranks, which integrate
/// them.
///
///   at the start      master -> rank   which vehicles, their parameters, the track              (Start)
///                     rank -> master   their state at time 0, as a record
///   exchange k        master -> rank   k, dt, steps, loads (vehicle/vehicle_loads.h)            (ExchangeRequest)
///                     rank -> master   coupler heads at the interval's end; a record when asked (ExchangeReply;
///                                      vehicle/vehicle_record.h, vehicle/work.h)
///   barrier           the master has every reply before it computes exchange k + 1
///
/// Loads are those of the middle of the interval and are held over it. All sums over vehicles
/// are made by the master in the order of the vehicles, so that a result does not depend on which rank a
/// vehicle is in.
namespace train_dynamics {

/// Asks for one exchange, with the loads on the vehicles.
struct ExchangeRequest : LoadArrays {
  std::uint64_t exchange = 0;  ///< k, from 0
  double dt_s = 0.0;           ///< step of the vehicles' integrators
  int steps = 0;               ///< per exchange; the interval is steps * dt_s
  bool record = false;         ///< the reply shall hold the record of the interval's end
  bool ledger = false;         ///< ... and the vehicles' energies
  bool snapshot = false;       ///< the reply shall hold the vehicles' state at the interval's end
  /// Patches of rail added since the start of the run, each with a friction_coefficient and no ramp. They override
  /// those of the track, later ones override earlier ones. Each exchange has all of them, so that a rank that joins
  /// later has them, too.
  std::vector<FrictionPatchParams> friction_patches;
};

/// One wagon in full detail, at the end of a step.
struct WagonDetail {
  int vehicle = 0;  ///< index in the train, from 0
  BodyVector<double> position, velocity;
  WagonOutput<double> output;
  std::array<double, 4> nest_compression_m{};
};

/// The fault that ends a run: a state that is not finite or beyond its limits.
struct VehicleFault {
  int vehicle = -1;  ///< index in the train, from 0; -1: none
  std::string what;  ///< body, quantity and value
};

/// The record of a row of vehicles.
struct VehicleRecords : RecordArrays {
  std::vector<std::uint64_t> state_digest;  ///< [vehicle]
  std::vector<WagonDetail> details;         ///< filled by the rank that has the vehicle

  VehicleRecords() = default;
  /// @param detailed  indices of the vehicles to be recorded in full detail
  VehicleRecords(int vehicles, const std::vector<int>& detailed);
};

/// All arrays are indexed by vehicle; those of a record are unchanged if none was requested.
struct ExchangeReply : ReplyArrays, VehicleRecords {
  VehicleFault fault;                 ///< the first in the order of the vehicles
  std::vector<VehicleEnergy> energy;  ///< with a ledger
  std::vector<StateRow> snapshot;     ///< see VehicleBlock::Save
  std::vector<SlideEvent> slides;     ///< with a record: see VehicleBlock::TellSlides
  /// [vehicle][2 kMostWheelsets]: WagonState::creep_work of each wheelset, then brake_work; 0 where there is none; with
  /// a record
  std::vector<double> wheelset_work_j;

  /// @param detailed  indices of the vehicles to be recorded in full detail
  ExchangeReply(int vehicles, const std::vector<int>& detailed);
};

/// The master's access to all vehicles. The second of the two interfaces with virtual functions.
class Transport {
 public:
  virtual ~Transport() = default;
  /// Brings all vehicles to time 0 and fills a whole record, energies included.
  virtual void Start(ExchangeReply& reply) = 0;
  /// Brings all vehicles to a state that a snapshot holds, at the beginning of an exchange; replies as Start.
  /// @throws SnapshotError if the snapshot does not fit
  virtual void Resume(std::uint64_t exchange, const std::vector<StateRow>& snapshot, ExchangeReply& reply) = 0;
  /// Whether snapshots can be requested; known after the start.
  virtual bool GivesSnapshots() const { return true; }
  /// One exchange with every vehicle; returns when all have replied.
  virtual void Exchange(const ExchangeRequest& request, ExchangeReply& reply) = 0;
};

/// A run that cannot continue: names the vehicle, the quantity and the time.
class SimulationFault : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace train_dynamics
