// A configuration of several files with overrides, as a user gives it to train_sim. The input's sections, separated by
// bytes 0x1E, are: overrides (one per line), the scenario file, a part "p" of any kind, and a pressure table "t.csv".

#include <stdlib.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fuzz.h"
#include "strict_config/error_list.h"
#include "train_dynamics/config/load_scenario.h"

namespace {

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const train_brake_build::fuzz::Scratch folder;
  setenv("TRAIN_BRAKE_CONFIG", TRAIN_BRAKE_CONFIG_DIR, 1);
  std::vector<std::string> sections = Split({reinterpret_cast<const char*>(data), size}, '\x1e');
  sections.resize(4);
  const std::string file = folder.Put("scenarios/s.yaml", sections[1]);
  for (const char* kind : {"trains", "vehicles", "couplers", "brakes", "tracks", "adhesion", "slide_protection"}) {
    folder.Put(std::string(kind) + "/p.yaml", sections[2]);
  }
  folder.Put("scenarios/t.csv", sections[3]);
  try {
    train_dynamics::config::LoadScenario(file, Split(sections[0], '\n'));
  } catch (const strict_config::Error& error) {
    train_brake_build::fuzz::Require(*error.what() != '\0', "an error has a text");
  }
  return 0;
}
