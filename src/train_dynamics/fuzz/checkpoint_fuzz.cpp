// Fuzzes checkpoints and snapshots: the input as a whole file, and as contents between a valid mark and checksum.
// Whatever can be decoded is resumed.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "fuzz.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/numeric/digest.h"
#include "train_dynamics/train/in_process_train.h"
#include "train_dynamics/train/run_summary.h"
#include "train_dynamics/train/snapshot.h"
#include "train_dynamics/train/train_master.h"

namespace train_dynamics {
namespace {

/// The bytes of a snapshot with these contents, made without its code.
Bytes Seal(const char* mark, const std::uint8_t* contents, std::size_t size) {
  Bytes bytes(mark, mark + 8);
  bytes.push_back(2);  // format version
  bytes.resize(16);
  bytes.insert(bytes.end(), contents, contents + size);
  Digest checksum;
  for (std::size_t at = 0; at < bytes.size(); at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, &bytes[at], std::min<std::size_t>(8, bytes.size() - at));
    checksum.Add(word);
  }
  checksum.Add(std::uint64_t{bytes.size()});
  std::array<std::uint8_t, 8> end;
  const std::uint64_t value = checksum.value();
  std::memcpy(end.data(), &value, end.size());
  bytes.insert(bytes.end(), end.begin(), end.end());
  return bytes;
}

/// Two LTD vehicles.
const config::LoadedScenario& Scenario() {
  static const config::LoadedScenario scenario = config::LoadScenario(
      std::string(TRAIN_BRAKE_CONFIG_DIR) + "/scenarios/emergency.yaml",
      {"model=ltd", "train={name: t, connection: calibrated, consist: [{vehicle: ore_wagon, count: 2}]}",
       "brake=single_vehicle", "detail_vehicles=[]"});
  return scenario;
}

void Resume(const TrainCheckpoint& checkpoint) {
  const config::LoadedScenario& scenario = Scenario();
  InProcessTransport vehicles(scenario.params, scenario.consist, 1);
  TrainMaster master(scenario.params, scenario.consist, vehicles, scenario.pressures);
  RunSummary summary(scenario.params);
  master.AddObserver([&](const TrainRecord& record) { summary.Observe(record); });
  summary.SetMemory(checkpoint.summary);
  master.Resume(checkpoint);
  for (int exchange = 0; exchange < 20 && !master.Done(); ++exchange) master.Exchange();
  static_cast<void>(summary.ResidualShare(master));
}

void Read(const Bytes& bytes) {
  try {
    train_brake_build::fuzz::Require(Encode(DecodeBlockSnapshot(bytes)) == bytes,
                                     "what was decoded encodes to the same");
  } catch (const SnapshotError&) {
  }
  try {
    const TrainCheckpoint checkpoint = DecodeTrainCheckpoint(bytes);
    train_brake_build::fuzz::Require(Encode(checkpoint) == bytes, "what was decoded encodes to the same");
    Resume(checkpoint);
  } catch (const SnapshotError&) {
  } catch (const SimulationFault&) {
  }
}

}  // namespace
}  // namespace train_dynamics

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace train_dynamics;
  Read({data, data + size});
  Read(Seal("TBBLOCK\n", data, size));
  Read(Seal("TBTRAIN\n", data, size));
  return 0;
}
