#include "strict_config/csv_table.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "strict_config/scalar.h"
#include "strict_config/suggestion.h"
#include "strict_config/text_file.h"
#include "strict_config/yaml_tree.h"

namespace strict_config {
namespace {

constexpr std::size_t kListedColumns = 12;  ///< in a message: a table may have one for each vehicle

constexpr const char* kNoteColumn = "note";

std::string Trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/// Where the cell that begins at `begin` ends: at its separator, or at the end of the line. A quote is only
/// one at the begin of a cell.
std::size_t EndOfCell(const std::string& line, std::size_t begin, char separator) {
  const std::size_t first = line.find_first_not_of(" \t", begin);
  if (first == std::string::npos || line[first] != '"' || separator == '"')
    return std::min(line.find(separator, begin), line.size());
  std::size_t i = first + 1;
  for (; i < line.size(); ++i) {
    if (line[i] != '"') continue;
    if (i + 1 < line.size() && line[i + 1] == '"') {
      ++i;
    } else {
      break;
    }
  }
  return std::min(line.find(separator, i), line.size());
}

/// What is in a trimmed cell, or nothing if its quotes are wrong.
std::optional<std::string> Unquoted(const std::string& cell) {
  if (cell.empty() || cell[0] != '"') return cell;
  std::string text;
  for (std::size_t i = 1; i < cell.size(); ++i) {
    if (cell[i] != '"') {
      text += cell[i];
    } else if (i + 1 < cell.size() && cell[i + 1] == '"') {
      text += cell[++i];
    } else {
      return i + 1 == cell.size() ? std::optional<std::string>(Trimmed(text)) : std::nullopt;
    }
  }
  return std::nullopt;
}

/// The lines of a table one after the other, as cells.
class CsvLines {
 public:
  CsvLines(std::string file, std::string text, ErrorList& errors)
      : file_(std::move(file)), text_(std::move(text)), errors_(errors) {
    constexpr const char* kByteOrderMark = "\xEF\xBB\xBF";
    if (text_.compare(0, 3, kByteOrderMark) == 0) next_ = 3;
  }

  /// Moves to the next line that holds cells; false when there is none.
  bool Next() {
    while (next_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', next_), text_.size());
      const std::string content = text_.substr(next_, end - next_);
      next_ = end + 1;
      ++line_;
      const std::size_t first = content.find_first_not_of(" \t\r");
      if (first == std::string::npos || content[first] == '#') continue;
      if (separator_ == '\0') separator_ = SeparatorOf(content);
      Split(content);
      const bool is_empty = !is_bad_ && cells_.size() <= CsvLimits::kColumns &&
                            std::all_of(cells_.begin(), cells_.end(), [](const auto& cell) { return cell.empty(); });
      if (!is_empty) return true;  // ",,": a row that was deleted in a spreadsheet
    }
    return false;
  }

  /// Whether the line has wrong quotes, which has been reported.
  bool is_bad() const { return is_bad_; }

  /// Whether the line has too many cells because commas separate both cells and decimals: "0,5,100,25" in two columns.
  bool HasDecimalCommas(std::size_t columns) const {
    const auto is_whole = [](const std::string& cell) {
      const std::size_t first = cell.find_first_not_of("+-");
      return first != std::string::npos && cell.find_first_not_of("0123456789", first) == std::string::npos;
    };
    return separator_ == ',' && cells_.size() > columns && cells_.size() <= 2 * columns &&
           std::all_of(cells_.begin(), cells_.end(), is_whole);
  }

  int line() const { return line_; }
  const std::vector<std::string>& cells() const { return cells_; }  ///< at most one more than a table may have

 private:
  static char SeparatorOf(const std::string& header) {
    for (const char separator : {',', ';', '\t'}) {
      if (EndOfCell(header, 0, separator) < header.size()) return separator;
    }
    return ',';
  }

  void Split(const std::string& content) {
    cells_.clear();
    is_bad_ = false;
    for (std::size_t begin = 0; begin <= content.size() && cells_.size() <= CsvLimits::kColumns;) {
      const std::size_t end = EndOfCell(content, begin, separator_);
      const std::string cell = Trimmed(content.substr(begin, end - begin));
      const std::optional<std::string> text = Unquoted(cell);
      if (!text && !is_bad_) {
        is_bad_ = true;
        errors_.Add(file_, line_, "",
                    "has a quote that does not end, or text behind its end: " + Printable(cell) +
                        " (a quote within quotes is written twice)");
      }
      cells_.push_back(text.value_or(""));
      begin = end + 1;
    }
  }

  std::string file_, text_;
  ErrorList& errors_;
  std::size_t next_ = 0;
  int line_ = 0;
  char separator_ = '\0';
  std::vector<std::string> cells_;
  bool is_bad_ = false;
};

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

/// Reads the header and calls row(cells, line) for each line behind it, with as many cells as there are columns.
/// @return whether the header is right and some row was read
template <class Row>
bool ReadRows(const std::string& file, CsvTable& table, ErrorList& errors, const Row& row) {
  table.file = DisplayPath(file);
  std::optional<std::string> text = ReadTextFile(file, CsvLimits::kBytes, errors);
  if (!text) return false;
  CsvLines lines(table.file, *std::move(text), errors);
  if (!lines.Next()) {
    errors.Add(table.file, 0, "", "is empty: a table begins with a line that names its columns");
    return false;
  }
  table.header_line = lines.line();
  table.columns = lines.cells();
  if (lines.is_bad()) return false;
  // A separator at the end of the header, as spreadsheets write it.
  const bool is_closed =
      table.columns.size() > 1 && table.columns.size() <= CsvLimits::kColumns && table.columns.back().empty();
  if (is_closed) table.columns.pop_back();
  if (!CheckHeader(table, errors)) return false;
  const std::size_t columns = table.columns.size();
  std::size_t rows = 0;
  while (!errors.full() && lines.Next()) {
    if (lines.is_bad()) continue;
    if ((++rows) * columns > CsvLimits::kValues) {
      errors.Add(table.file, lines.line(), "",
                 "exceeds the limit of " + std::to_string(CsvLimits::kValues) + " values");
      return false;
    }
    const std::vector<std::string>& cells = lines.cells();
    const bool row_is_closed = cells.size() == columns + 1 && columns < CsvLimits::kColumns && cells.back().empty();
    if (cells.size() == columns || row_is_closed) {
      row(cells, lines.line());
      continue;
    }
    const std::string more = cells.size() > CsvLimits::kColumns ? "more than " : "";
    const std::string hint =
        lines.HasDecimalCommas(columns) ? "; decimals take a point, or a table another separator (';')" : "";
    errors.Add(table.file, lines.line(), "",
               "has " + more + std::to_string(std::min(cells.size(), CsvLimits::kColumns)) +
                   " values, but the header names " + std::to_string(columns) + " columns" + hint);
  }
  return rows > 0;
}

}  // namespace

const std::vector<double>* CsvTable::Column(const std::string& name, ErrorList& errors) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found != columns.end()) return &values[static_cast<std::size_t>(found - columns.begin())];
  errors.Add(file, header_line, "", "has no column " + name + KeyHint(name, columns, "column", kListedColumns));
  return nullptr;
}

CsvTable ReadCsvTable(const std::string& file, ErrorList& errors) {
  CsvTable table;
  const auto add_row = [&](const std::vector<std::string>& cells, int line) {
    table.values.resize(table.columns.size());
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      const std::optional<double> value = ParseNumber(cells[i]);
      table.values[i].push_back(value.value_or(0.0));
      if (value) continue;
      const std::string got = cells[i].empty() ? "nothing" : "'" + Printable(cells[i]) + "'";
      errors.Add(table.file, line, Printable(table.columns[i]),
                 NumberRule(cells[i], /*quoted=*/false, table.columns[i]) + ", got " + got);
    }
    table.row_lines.push_back(line);
  };
  if (!ReadRows(file, table, errors, add_row) && errors.empty())
    errors.Add(table.file, table.header_line, "", "names columns, but no line of numbers follows");
  return table;
}

NodePtr ReadCsvList(const std::string& file, const std::shared_ptr<const Document>& document, ErrorList& errors) {
  const std::size_t errors_before = errors.reports();
  CsvTable table;
  auto list = std::make_shared<Node>();
  list->kind = Node::Kind::kList;
  const auto add_row = [&](const std::vector<std::string>& cells, int line) {
    auto map = std::make_shared<Node>();
    map->kind = Node::Kind::kMap;
    map->source = {document, line};
    map->is_row = true;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      if (cells[i].empty() || table.columns[i] == kNoteColumn) continue;
      auto value = std::make_shared<Node>();
      value->kind = Node::Kind::kScalar;
      value->source = map->source;
      value->text = cells[i];
      map->entries.push_back({table.columns[i], {document, table.header_line}, std::move(value)});
    }
    list->items.push_back(std::move(map));
  };
  const bool has_rows = ReadRows(file, table, errors, add_row);
  list->source = {document, table.header_line};
  if (errors.reports() != errors_before) return nullptr;
  if (has_rows) return list;
  list->source.Report(errors, "", "names columns, but no row follows");
  return nullptr;
}

}  // namespace strict_config
