// A table of comma-separated numbers, and the pressures that a train would take from it.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "fuzz.h"
#include "strict_config/csv_table.h"
#include "train_dynamics/brake/pressure_table.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace train_dynamics;
  static const train_brake_build::fuzz::Scratch folder;
  strict_config::ErrorList errors;
  const strict_config::CsvTable table =
      strict_config::ReadCsvTable(folder.Put("t.csv", {reinterpret_cast<const char*>(data), size}), errors);
  if (!errors.empty()) return 0;

  for (const std::vector<double>& column : table.values) {
    train_brake_build::fuzz::Require(column.size() == table.row_lines.size(), "a table is rectangular");
    for (const double value : column)
      train_brake_build::fuzz::Require(std::isfinite(value), "a table holds finite numbers");
  }
  try {
    const PressureTable pressures(table.values.front(), {table.values.begin() + 1, table.values.end()});
    std::vector<double> pressure_pa;
    for (const double time_s : {-1.0, 0.0, table.values.front().front(), 1e9}) {
      pressures.PressuresAt(time_s, pressure_pa);
      for (const double value : pressure_pa)
        train_brake_build::fuzz::Require(value >= 0.0, "a pressure is not negative");
    }
  } catch (const std::invalid_argument&) {  // times that do not ascend, negative pressures
  }
  return 0;
}
