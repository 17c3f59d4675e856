#include "train_node/caller.h"

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <system_error>

namespace train_node {

void EnterCallerFolder() {
  const char* const folder = std::getenv(kCallerFolder);
  if (folder == nullptr || *folder == '\0') return;
  std::error_code error;
  std::filesystem::current_path(folder, error);
  if (error) {
    throw std::invalid_argument(std::string("cannot enter the folder in which roslaunch was called, ") + folder + ": " +
                                error.message());
  }
}

std::string ExpandHome(const std::string& path) {
  if (path.empty() || path.front() != '~') return path;
  const char* const home = std::getenv("HOME");
  if (path.size() > 1 && path[1] != '/')
    throw std::invalid_argument(path + ": only ~/ is replaced by a home folder; write ./" + path +
                                " or the whole path");
  if (home == nullptr || *home == '\0')
    throw std::invalid_argument(path + ": the environment variable HOME is not set; write the whole path");
  return home + path.substr(1);
}

}  // namespace train_node
