#include "train_sim/key_examples.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "strict_config/csv_table.h"
#include "strict_config/error_list.h"
#include "strict_config/part_library.h"
#include "strict_config/yaml_tree.h"
#include "train_dynamics/config/load_scenario.h"

namespace train_sim {
namespace {

namespace fs = std::filesystem;
using strict_config::ErrorList;
using strict_config::KeyDescription;
using strict_config::Node;
using strict_config::NodePtr;
using train_dynamics::config::FileKind;
using Examples = std::map<std::string, KeyExample>;

constexpr std::size_t kLongest = 60;  ///< letters of an example

/// Of keys that no shipped file has, by the end of their path.
const std::pair<const char*, const char*> kMade[] = {
    {"scenario.pressure_table", "pressures.csv"},
    {"scenario.commands.exchange", "12000"},
    {"commands.vehicles", "[1, -1]"},
    {"commands.pressure_kpa", "200"},
    {"commands.group", "helper"},
    {"brake.sources.radio_lost_from_s", "30"},
    {"brake.sources.radio_lost_to_s", "90"},
    {"commands.from_m", "1200"},
    {"commands.to_m", "1500"},
    {"commands.friction_coefficient", "0.05"},
    {"driver.speed_kmh", "60"},
    {"driver.stops.position_m", "12000"},
    {"consist.external", "wagon_003"},
    {"consist.name", "helper"},
    {"consist.initial_slack", "bunched"},
    {"consist.trapped_cylinder_pressure_kpa", "300"},
    {"speed_above_kmh", "40"},
    {"speed_below_kmh", "30"},
    {"until.position_m", "3000"},
    {"sources.commands.time_s", "20"},
    {"sources.commands.reduction_kpa", "70"},
    {"load.cg_height_m", "2.2"},
    {"load.pitch_inertia_kgm2", "800000"},
    {"cylinder.piston_area_m2", "0.0507"},
    {"cylinder.leverage_ratio", "8"},
    {"cylinder.efficiency", "0.9"},
    {"net_braking_ratio.ratio", "0.11"},
    {"net_braking_ratio.at_pressure_kpa", "345"},
    {"breakaway.constant_n_per_kn", "5"},
    {"load_sensing.full_mass_kg", "120000"},
    {"load_sensing.changeover_mass_kg", "60000"},
    {"shoe_friction.table.speed_kmh", "[0, 40, 100]"},
    {"curves.shoe_load_kn", "20"},
    {"curves.friction_coefficient", "[0.36, 0.3, 0.25]"},
    {"curving_resistance.table.radius_m", "[200, 500, 1000]"},
    {"curving_resistance.table.resistance_n_per_t", "[31, 12, 6]"},
    {"tractive_effort.table.speed_kmh", "[0, 20, 80]"},
    {"tractive_effort.table.effort_n", "[300000, 290000, 75000]"},
    {"driven_wheelsets", "[1, 2]"},
    {"friction_patches.ramp_length_m", "2"},
    {"points.position_m", "1500"},
    {"points.grade_percent", "-0.4"},
    {"points.height_m", "412"},
    {"points.friction_coefficient", "0.1"},
    {"closed_angle_cocks", "[50]"},
};

bool EndsWith(const std::string& path, const std::string& end) {
  return path.size() > end.size() && path.compare(path.size() - end.size(), end.size(), end) == 0 &&
         path[path.size() - end.size() - 1] == '.';
}

/// A scalar or a list of scalars on one line, or nothing.
std::optional<std::string> Inline(const Node& node) {
  if (node.kind == Node::Kind::kScalar) return node.quoted ? "\"" + node.text + "\"" : node.text;
  if (node.kind != Node::Kind::kList || node.items.empty()) return std::nullopt;
  std::string text;
  for (const NodePtr& item : node.items) {
    if (item->kind != Node::Kind::kScalar) return std::nullopt;
    text += (text.empty() ? "" : ", ") + item->text;
  }
  return "[" + text + "]";
}

class Collector {
 public:
  Collector(const std::vector<FileKind>& kinds, Examples& examples) : kinds_(kinds), examples_(examples) {}

  /// @param within  parts written in place are taken too
  void TakeFile(const FileKind& kind, const fs::path& file, bool within) {
    ErrorList unread;
    strict_config::PartLibrary library({}, unread);
    file_ = kind.folder + "/" + file.filename().string();
    within_ = within;
    if (file.extension() != ".csv") {
      if (const NodePtr root = library.Open(file, "")) TakeMap(*root, kind.keys, kind.name);
      return;
    }
    // A table is a list of a kind, as `points` of a track or `consist` of a train: of the one whose keys are its
    // columns.
    const fs::path whole = fs::absolute(file);
    const auto document = std::make_shared<const strict_config::Document>(
        strict_config::Document{file_, whole.parent_path(), whole.parent_path()});
    const NodePtr rows = strict_config::ReadCsvList(whole.string(), document, unread);
    if (!rows) return;
    for (const KeyDescription& key : kind.keys) {
      if (key.IsListOfMaps()) TakeBelow(*rows, key, kind.name + "." + key.key);
    }
  }

  /// Examples of keys that no file has and that have no default: from the same keys elsewhere in the kind, or made.
  void FillIn(const std::vector<KeyDescription>& keys, const std::string& path) {
    for (const KeyDescription& key : keys) {
      const std::string below = path + "." + key.key;
      FillIn(key.keys, below);
      const bool has_default = !key.default_value.empty() && key.default_value != "[]";
      const bool needs_none = key.IsMap() || key.IsListOfMaps() || has_default || examples_.count(below) > 0;
      if (needs_none) continue;
      for (const auto& [end, value] : kMade) {
        if (below == end || EndsWith(below, end)) examples_.try_emplace(below, KeyExample{value, ""});
      }
      const std::string kind = below.substr(0, below.find('.') + 1);
      // The longest end of the path that another one has, too.
      std::size_t begin = below.find('.');
      while (examples_.count(below) == 0 && (begin = below.find('.', begin + 1)) != std::string::npos) {
        const std::string end = below.substr(begin + 1);
        if (end.find('.') == std::string::npos) break;  // the key alone may mean something else
        for (const auto& [other, example] : examples_) {
          if (other.rfind(kind, 0) == 0 && EndsWith(other, end)) {
            examples_.emplace(below, example);
            break;
          }
        }
      }
    }
  }

 private:
  void TakeMap(const Node& map, const std::vector<KeyDescription>& keys, const std::string& path) {
    for (const strict_config::Entry& entry : map.entries) {
      const auto key =
          std::find_if(keys.begin(), keys.end(), [&entry](const KeyDescription& k) { return k.key == entry.key; });
      if (key == keys.end()) continue;
      const std::string below = path + "." + key->key;
      if (const std::optional<std::string> text = Inline(*entry.value); text && text->size() <= kLongest)
        examples_.try_emplace(below, KeyExample{*text, file_});
      TakeBelow(*entry.value, *key, below);
    }
  }

  void TakeBelow(const Node& value, const KeyDescription& key, const std::string& path) {
    if (value.kind == Node::Kind::kList) {
      for (const NodePtr& item : value.items) TakeBelow(*item, key, path);
    } else if (value.kind == Node::Kind::kMap && !key.IsPart()) {
      TakeMap(value, key.keys, path);
    } else if (value.kind == Node::Kind::kMap && within_) {
      for (const FileKind& kind : kinds_) {
        if (kind.folder == key.folder) TakeMap(value, kind.keys, kind.name);
      }
    }
  }

  const std::vector<FileKind>& kinds_;
  Examples& examples_;
  std::string file_;
  bool within_ = false;
};

std::vector<fs::path> FilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".yaml" || entry.path().extension() == ".csv") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

Examples FindExamples(const std::vector<FileKind>& kinds) {
  Examples examples;
  Collector collector(kinds, examples);
  // Files of the kind itself first, then what others have written in place.
  for (const bool within : {false, true}) {
    for (const FileKind& kind : kinds) {
      for (const fs::path& root : train_dynamics::config::PartFolders()) {
        for (const fs::path& file : FilesIn(root / kind.folder)) collector.TakeFile(kind, file, within);
      }
    }
  }
  for (const FileKind& kind : kinds) collector.FillIn(kind.keys, kind.name);
  return examples;
}

}  // namespace train_sim
