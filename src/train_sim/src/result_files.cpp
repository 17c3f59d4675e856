#include <string>

#include "train_console/console.h"
#include "train_results/result_tables.h"
#include "train_sim/keys_command.h"

namespace train_sim {
namespace {

using train_results::ResultColumn;

/// A name of every column of a meaning, or the first and the last of many.
std::string Names(const std::vector<ResultColumn>& columns, std::size_t first, std::size_t end) {
  const std::string& name = columns[first].name;
  const std::size_t place = name.find("{}");
  if (place != std::string::npos) {
    const auto number = [&](const char* text) { return "`" + std::string(name).replace(place, 2, text) + "`"; };
    return number("1") + ", " + number("2") + ", ...";
  }
  std::string names;
  for (std::size_t i = first; i < end; ++i) names += (names.empty() ? "`" : ", `") + columns[i].name + "`";
  return names;
}

void PrintColumns(const std::vector<ResultColumn>& columns, const char* title) {
  train_console::Print("| {} | unit | meaning |\n|---|---|---|\n", title);
  for (std::size_t i = 0, end = 0; i < columns.size(); i = end) {
    const auto is_same = [&](const ResultColumn& other) {
      return other.meaning == columns[i].meaning && other.unit == columns[i].unit;
    };
    while (end < columns.size() && (end <= i || is_same(columns[end]))) ++end;
    std::string meaning;
    for (const char c : columns[i].meaning) meaning += c == '|' ? "\\|" : std::string(1, c);
    train_console::Print("| {} | {} | {} |\n", Names(columns, i, end), columns[i].unit, meaning);
  }
}

}  // namespace

void PrintResultFiles() {
  train_console::Print(
      "# What a run leaves\n\n"
      "Made by `train_sim keys --results` from the lists by which the files are written; do not edit it. "
      "`make "
      "reference`\n"
      "renews it. Names end in their unit. Tables are CSV: one line of names, columns separated by commas, "
      "`nan` "
      "for what is\n"
      "not known. What reads them into arrays: [analysis.md](analysis.md); tables of a study: "
      "[studies.md](studies.md#many-runs).\n\n"
      "## Files\n\n"
      "| file | what it holds |\n|---|---|\n");
  for (const train_results::ResultFile& file : train_results::ResultFiles())
    train_console::Print("| `{}` | {} |\n", file.name, file.meaning);
  train_console::Print("\n## Tables\n");
  for (const train_results::ResultTable& table : train_results::ResultTables()) {
    train_console::Print("\n### {}\n\nWritten {}.\n\n", table.file, table.meaning);
    PrintColumns(table.columns, "column");
  }
  train_console::Print(
      "\n## summary.json\n\n"
      "`a.b`: b within the map a; `a[].b`: b of each map in the list a; `a.*`: names that depend on the "
      "train. What "
      "does not\n"
      "exist is null. A study names its results so, without those of lists.\n\n");
  PrintColumns(train_results::SummaryFields(), "number");
}

}  // namespace train_sim
