#pragma once

#include <memory>
#include <vector>

#include "train_dynamics/train/lockstep.h"
#include "train_dynamics/train/scenario.h"

namespace train_dynamics {

/// A contiguous block of vehicles that one thread or one process integrates. The first of the two seams with
/// virtual functions: one call per block and exchange, whatever models its vehicles
/// are of.
class VehicleBlock {
 public:
  virtual ~VehicleBlock() = default;

  /// Advances the block's vehicles by request.steps steps and replies; false if a vehicle has become faulty.
  /// @param offset  index of the block's first vehicle in the arrays of request and reply
  virtual bool Advance(const ExchangeRequest& request, int offset, ExchangeReply& reply) = 0;

  /// Replies with the present state, as a record.
  virtual void Report(int offset, bool with_energy, ExchangeReply& reply) const = 0;

  /// Appends the slides that have ended since it was asked last, in the order of the vehicles.
  /// @param ongoing  those that go on, too, as they are at `time_s`
  virtual void TellSlides(bool ongoing, double time_s, std::vector<SlideEvent>& slides) = 0;

  /// Writes the state of each vehicle to its row.
  virtual void Save(StateRow* rows) const = 0;
  /// Takes such rows back. @throws SnapshotError if they are not of these vehicles
  virtual void Restore(const StateRow* rows) = 0;

  /// The first vehicle of the block whose state is not finite or beyond its limits, if any.
  virtual VehicleFault FindFault() const = 0;
};

/// The most numbers that the state of a vehicle of this program can have, but for slides that have ended and are not
/// told yet: of those, kSharedSlidesPerWheelset of each wheelset.
int MostStateNumbers();

/// Builds the vehicles [first, first + count) of a scenario's train at their start state, each of its group's model.
/// External ones are left out: their places in replies and rows stay as they are.
std::unique_ptr<VehicleBlock> MakeVehicleBlock(const ScenarioParams& scenario, const Consist& consist, int first,
                                               int count);

}  // namespace train_dynamics
