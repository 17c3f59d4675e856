#pragma once

#include <memory>
#include <vector>

#include "train_dynamics/train/vehicle_block.h"

namespace train_dynamics {

class ThreadTeam;

/// The number of threads, up to `threads`, that speeds up the vehicles [first, first + count) of a scenario's train: a
/// barrier costs about as much as eight wagons (a pack of lanes), or a thousand LTD vehicles.
int UsefulThreads(const ScenarioParams& scenario, int first, int count, int threads);

/// A block whose vehicles are shared out over a fixed number of threads, in smaller blocks of about equal work.
///
/// The same bits for any number of threads: a vehicle's step depends on nothing but its own state and loads.
class ThreadedBlock : public VehicleBlock {
 public:
  /// The vehicles [first, first + count) of a scenario's train at their start state.
  /// @param threads  1 = the caller's only; at most one per vehicle is used
  ThreadedBlock(const ScenarioParams& scenario, const Consist& consist, int first, int count, int threads);
  ~ThreadedBlock() override;

  int threads() const { return static_cast<int>(shares_.size()); }  ///< in use

  bool Advance(const ExchangeRequest& request, int offset, ExchangeReply& reply) override;
  void Report(int offset, bool with_energy, ExchangeReply& reply) const override;
  void TellSlides(bool ongoing, double time_s, std::vector<SlideEvent>& slides) override;
  void Save(StateRow* rows) const override;
  void Restore(const StateRow* rows) override;
  VehicleFault FindFault() const override;

 private:
  struct Share {
    int first;  ///< within the whole block
    std::unique_ptr<VehicleBlock> block;
    bool sound = true;
  };
  std::vector<Share> shares_;  ///< [thread]
  std::unique_ptr<ThreadTeam> team_;
};

}  // namespace train_dynamics
