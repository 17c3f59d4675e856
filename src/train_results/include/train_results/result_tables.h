#pragma once

#include <string>
#include <vector>

namespace train_results {

/// A column of a table, or a number of summary.json.
struct ResultColumn {
  std::string name;  ///< with "{}": a column for each vehicle, from 1
  std::string unit;  ///< empty: it has none
  std::string meaning;
};

/// A CSV table of a run. Its writer and the reference take its first line from here.
struct ResultTable {
  std::string file;  ///< with "NNN": a file for each vehicle that is recorded in detail
  std::string meaning;
  std::vector<ResultColumn> columns;

  /// The first line, with its end. @param vehicles  of the train, for columns of each
  std::string Header(int vehicles = 0) const;
};

ResultTable HistoryTable();
ResultTable PressureTable();
/// A table of each quantity of the brake that is recorded (brake/pneumatic/brake_record.h).
std::vector<ResultTable> BrakeTables();
ResultTable WagonTable();
ResultTable VehicleTable();
ResultTable CouplerTable();
ResultTable SlideTable();
ResultTable TrackWearTable();

/// All of these.
std::vector<ResultTable> ResultTables();

/// What summary.json holds: "final_speed_kmh.mean" within a map, "stops[].time_s" in a list of maps, "dissipated_j.*"
/// under names that depend on the train.
const std::vector<ResultColumn>& SummaryFields();

/// The other files of a run's folder: the name, and what it holds.
struct ResultFile {
  const char *name, *meaning;
};
const std::vector<ResultFile>& ResultFiles();

}  // namespace train_results
