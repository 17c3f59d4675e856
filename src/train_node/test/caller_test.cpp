#include "train_node/caller.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace train_node {
namespace {

TEST(Caller, HomeIsExpandedAtTheBeginningOfAPathOnly) {
  setenv("HOME", "/home/anna", 1);
  EXPECT_EQ("/home/anna", ExpandHome("~"));
  EXPECT_EQ("/home/anna/my stop", ExpandHome("~/my stop"));
  for (const char* same : {"", "runs/a", "/tmp/~", "./~/a", "a~"}) EXPECT_EQ(same, ExpandHome(same));
  EXPECT_THROW(ExpandHome("~bert/runs"), std::invalid_argument);
  unsetenv("HOME");
  EXPECT_THROW(ExpandHome("~/runs"), std::invalid_argument);
}

TEST(Caller, RelativePathsAreThoseOfTheCallersFolder) {
  const std::filesystem::path before = std::filesystem::current_path();
  unsetenv(kCallerFolder);
  EnterCallerFolder();
  EXPECT_EQ(before, std::filesystem::current_path());
  setenv(kCallerFolder, "/usr/lib", 1);
  EnterCallerFolder();
  EXPECT_EQ("/usr/lib", std::filesystem::current_path());
  setenv(kCallerFolder, "/no/such/folder", 1);
  EXPECT_THROW(EnterCallerFolder(), std::invalid_argument);
  std::filesystem::current_path(before);
}

}  // namespace
}  // namespace train_node
