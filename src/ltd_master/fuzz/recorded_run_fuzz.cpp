// A bag, which may be damaged or forged: all messages of its run are read.

#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>

#include "../../train_dynamics/fuzz/fuzz.h"
#include "ltd_master/recorded_run.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const train_dynamics::fuzz::Scratch folder;
  try {
    ltd_master::RecordedRun run(folder.Put("train.bag", {reinterpret_cast<const char*>(data), size}), "");
    run.Scenario();
    for (ltd_master::RecordedTopic* topic : {&run.state(), run.forces(), run.pressures(), run.ledger()}) {
      while (topic != nullptr && !topic->done()) topic->Advance();
    }
  } catch (const ltd_master::UnreadableBag& e) {
    train_dynamics::fuzz::Require(*e.what() != '\0', "whoever complains has something to say");
  }
  return 0;
}
