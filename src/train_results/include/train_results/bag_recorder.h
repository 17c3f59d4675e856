#pragma once

#include <map>
#include <string>

#include "train_results/bag_writer.h"
#include "train_results/conversions.h"

namespace train_results {

/// Writes every record of a run into a bag, under the topics on which ltd_master publishes:
///
///   /train/state  /train/in_train_forces  /train/brake_pressures  /train/energy_ledger
///   /train/slides  /train/wagon_NNN/state  /train/scenario
class BagRecorder {
 public:
  /// @throws std::system_error if the file cannot be made
  BagRecorder(const std::string& file, const train_dynamics::ScenarioParams& scenario);

  /// Prepares to continue the bag of a checkpoint; GoOn does it, see BagWriter.
  BagRecorder(const std::string& file, const train_dynamics::Bytes& checkpoint, int vehicles);
  void GoOn() { bag_.GoOn(); }
  train_dynamics::Bytes Checkpoint();
  void Sync() const { bag_.Sync(); }

  /// An observer of the run's TrainMaster. @throws std::system_error
  void Record(const train_dynamics::TrainRecord& record);

  /// Completes the bag. @throws std::system_error
  void Close() { bag_.Close(); }

 private:
  /// Writes the message of a view of the record.
  template <class View>
  void WriteView(int topic, ros::Time time, const train_dynamics::TrainRecord& record);
  int WagonTopic(int vehicle, int vehicles);

  BagWriter bag_;
  int state_topic_ = 0, forces_topic_ = 0, pressures_topic_ = 0, ledger_topic_ = 0;
  int slides_topic_ = -1;           ///< below 0: nothing has slid yet
  int given_topic_ = -1;            ///< < 0: no command was given so far
  std::map<int, int> wagon_topic_;  ///< by vehicle
  train_brake_msgs::EnergyLedger ledger_;
  train_brake_msgs::Slides slides_;
  train_brake_msgs::WagonState wagon_;
  train_brake_msgs::GivenCommand given_;
};

}  // namespace train_results
