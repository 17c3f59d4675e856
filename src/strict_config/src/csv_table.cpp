#include "strict_config/csv_table.h"

#include <algorithm>
#include <optional>
#include <set>

#include "strict_config/scalar.h"
#include "strict_config/suggestion.h"
#include "strict_config/text_file.h"
#include "strict_config/yaml_tree.h"

namespace strict_config {
namespace {

std::string Trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/// The values of a line; at most one more than the largest table has.
std::vector<std::string> Cells(const std::string& line) {
  std::vector<std::string> cells;
  for (std::size_t begin = 0; begin <= line.size() && cells.size() <= CsvLimits::kColumns;) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back(Trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return cells;
}

bool CheckHeader(const CsvTable& table, ErrorList& errors) {
  const auto refuse = [&](const std::string& reason) {
    errors.Add(table.file, table.header_line, "", reason);
    return false;
  };
  if (table.columns.size() > CsvLimits::kColumns) {
    return refuse("has more than " + std::to_string(CsvLimits::kColumns) + " columns");
  }
  bool ok = true;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::string& name = table.columns[i];
    if (name.empty()) {
      ok = refuse("column " + std::to_string(i + 1) + " has no name");
    } else if (ParseNumber(name)) {
      ok = refuse("must name the columns, got " + name + " for column " + std::to_string(i + 1));
    } else if (!seen.insert(name).second) {
      ok = refuse("column " + Printable(name) + " is given twice");
    }
  }
  return ok;
}

void ReadRow(const std::vector<std::string>& cells, int line, CsvTable& table, ErrorList& errors) {
  if (cells.size() != table.columns.size()) {
    const std::string more = cells.size() > CsvLimits::kColumns ? "more than " : "";
    const std::size_t count = std::min(cells.size(), CsvLimits::kColumns);
    errors.Add(table.file, line, "",
               "has " + more + std::to_string(count) + " values, but the header names " +
                   std::to_string(table.columns.size()) + " columns");
    return;
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::optional<double> value = ParseNumber(cells[i]);
    table.values[i].push_back(value.value_or(0.0));
    if (value) continue;
    const std::string got = cells[i].empty() ? "nothing" : "'" + Printable(cells[i]) + "'";
    errors.Add(table.file, line, Printable(table.columns[i]),
               NumberRule(cells[i], /*quoted=*/false, table.columns[i]) + ", got " + got);
  }
  table.row_lines.push_back(line);
}

}  // namespace

const std::vector<double>* CsvTable::Column(const std::string& name, ErrorList& errors) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found != columns.end()) return &values[static_cast<std::size_t>(found - columns.begin())];
  errors.Add(file, header_line, "", "has no column " + name + KeyHint(name, columns, "column"));
  return nullptr;
}

CsvTable ReadCsvTable(const std::string& file, ErrorList& errors) {
  CsvTable table;
  table.file = DisplayPath(file);
  const std::optional<std::string> text = ReadTextFile(file, CsvLimits::kBytes, errors);
  if (!text) return table;

  constexpr const char* kByteOrderMark = "\xEF\xBB\xBF";
  std::size_t begin = text->compare(0, 3, kByteOrderMark) == 0 ? 3 : 0;
  for (int line = 1; begin < text->size(); ++line) {
    const std::size_t end = std::min(text->find('\n', begin), text->size());
    const std::string content = Trimmed(text->substr(begin, end - begin));
    begin = end + 1;
    if (content.empty() || content[0] == '#') continue;
    if (table.header_line == 0) {
      table.header_line = line;
      table.columns = Cells(content);
      if (!CheckHeader(table, errors)) return table;
      table.values.resize(table.columns.size());
      continue;
    }
    if ((table.row_lines.size() + 1) * table.columns.size() > CsvLimits::kValues) {
      errors.Add(table.file, line, "",
                 "exceeds the limit of " + std::to_string(CsvLimits::kValues) + " values");
      return table;
    }
    ReadRow(Cells(content), line, table, errors);
    if (errors.full()) return table;
  }
  if (table.header_line == 0) {
    errors.Add(table.file, 0, "", "is empty: a table begins with a line that names its columns");
  } else if (table.row_lines.empty() && errors.empty()) {
    errors.Add(table.file, table.header_line, "", "names columns, but no line of numbers follows");
  }
  return table;
}

}  // namespace strict_config
