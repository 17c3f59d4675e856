#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "strict_config/error_list.h"

namespace strict_config {

/// A rectangular table of finite numbers with named columns.
struct CsvTable {
  std::string file;                         ///< as messages name it
  int header_line = 0;                      ///< counted from 1
  std::vector<std::string> columns;         ///< names
  std::vector<std::vector<double>> values;  ///< [column][row]
  std::vector<int> row_lines;               ///< [row] the line in the file, for messages

  /// The values of a column, or null after reporting that there is none of this name.
  const std::vector<double>* Column(const std::string& name, ErrorList& errors) const;
};

/// The bounds within which a table is read, however hostile.
struct CsvLimits {
  static constexpr std::size_t kBytes = 256u << 20;
  static constexpr std::size_t kColumns = 10000;
  static constexpr std::size_t kValues = 20000000;
};

/// Reads comma-separated numbers.
///
/// The first line names the columns, each name once. Each further line has one finite decimal number per
/// column. Empty lines, and lines that start with '#', are skipped; spaces around values do not matter;
/// nothing is quoted. All that is wrong is added to `errors`; the table is only meant to be used when there
/// is nothing.
CsvTable ReadCsvTable(const std::string& file, ErrorList& errors);

}  // namespace strict_config
