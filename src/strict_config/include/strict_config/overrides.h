#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "strict_config/error_list.h"
#include "strict_config/yaml_tree.h"

namespace strict_config {

/// One `path=value` of the command line.
struct Override {
  std::string path;  ///< "train.coupler.slack_m", "commands[0].time_s", after the name of the root
  NodePtr value;
  bool used = false;
};

/// The values that replace what the files say, matched by path as the reader descends, after references are
/// resolved. Of several for one path the last one applies.
class Overrides {
 public:
  /// @param arguments    "path=value", the value a YAML scalar or a list or map in flow style
  /// @param search_from  where names in the values are looked for
  /// @param root_name    with which paths begin in messages, but not in the arguments; may be empty
  Overrides(const std::vector<std::string>& arguments, const std::filesystem::path& search_from,
            const std::string& root_name, ErrorList& errors);

  /// The value given for exactly this path, or null. Marks it as used.
  NodePtr Take(const std::string& path);
  /// The unused ones below this path, by key or index.
  std::vector<Override*> Below(const std::string& path);
  /// The overrides that have not been used.
  std::vector<const Override*> Unused() const;

 private:
  std::vector<Override> overrides_;
};

}  // namespace strict_config
