#pragma once

#include <memory>
#include <vector>

#include "train_dynamics/train/lockstep.h"
#include "train_dynamics/train/scenario.h"

namespace train_dynamics {

/// A contiguous block of vehicles that one thread or one process integrates. The first of the two seams with
/// virtual functions: one call per block and exchange, whatever the vehicle model.
class VehicleBlock {
 public:
  virtual ~VehicleBlock() = default;

  /// Advances the block's vehicles by request.steps steps and replies; false if a vehicle has become faulty.
  /// @param offset  index of the block's first vehicle in the arrays of request and reply
  virtual bool Advance(const ExchangeRequest& request, int offset, ExchangeReply& reply) = 0;

  /// Replies with the present state, as a record.
  virtual void Report(int offset, bool with_energy, ExchangeReply& reply) const = 0;

  /// How many numbers the state of one vehicle has.
  virtual int NumbersPerVehicle() const = 0;
  /// Writes the state, NumbersPerVehicle() of each vehicle.
  virtual void Save(double* state) const = 0;
  /// Takes such a state back.
  virtual void Restore(const double* state) = 0;

  /// The first vehicle of the block whose state is not finite or absurd, if any.
  virtual VehicleFault FindFault() const = 0;
};

/// @throws SnapshotError if a snapshot has not the numbers of `vehicles` vehicles of the block's kind
void CheckSnapshotSize(const std::vector<double>& snapshot, const VehicleBlock& block, int vehicles);

/// Builds the vehicles [first, first + count) of a scenario's train at their start state.
std::unique_ptr<VehicleBlock> MakeVehicleBlock(const ScenarioParams& scenario, const Consist& consist,
                                               int first, int count);

}  // namespace train_dynamics
