#include "ltd_master/bag_recorder.h"

#include <algorithm>
#include <filesystem>

namespace ltd_master {

BagRecorder::BagRecorder(const std::string& file)
    : file_(file), bag_(std::make_unique<rosbag::Bag>(file + ".active", rosbag::bagmode::Write)) {}

BagRecorder::~BagRecorder() {
  try {
    Close();
  } catch (const std::exception&) {  // an unwinding caller has the first error already
  }
}

void BagRecorder::Record(const train_dynamics::TrainRecord& record) {
  // A bag knows no time before this one.
  const ros::Time time = std::max(ros::TIME_MIN, ros::Time(record.time_s));
  Convert(record, state_);
  bag_->write("/train/state", time, state_);
  Convert(record, forces_);
  bag_->write("/train/in_train_forces", time, forces_);
  Convert(record, pressures_);
  bag_->write("/train/brake_pressures", time, pressures_);
  if (record.ledger != nullptr) {
    if (record.exchange == 0) initial_j_ = record.ledger->Stored();
    Convert(record, *record.ledger, initial_j_, ledger_);
    bag_->write("/train/energy_ledger", time, ledger_);
  }
  const int vehicles = static_cast<int>(record.vehicles.position_m.size());
  for (const train_dynamics::WagonDetail& detail : record.vehicles.details) {
    Convert(record, detail, wagon_);
    bag_->write("/train/" + VehicleName(detail.vehicle, vehicles) + "/state", time, wagon_);
  }
}

void BagRecorder::Close() {
  if (bag_ == nullptr) return;
  std::unique_ptr<rosbag::Bag> bag = std::move(bag_);
  try {
    bag->close();
  } catch (...) {
    // On a full disk closing fails, and the destructor, which closes once more, would end the process: leak it.
    static_cast<void>(bag.release());
    throw;
  }
  std::filesystem::rename(file_ + ".active", file_);
}

}  // namespace ltd_master
