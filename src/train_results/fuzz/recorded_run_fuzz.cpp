// A bag, which may be damaged or forged: all messages of its run are read.

#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>

#include "fuzz.h"
#include "train_results/recorded_run.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const train_brake_build::fuzz::Scratch folder;
  try {
    train_results::RecordedRun run(folder.Put("train.bag", {reinterpret_cast<const char*>(data), size}), "");
    run.Scenario();
    for (train_results::RecordedTopic* topic : {&run.state(), run.forces(), run.pressures(), run.ledger()}) {
      while (topic != nullptr && !topic->done()) topic->Advance();
    }
  } catch (const train_results::UnreadableBag& e) {
    train_brake_build::fuzz::Require(*e.what() != '\0', "an error has a text");
  }
  return 0;
}
