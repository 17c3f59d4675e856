#include "train_sim/keys_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <stdexcept>
#include <vector>

#include "strict_config/scalar.h"
#include "strict_config/suggestion.h"
#include "train_console/console.h"
#include "train_run/exit_code.h"
#include "train_sim/json_schema.h"
#include "train_sim/key_examples.h"

namespace train_sim {
namespace {

using strict_config::KeyCondition;
using strict_config::KeyDescription;
using train_dynamics::config::FileKind;
using Kind = KeyDescription::Kind;

/// A table that is read beside configuration files.
struct CsvColumn {
  const char *name, *meaning;
};
constexpr const char* kPressureTable =
    "The file that `scenario.pressure_table` names: cylinder pressures over time, linear between rows, held "
    "before the "
    "first and behind the last.";
constexpr CsvColumn kPressureColumns[] = {
    {"time_s", "time, ascending"},
    {"vehicle_1_pa, vehicle_2_pa, ...",
     "gauge pressure of each vehicle's brake cylinder, a column for every vehicle of the train"},
};

std::string Unit(const KeyDescription& key) { return strict_config::SplitUnit(key.key).unit; }

std::string Joined(const std::vector<std::string>& words, const char* separator) {
  return fmt::format("{}", fmt::join(words, separator));
}

/// What may be written, in a few words.
std::string Rule(const KeyDescription& key) {
  const auto without_must_be = [&key] {
    const std::string rule = key.range.Rule();
    constexpr const char kMustBe[] = "must be ";
    return rule.rfind(kMustBe, 0) == 0 ? rule.substr(sizeof kMustBe - 1) : rule;
  };
  switch (key.kind) {
    case Kind::kNumber:
      return without_must_be();
    case Kind::kInteger:
      return "whole, " + without_must_be();
    case Kind::kFlag:
      return "true or false";
    case Kind::kText:
      return "text";
    case Kind::kChoice:
      return Joined(key.choices, ", ");
    case Kind::kNumbers:
      return "list, each " + without_must_be();
    case Kind::kIntegers:
      return "list, each whole, " + without_must_be();
    case Kind::kGroup:
      return "map";
    case Kind::kList:
      return "list of maps, or a CSV file";
    case Kind::kPart:
      return fmt::format("name from {}/, file{}, or map", key.folder, key.may_be_table ? " (also CSV)" : "");
    case Kind::kParts:
      return fmt::format("list of names from {}/, files or maps", key.folder);
  }
  return "";
}

std::string Conditions(const std::vector<KeyCondition>& conditions) {
  std::string text;
  for (const KeyCondition& condition : conditions) text += (text.empty() ? "" : ", ") + condition.Text();
  return text;
}

/// The default, or whether it must be given.
std::string Default(const KeyDescription& key) {
  if (!key.required_with.empty()) return "must be given with " + Conditions(key.required_with);
  if (!key.may_be_left_out) return "must be given";
  if (key.default_value == "[{}]") return "one with all defaults";
  return key.default_value == "[]" ? "" : key.default_value;
}

/// A key with its path.
struct Line {
  std::string path;
  const KeyDescription* key;
};

void Collect(const std::vector<KeyDescription>& keys, const std::string& path, std::vector<Line>& lines) {
  for (const KeyDescription& key : keys) {
    const std::string below = path + "." + key.key;
    lines.push_back({below, &key});
    Collect(key.keys, below + (key.IsListOfMaps() ? "[]" : ""), lines);
  }
}

std::vector<Line> LinesOf(const FileKind& kind) {
  std::vector<Line> lines;
  Collect(kind.keys, kind.name, lines);
  return lines;
}

std::string WithoutIndices(const std::string& path) {
  std::string text;
  bool in_brackets = false;
  for (const char c : path) {
    if (c == '[') in_brackets = true;
    if (!in_brackets) text += c;
    if (c == ']') in_brackets = false;
  }
  return text;
}

class Reference {
 public:
  Reference() : kinds_(train_dynamics::config::ConfigurationKeys()), examples_(FindExamples(kinds_)) {}

  const std::vector<FileKind>& kinds() const { return kinds_; }

  /// The kind with its keys below a path, which may lead through parts as that of `--set` does, or may be the end of a
  /// path only.
  std::vector<Line> Find(const std::string& asked) const {
    const std::string path = WithoutIndices(asked);
    std::vector<Line> found;
    for (const FileKind& kind : kinds_) {
      for (const Line& line : LinesOf(kind)) {
        if (IsAtOrBelow(line.path, path)) found.push_back(line);
      }
    }
    if (found.empty()) found = FindThroughParts(path);
    if (!found.empty()) return found;
    for (const FileKind& kind : kinds_) {
      for (const Line& line : LinesOf(kind)) {
        const std::string whole = WithoutIndices(line.path);
        const std::string end = "." + path;
        const bool ends_so =
            whole.size() > end.size() && whole.compare(whole.size() - end.size(), end.size(), end) == 0;
        if (!ends_so) continue;
        for (const Line& below : LinesOf(kind)) {
          if (IsAtOrBelow(below.path, whole)) found.push_back(below);
        }
      }
    }
    return found;
  }

  /// Reports a path that names no key.
  [[noreturn]] void Refuse(const std::string& path) const {
    std::vector<std::string> roots, near, all;
    const std::string above = path.substr(0, path.find_last_of('.'));
    for (const FileKind& kind : kinds_) {
      roots.push_back(kind.name);
      all.push_back(kind.name);
      for (const Line& line : LinesOf(kind)) {
        all.push_back(line.key->key);
        if (WithoutIndices(line.path) == above + "." + line.key->key) near.push_back(line.key->key);
      }
    }
    const std::string nearest =
        strict_config::Nearest(path.substr(path.find_last_of('.') + 1), near.empty() ? all : near);
    throw std::invalid_argument(path + " names no key; " + (nearest.empty() ? "" : "did you mean " + nearest + "? ") +
                                "kinds of files: " + Joined(roots, ", "));
  }

  std::string Example(const Line& line) const {
    const auto found = examples_.find(WithoutIndices(line.path));
    if (found == examples_.end()) return "";
    const auto& [value, file] = found->second;
    return file.empty() ? value : fmt::format("{} ({})", value, file);
  }

  void PrintText(const std::vector<Line>& lines) const {
    for (const Line& line : lines) {
      const KeyDescription& key = *line.key;
      const std::string unit = Unit(key), given = Default(key), example = Example(line);
      train_console::Print("{}{}\n", line.path, unit.empty() ? "" : "  [" + unit + "]");
      train_console::Print("    {}\n", key.meaning);
      train_console::Print("    {}{}{}\n", Rule(key),
                           given.empty()                 ? ""
                           : given.rfind("must", 0) == 0 ? "; " + given
                                                         : "; default " + given,
                           key.known_with.empty() ? "" : "; only with " + Conditions(key.known_with));
      if (!example.empty()) train_console::Print("    example: {}\n", example);
    }
  }

 private:
  static bool IsAtOrBelow(const std::string& path, const std::string& above) {
    const std::string whole = WithoutIndices(path);
    return whole == above || whole.rfind(above + ".", 0) == 0;
  }

  /// Of "train.connection.draft_gear.slack_m" or "scenario.train.connection...": what is behind the last part on the
  /// way.
  std::vector<Line> FindThroughParts(const std::string& path) const {
    for (const std::string& start : {std::string(), std::string("scenario.")}) {
      std::string rest = start + path;
      bool moved = true;
      while (moved) {
        moved = false;
        for (const FileKind& kind : kinds_) {
          for (const Line& line : LinesOf(kind)) {
            const std::string whole = WithoutIndices(line.path);
            if (!line.key->IsPart() || !(rest == whole || rest.rfind(whole + ".", 0) == 0)) continue;
            const auto part = std::find_if(kinds_.begin(), kinds_.end(),
                                           [&line](const FileKind& k) { return k.folder == line.key->folder; });
            if (rest == whole) return LinesOf(*part);
            rest = part->name + rest.substr(whole.size());
            moved = true;
            break;
          }
          if (moved) break;
        }
      }
      std::vector<Line> found;
      for (const FileKind& kind : kinds_) {
        for (const Line& line : LinesOf(kind)) {
          if (IsAtOrBelow(line.path, rest)) found.push_back(line);
        }
      }
      if (!found.empty()) return found;
    }
    return {};
  }

  std::vector<FileKind> kinds_;
  std::map<std::string, KeyExample> examples_;
};

/// Text within a cell of a table.
std::string Cell(const std::string& text) {
  std::string cell;
  for (const char c : text) cell += c == '|' ? "\\|" : std::string(1, c);
  return cell;
}

std::string Code(const std::string& text) { return text.empty() ? "" : "`" + text + "`"; }

void PrintMarkdown(const Reference& reference) {
  train_console::Print(
      "# Keys of configuration files\n\n"
      "Made by `train_sim keys --markdown` from the lists by which the files are read; do not edit it. `make "
      "reference`\n"
      "renews it. `train_sim keys PATH` prints a part of it: `train_sim keys vehicle.brake_rigging`, "
      "`train_sim keys slack_m`.\n\n"
      "A number has the unit that its key ends in. A default stands for a key that is left out. A key with a "
      "condition is\n"
      "known only where the condition holds. Where a part is named, its files are looked for as\n"
      "[trains_and_routes.md](trains_and_routes.md) tells; any part may start from another one of its kind, "
      "`base: NAME`, and\n"
      "change what it needs. Sources: [P] the paper, [S] a source that was seen, [M] from memory of the "
      "named publication,\n"
      "[A] an assumption.\n\n"
      "Editors that know the YAML language server complete and check these keys: the first line\n"
      "`# yaml-language-server: $schema=../schema/vehicle.schema.json` of a file names its schema, one of "
      "those in\n"
      "`config/schema/`; VS Code finds them for files in this workspace by itself. The schema knows types, "
      "bounds and conditions; `train_sim check` judges all "
      "rules.\n\n");
  for (const FileKind& kind : reference.kinds())
    train_console::Print("- [{}](#{}): {}\n", kind.name, kind.name, kind.meaning);
  train_console::Print("- [tables](#tables): CSV files\n");
  for (const FileKind& kind : reference.kinds()) {
    train_console::Print("\n## {}\n\nFiles in `{}/`{}: {}.\n\n", kind.name, kind.folder,
                         kind.may_be_table ? ", YAML or CSV" : "", kind.meaning);
    train_console::Print("| key | unit | value | default | meaning | example |\n|---|---|---|---|---|---|\n");
    for (const Line& line : LinesOf(kind)) {
      const KeyDescription& key = *line.key;
      const std::string given = Default(key);
      const std::string condition = key.known_with.empty() ? "" : "With " + Conditions(key.known_with) + ": ";
      train_console::Print("| `{}` | {} | {} | {} | {}{} | {} |\n", line.path.substr(kind.name.size() + 1), Unit(key),
                           Cell(Rule(key)), given.rfind("must", 0) == 0 ? Cell(given) : Code(Cell(given)), condition,
                           Cell(key.meaning), Cell(reference.Example(line)));
    }
  }
  train_console::Print(
      "\n## tables\n\n"
      "A list of maps may be a CSV file: the first line names the columns, each further line is one map. "
      "Columns are\n"
      "separated by commas, semicolons or tabs; a cell may stand in double quotes; an empty cell is a key "
      "that is not given;\n"
      "lines that start with `#`, and a column `note`, are left out. Hence `consist` of a train has the "
      "columns\n"
      "`vehicle`, `count`, `load_fraction`, ... of its entries, and a track may be a table of its "
      "`points`.\n\n"
      "{}\n\n| column | meaning |\n|---|---|\n",
      kPressureTable);
  for (const CsvColumn& column : kPressureColumns) train_console::Print("| `{}` | {} |\n", column.name, column.meaning);
}

}  // namespace

int PrintKeys(const KeysOptions& options) {
  if (options.results) {
    PrintResultFiles();
    return train_run::kSuccess;
  }
  if (options.kinds) {
    for (const FileKind& kind : train_dynamics::config::ConfigurationKeys()) train_console::Print("{}\n", kind.name);
    return train_run::kSuccess;
  }
  if (!options.schema_kind.empty()) {
    const std::vector<FileKind> kinds = train_dynamics::config::ConfigurationKeys();
    std::vector<std::string> names;
    for (const FileKind& kind : kinds) {
      names.push_back(kind.name);
      if (kind.name != options.schema_kind) continue;
      train_console::WriteOutput(JsonSchema(kind));
      return train_run::kSuccess;
    }
    throw std::invalid_argument("--json-schema must be one of " + Joined(names, ", ") + ", got " + options.schema_kind);
  }
  const Reference reference;
  if (options.markdown) {
    PrintMarkdown(reference);
  } else if (!options.path.empty()) {
    const std::vector<Line> lines = reference.Find(options.path);
    if (lines.empty()) reference.Refuse(options.path);
    reference.PrintText(lines);
  } else {
    for (const FileKind& kind : reference.kinds()) {
      train_console::Print("{}{}: {} (files in {}/)\n", &kind == &reference.kinds().front() ? "" : "\n", kind.name,
                           kind.meaning, kind.folder);
      reference.PrintText(LinesOf(kind));
    }
    train_console::Print("\npressure table (CSV)\n    {}\n", kPressureTable);
    for (const CsvColumn& column : kPressureColumns) train_console::Print("{}\n    {}\n", column.name, column.meaning);
  }
  return train_run::kSuccess;
}

}  // namespace train_sim
