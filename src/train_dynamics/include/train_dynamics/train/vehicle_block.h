#pragma once

#include <memory>
#include <vector>

#include "train_dynamics/train/lockstep.h"
#include "train_dynamics/train/scenario.h"

namespace train_dynamics {

/// A contiguous block of vehicles that one thread or one process integrates. The first of the two interfaces with
/// virtual functions: one call per block and exchange, whatever models its vehicles are of.
class VehicleBlock {
 public:
  virtual ~VehicleBlock() = default;

  /// Advances the block's vehicles by request.steps steps and replies; false if a vehicle has become faulty.
  /// @param offset  index of the block's first vehicle in the arrays of request and reply
  virtual bool Advance(const ExchangeRequest& request, int offset, ExchangeReply& reply) = 0;

  /// Replies with the present state, as a record.
  virtual void Report(int offset, bool with_energy, ExchangeReply& reply) const = 0;

  /// Appends the slides that have ended since the last call, in the order of the vehicles.
  /// @param ongoing  also the ongoing ones, as they are at `time_s`
  virtual void TellSlides(bool ongoing, double time_s, std::vector<SlideEvent>& slides) = 0;

  /// Writes the state of each vehicle to its row.
  virtual void Save(StateRow* rows) const = 0;
  /// Restores the states from such rows. @throws SnapshotError if they are not of these vehicles
  virtual void Restore(const StateRow* rows) = 0;

  /// The first vehicle of the block whose state is not finite or beyond its limits, if any.
  virtual VehicleFault FindFault() const = 0;
};

/// The largest count of numbers in the state of any vehicle. Of slides that have ended and are not reported yet, it
/// includes kSharedSlidesPerWheelset per wheelset.
int MostStateNumbers();

/// Builds the vehicles [first, first + count) of a scenario's train at their start state, each of its group's model.
/// External ones are left out: their places in replies and rows stay as they are.
std::unique_ptr<VehicleBlock> MakeVehicleBlock(const ScenarioParams& scenario, const Consist& consist, int first,
                                               int count);

}  // namespace train_dynamics
