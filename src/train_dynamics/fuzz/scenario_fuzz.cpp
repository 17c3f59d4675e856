// A scenario as text, which is how a wagon node gets it: read, written, read again; then its train moves.

#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>

#include "fuzz.h"
#include "strict_config/reader.h"
#include "strict_config/writer.h"
#include "train_dynamics/train/in_process_train.h"
#include "train_dynamics/train/train_master.h"

namespace train_dynamics {
namespace {

ScenarioParams Read(const std::string& text, strict_config::ErrorList& errors) {
  return strict_config::LoadText<ScenarioParams>(text, "scenario", errors);
}

/// A few exchanges of a train that is not too large for a fuzzer.
void Move(const ScenarioParams& scenario) {
  const Consist consist(scenario.train);
  if (consist.vehicles() > 20 || scenario.StepsPerExchange() > 100 || !scenario.pressure_table.empty()) return;
  try {
    InProcessTransport vehicles(scenario, consist, 1);
    TrainMaster master(scenario, consist, vehicles, MakeBrakeSystem(scenario, consist));
    master.Start();
    for (int exchange = 0; exchange < 3 && !master.Done(); ++exchange) master.Exchange();
  } catch (const std::exception&) {  // parameters of which no vehicle or brake can be made, or a fault
  }
}

}  // namespace
}  // namespace train_dynamics

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace train_dynamics;
  strict_config::ErrorList errors;
  const ScenarioParams scenario = Read({reinterpret_cast<const char*>(data), size}, errors);
  train_brake_build::fuzz::Require(errors.empty() == errors.Text().empty(), "an error has a text");
  if (!errors.empty()) return 0;

  const std::string written = strict_config::Write(scenario);
  const ScenarioParams again = Read(written, errors);
  train_brake_build::fuzz::Require(errors.empty() && strict_config::Write(again) == written,
                                   "what is written reads back the same");
  Move(scenario);
  return 0;
}
