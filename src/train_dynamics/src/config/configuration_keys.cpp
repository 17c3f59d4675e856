#include "train_dynamics/config/configuration_keys.h"

#include <algorithm>
#include <map>
#include <utility>

#include "train_dynamics/train/scenario.h"

namespace train_dynamics::config {
namespace {

using strict_config::KeyDescription;

/// "vehicle" of the folder "vehicles"; folders of what cannot be counted are named as it is.
std::string NameOf(const std::string& folder) {
  return folder.back() == 's' ? folder.substr(0, folder.size() - 1) : folder;
}

/// What files of a folder hold.
std::string MeaningOf(const std::string& folder, const std::string& otherwise) {
  static const std::map<std::string, std::string> kMeanings{
      {"trains", "vehicles from front to rear, and what joins them"},
      {"vehicles", "a wagon or a locomotive"},
      {"couplers", "what joins two vehicles"},
      {"brakes", "a brake system, from the driver's commands to cylinder pressures"},
      {"traction", "what makes a locomotive of a vehicle"},
      {"tracks", "a route by position: grades, curves, limits, rail surfaces"},
      {"adhesion", "adhesion between wheel and rail"},
      {"slide_protection", "wheel-slide protection"}};
  const auto known = kMeanings.find(folder);
  return known == kMeanings.end() ? otherwise : known->second;
}

/// Moves the keys of parts into kinds of their own.
void TakeParts(std::vector<KeyDescription>& keys, std::vector<FileKind>& kinds) {
  for (KeyDescription& key : keys) {
    std::vector<KeyDescription> below = std::exchange(key.keys, {});
    if (!key.IsPart()) {
      TakeParts(below, kinds);
      key.keys = std::move(below);
      continue;
    }
    const bool is_known =
        std::any_of(kinds.begin(), kinds.end(), [&key](const FileKind& kind) { return kind.folder == key.folder; });
    if (is_known) continue;
    const std::size_t index = kinds.size();
    kinds.push_back({NameOf(key.folder), key.folder, MeaningOf(key.folder, key.meaning), key.may_be_table, {}});
    TakeParts(below, kinds);
    kinds[index].keys = std::move(below);
  }
}

}  // namespace

std::vector<FileKind> ConfigurationKeys() {
  std::vector<FileKind> kinds{{"scenario", "scenarios", "all that a run depends on", false, {}}};
  std::vector<KeyDescription> keys = strict_config::DescribeKeys<ScenarioParams>();
  TakeParts(keys, kinds);
  kinds.front().keys = std::move(keys);
  return kinds;
}

}  // namespace train_dynamics::config
