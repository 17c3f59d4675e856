#pragma once

#include <rosbag/bag.h>

#include <memory>
#include <string>

#include "ltd_master/conversions.h"

namespace ltd_master {

/// Writes every record of a run into a bag, under the topics on which ltd_master publishes:
///
///   /train/state  /train/in_train_forces  /train/brake_pressures  /train/energy_ledger
///   /train/wagon_NNN/state
///
/// The bag is called FILE.active until it is complete, so that FILE is always readable.
class BagRecorder {
 public:
  /// @throws rosbag::BagException if the file cannot be made
  explicit BagRecorder(const std::string& file);
  ~BagRecorder();

  /// An observer of the run's TrainMaster.
  void Record(const train_dynamics::TrainRecord& record);

  /// Closes the bag and gives it its name. @throws rosbag::BagException
  void Close();

 private:
  std::string file_;
  std::unique_ptr<rosbag::Bag> bag_;
  double initial_j_ = 0.0;
  train_brake_msgs::TrainState state_;
  train_brake_msgs::InTrainForces forces_;
  train_brake_msgs::BrakePressures pressures_;
  train_brake_msgs::EnergyLedger ledger_;
  train_brake_msgs::WagonState wagon_;
};

}  // namespace ltd_master
