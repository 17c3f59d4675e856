#include "train_results/csv_recorder.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cerrno>
#include <numeric>
#include <stdexcept>

#include "train_results/conversions.h"
#include "train_results/plain_file.h"
#include "train_results/result_tables.h"

namespace train_results {
namespace {

using train_dynamics::ByteReader;
using train_dynamics::Bytes;
using train_dynamics::ByteWriter;
using train_dynamics::TrainRecord;
using train_dynamics::WagonDetail;

constexpr const char* kHistory = "train_history.csv";
constexpr const char* kPressures = "pressures.csv";
std::string WagonFile(int vehicle, int vehicles) { return train_dynamics::VehicleName(vehicle, vehicles) + ".csv"; }

std::ofstream Open(const std::filesystem::path& file) {
  std::ofstream stream(file);
  if (!stream) throw std::runtime_error("cannot write " + file.string() + ": " + WriteFailure(errno));
  return stream;
}

void Check(const std::ofstream& stream, const std::filesystem::path& file) {
  if (!stream) throw std::runtime_error("could not write all of " + file.string() + ": " + WriteFailure(errno));
}

template <class Values>
void Row(std::ofstream& stream, const Values& values) {
  fmt::print(stream, ",{:.9g}", fmt::join(values, ","));
}

/// A line for each vehicle, a column for each number of its record.
std::string VehicleRows(const train_dynamics::RecordArrays& record) {
  using train_dynamics::RecordInfo;
  std::string table = VehicleTable().Header();
  for (std::size_t vehicle = 0; vehicle < record.speed_mps.size(); ++vehicle) {
    table += std::to_string(vehicle + 1);
    train_dynamics::ForEachRecordField(
        [&](const RecordInfo& field, const auto& array) {
          const auto first = array.begin() + static_cast<long>(vehicle * field.numbers);
          table += fmt::format(",{:.12g}", fmt::join(first, first + field.numbers, ","));
        },
        record);
    table += '\n';
  }
  return table;
}

}  // namespace

CsvRecorder::CsvRecorder(const std::filesystem::path& folder)
    : folder_(folder), history_(Open(folder / kHistory)), pressures_(Open(folder / kPressures)) {
  history_ << HistoryTable().Header();
}

CsvRecorder::CsvRecorder(const std::filesystem::path& folder, const Bytes& checkpoint, int vehicles)
    : folder_(folder), vehicles_(vehicles) {
  ByteReader reader(checkpoint);
  const auto check = [&](const std::string& name) {
    const std::uint64_t size = reader.Word(), value = reader.Word();
    train_dynamics::StreamDigest& digest = digests_[name];
    AddToDigest(folder / name, 0, size, digest);
    if (digest.value() != value) {
      throw std::invalid_argument((folder / name).string() +
                                  " is not the table that the checkpoint is of, or it is damaged");
    }
  };
  check(kHistory);
  check(kPressures);
  if (reader.Word() != 0) {
    train_dynamics::ForEachBrakeField(
        [&](const std::string& name, const auto&) {
          check(name + ".csv");
          brake_.emplace(name + ".csv", std::ofstream());
        },
        train_dynamics::BrakeRecordArrays());
  }
  for (std::uint64_t count = reader.Word(); count > 0; --count) {
    const std::uint64_t vehicle = reader.Word();
    if (vehicle >= static_cast<std::uint64_t>(vehicles)) {
      throw train_dynamics::SnapshotError("is damaged: no such vehicle");
    }
    check(WagonFile(static_cast<int>(vehicle), vehicles));
    wagons_.emplace(static_cast<int>(vehicle), std::ofstream());
  }
  reader.End();
}

void CsvRecorder::GoOn() {
  const auto go_on = [&](const std::string& name) {
    std::filesystem::resize_file(folder_ / name, digests_[name].size());
    return std::ofstream(folder_ / name, std::ios::app);
  };
  history_ = go_on(kHistory);
  pressures_ = go_on(kPressures);
  for (auto& [name, stream] : brake_) stream = go_on(name);
  for (auto& [vehicle, stream] : wagons_) stream = go_on(WagonFile(vehicle, vehicles_));
}

Bytes CsvRecorder::Checkpoint() {
  ByteWriter writer;
  const auto add = [&](std::ofstream& stream, const std::string& name) {
    stream.flush();
    Check(stream, folder_ / name);
    SyncFile(folder_ / name);
    train_dynamics::StreamDigest& digest = digests_[name];
    AddToDigest(folder_ / name, digest.size(), static_cast<std::uint64_t>(stream.tellp()), digest);
    writer.Add(digest.size());
    writer.Add(digest.value());
  };
  add(history_, kHistory);
  add(pressures_, kPressures);
  writer.Add(std::uint64_t{brake_.empty() ? 0u : 1u});
  train_dynamics::ForEachBrakeField(
      [&](const std::string& name, const auto&) {
        if (!brake_.empty()) add(brake_.at(name + ".csv"), name + ".csv");
      },
      train_dynamics::BrakeRecordArrays());
  writer.Add(std::uint64_t{wagons_.size()});
  for (auto& [vehicle, stream] : wagons_) {
    writer.Add(static_cast<std::uint64_t>(vehicle));
    add(stream, WagonFile(vehicle, vehicles_));
  }
  return writer.bytes();
}

void CsvRecorder::Record(const TrainRecord& record) {
  const std::vector<double>& speed = record.vehicles.speed_mps;
  vehicles_ = static_cast<int>(speed.size());
  const std::vector<double>& force = record.held.coupler_force_n;
  const auto mean = [](const std::vector<double>& v) {
    return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
  };
  fmt::print(history_, "{:.6f},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", record.time_s,
             3.6 * record.mean_speed_mps, 3.6 * speed.front(), 3.6 * speed.back(), record.mean_position_m,
             *std::max_element(force.begin(), force.end()), *std::min_element(force.begin(), force.end()),
             mean(record.cylinder_pressure_pa));

  const auto row = [&record](std::ofstream& stream, const std::vector<double>& values) {
    fmt::print(stream, "{:.6f}", record.time_s);
    Row(stream, values);
    stream << '\n';
  };
  if (record.exchange == 0) pressures_ << PressureTable().Header(vehicles_);
  row(pressures_, record.cylinder_pressure_pa);
  if (!record.brake.empty()) {
    if (record.exchange == 0) {
      for (const ResultTable& table : BrakeTables()) {
        brake_.emplace(table.file, Open(folder_ / table.file)).first->second << table.Header(vehicles_);
      }
    }
    train_dynamics::ForEachBrakeField(
        [&](const std::string& name, const std::vector<double>& values) { row(brake_.at(name + ".csv"), values); },
        record.brake);
  }

  for (const WagonDetail& detail : record.vehicles.details) {
    if (wagons_.count(detail.vehicle) == 0) OpenWagon(detail.vehicle);
    std::ofstream& wagon = wagons_.at(detail.vehicle);
    fmt::print(wagon, "{:.6f},{:.9g}", record.time_s, speed[detail.vehicle]);
    Row(wagon, detail.output.normal_force_n);
    Row(wagon, detail.output.creepage);
    Row(wagon, detail.output.creep_force_n);
    Row(wagon, detail.output.shoe_force_n);
    Row(wagon,
        std::vector<double>(detail.position.pitch.begin(), detail.position.pitch.begin() + train_dynamics::kWheelset1));
    Row(wagon, detail.nest_compression_m);
    Row(wagon, detail.output.wedge_friction_n);
    fmt::print(wagon, ",{:.9g},{:.9g},{:.9g}\n", force[detail.vehicle], force[detail.vehicle + 1],
               record.cylinder_pressure_pa[detail.vehicle]);
  }
  last_ = static_cast<const train_dynamics::RecordArrays&>(record.vehicles);
  CheckAll();
}

void CsvRecorder::OpenWagon(int vehicle) {
  std::ofstream wagon = Open(folder_ / WagonFile(vehicle, vehicles_));
  wagon << WagonTable().Header();
  wagons_.emplace(vehicle, std::move(wagon));
}

void CsvRecorder::Close() {
  WriteFile(folder_ / "vehicles.csv", VehicleRows(last_));
  for (std::ofstream* stream : {&history_, &pressures_}) stream->flush();
  for (auto& [name, stream] : brake_) stream.flush();
  for (auto& [vehicle, stream] : wagons_) stream.flush();
  CheckAll();
}

void CsvRecorder::CheckAll() const {
  Check(history_, folder_ / kHistory);
  Check(pressures_, folder_ / kPressures);
  for (const auto& [name, stream] : brake_) Check(stream, folder_ / name);
  for (const auto& [vehicle, stream] : wagons_) Check(stream, folder_ / WagonFile(vehicle, vehicles_));
}

void WriteCouplerTable(const std::filesystem::path& folder, const train_dynamics::TrainMaster& master) {
  std::string couplers = CouplerTable().Header();
  int number = 1;
  for (const train_dynamics::ForceExtremes& extreme : master.in_train_forces().Extremes()) {
    couplers += fmt::format("{},{:.9g},{:.6f},{:.9g},{:.6f}\n", number++, extreme.tension_n, extreme.tension_time_s,
                            extreme.compression_n, extreme.compression_time_s);
  }
  WriteFile(folder / "couplers.csv", couplers);
}

}  // namespace train_results
