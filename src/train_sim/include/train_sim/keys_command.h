#pragma once

#include <string>

namespace train_sim {

struct KeysOptions {
  std::string path;         ///< of which keys; empty: all
  bool markdown = false;    ///< the page docs/configuration.md
  bool results = false;     ///< the page docs/result_files.md
  bool kinds = false;       ///< only the names of the kinds of files
  std::string schema_kind;  ///< print the JSON schema of this kind of file; empty: none
};

/// Prints the page on the results of a run: its files, the columns of its tables, the numbers of summary.json.
void PrintResultFiles();

/// Prints the keys of configuration files: unit, rule, default, meaning, example, from the lists with which they are
/// read.
///
/// Examples are looked for in the folders of TRAIN_BRAKE_CONFIG.
/// @throws std::invalid_argument where the path names no key
int PrintKeys(const KeysOptions& options);

}  // namespace train_sim
