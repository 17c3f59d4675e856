// A scenario as text, which is how a wagon node gets it: read, written, read again; then its train moves.

#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>

#include "fuzz.h"
#include "train_dynamics/config/reader.h"
#include "train_dynamics/config/writer.h"
#include "train_dynamics/train/in_process_train.h"
#include "train_dynamics/train/train_master.h"

namespace train_dynamics {
namespace {

ScenarioParams Read(const std::string& text, config::ErrorList& errors) {
  return config::LoadText<ScenarioParams>(text, "scenario", errors);
}

/// A few exchanges of a train that is not too large for a fuzzer.
void Move(const ScenarioParams& scenario) {
  const Consist consist(scenario.train);
  if (consist.vehicles() > 20 || scenario.StepsPerExchange() > 100 || !scenario.pressure_table.empty())
    return;
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
  config::ErrorList errors;
  const ScenarioParams scenario = Read({reinterpret_cast<const char*>(data), size}, errors);
  fuzz::Require(errors.empty() == errors.Text().empty(), "whoever complains has something to say");
  if (!errors.empty()) return 0;

  const std::string written = config::Write(scenario);
  const ScenarioParams again = Read(written, errors);
  fuzz::Require(errors.empty() && config::Write(again) == written, "what is written reads back the same");
  Move(scenario);
  return 0;
}
