#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "strict_config/error_list.h"
#include "strict_config/yaml_tree.h"

namespace strict_config {

/// A rectangular table of finite numbers with named columns.
struct CsvTable {
  std::string file;                         ///< as messages name it
  int header_line = 0;                      ///< counted from 1
  std::vector<std::string> columns;         ///< names
  std::vector<std::vector<double>> values;  ///< [column][row]
  std::vector<int> row_lines;               ///< [row] the line in the file, for messages

  /// The values of a column; null, with an error reported, if it does not exist.
  const std::vector<double>* Column(const std::string& name, ErrorList& errors) const;
};

/// The bounds within which a table is read, however hostile.
struct CsvLimits {
  static constexpr std::size_t kBytes = 256u << 20;
  static constexpr std::size_t kColumns = 10000;
  static constexpr std::size_t kValues = 20000000;
};

/// Reads a table of numbers.
///
/// The first line names the columns, each name once. Each further line has one finite decimal number per
/// column. Columns are separated by commas or, where the header has none, by semicolons or tabs. A cell may be in
/// double quotes, within which a quote is written twice; a quoted cell ends on its line. A separator at the end of
/// every line makes no column. Empty lines, and lines that start with '#', are skipped; spaces around cells do not
/// matter. All errors are added to `errors`; use the table only if there are none.
CsvTable ReadCsvTable(const std::string& file, ErrorList& errors);

/// Reads such a table as a list of maps: each row one map, with the names of the columns as keys.
///
/// Here cells may also hold text; an empty one counts as not given. A column named `note` is ignored. Messages about a
/// value name its line, those about a key the header's.
///
/// @param document the source that the nodes name in messages
/// @return null after an error
NodePtr ReadCsvList(const std::string& file, const std::shared_ptr<const Document>& document, ErrorList& errors);

}  // namespace strict_config
