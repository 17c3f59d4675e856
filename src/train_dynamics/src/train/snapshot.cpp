#include "train_dynamics/train/snapshot.h"

#include <algorithm>
#include <cstring>

#include "train_dynamics/numeric/digest.h"
#include "train_dynamics/numeric/stream_digest.h"

namespace train_dynamics {
namespace {

// Each rises when the fields or their meaning change; in all versions of a train's checkpoint the scenario comes first.
constexpr std::uint64_t kBlockFormat = 3;
constexpr std::uint64_t kTrainFormat = 7;
constexpr std::size_t kWord = sizeof(std::uint64_t);

/// That of checkpoints before format 6.
std::uint64_t OldChecksum(const std::uint8_t* bytes, std::size_t size) {
  Digest digest;
  for (std::size_t at = 0; at < size; at += kWord) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + at, std::min(kWord, size - at));
    digest.Add(word);
  }
  digest.Add(std::uint64_t{size});
  return digest.value();
}

ByteWriter Begin(const char* mark, std::uint64_t format) {
  ByteWriter writer;
  writer.AddRaw(mark, kWord);
  writer.Add(format);
  return writer;
}

/// XXH64 of the bytes before it, as xxhsum prints it: the most significant byte first.
Bytes Finish(ByteWriter& writer) {
  XXH64_canonical_t checksum;
  XXH64_canonicalFromHash(&checksum, XXH64(writer.bytes().data(), writer.bytes().size(), 0));
  writer.AddRaw(checksum.digest, sizeof checksum.digest);
  return writer.bytes();
}

constexpr std::size_t kHead = 2 * kWord;

bool IsWhole(const Bytes& bytes) {
  if (bytes.size() < kHead + kWord) return false;
  const std::size_t end = bytes.size() - kWord;
  XXH64_canonical_t checksum;
  std::memcpy(checksum.digest, bytes.data() + end, kWord);
  return XXH64_hashFromCanonical(&checksum) == XXH64(bytes.data(), end, 0);
}

bool IsWholeOldOne(const Bytes& bytes) {
  if (bytes.size() < kHead + kWord) return false;
  const std::size_t end = bytes.size() - kWord;
  return ByteReader(bytes.data() + end, kWord).Word() == OldChecksum(bytes.data(), end);
}

/// The bytes between mark and checksum.
ByteReader ContentsOf(const Bytes& bytes) { return {bytes.data() + kHead, bytes.size() - kHead - kWord}; }

/// @param what  "a checkpoint", for messages
std::uint64_t FormatOf(const Bytes& bytes, const char* mark, const std::string& what) {
  if (bytes.size() < kWord || std::memcmp(bytes.data(), mark, kWord) != 0) throw SnapshotError("is not " + what);
  return ByteReader(bytes.data() + kWord, bytes.size() - kWord).Word();
}

/// The program that wrote a checkpoint of any format, from the first line of its scenario.
std::string WriterOf(const Bytes& bytes) {
  if (!IsWhole(bytes) && !IsWholeOldOne(bytes)) return "an unknown program";
  const std::string scenario = ContentsOf(bytes).Text();
  const std::string line = scenario.substr(0, scenario.find('\n'));
  return line.rfind("# ", 0) == 0 ? line.substr(2) : "an unknown program";
}

ByteReader ReaderOf(const Bytes& bytes) {
  if (!IsWhole(bytes)) throw SnapshotError("is damaged or cut short: its checksum is wrong");
  return ContentsOf(bytes);
}

void Add(const std::vector<StateRow>& states, ByteWriter& writer) {
  writer.Add(std::uint64_t{states.size()});
  for (const StateRow& state : states) writer.Add(state);
}

std::vector<StateRow> States(ByteReader& reader) {
  std::vector<StateRow> states;
  for (std::uint64_t left = reader.Word(); left > 0; --left) states.push_back(reader.Numbers());
  return states;
}

constexpr const char* kBlockMark = "TBBLOCK\n";
constexpr const char* kTrainMark = "TBTRAIN\n";

}  // namespace

void CheckRows(const std::vector<StateRow>& rows, int vehicles) {
  if (rows.size() == static_cast<std::size_t>(vehicles)) return;
  throw SnapshotError("is of " + std::to_string(rows.size()) + " vehicle(s), not of " + std::to_string(vehicles));
}

Bytes Encode(const BlockSnapshot& snapshot) {
  ByteWriter writer = Begin(kBlockMark, kBlockFormat);
  writer.Add(snapshot.exchange);
  writer.Add(snapshot.first);
  Add(snapshot.states, writer);
  return Finish(writer);
}

BlockSnapshot DecodeBlockSnapshot(const Bytes& bytes) {
  const std::uint64_t format = FormatOf(bytes, kBlockMark, "a snapshot of vehicles");
  if (format != kBlockFormat) {
    throw SnapshotError("is a snapshot of vehicles of format version " + std::to_string(format) +
                        ", this program reads version " + std::to_string(kBlockFormat) +
                        ": all programs of a run must be of one build");
  }
  ByteReader reader = ReaderOf(bytes);
  BlockSnapshot snapshot;
  snapshot.exchange = reader.Word();
  snapshot.first = reader.Word();
  snapshot.states = States(reader);
  reader.End();
  return snapshot;
}

Bytes Encode(const TrainCheckpoint& checkpoint) {
  ByteWriter writer = Begin(kTrainMark, kTrainFormat);
  writer.Add(checkpoint.scenario);
  writer.Add(checkpoint.exchange);
  writer.Add(checkpoint.state_digest);
  writer.Add(checkpoint.at_time_zero.mean_position_m);
  writer.Add(checkpoint.at_time_zero.stored_energy_j);
  Add(checkpoint.vehicles, writer);
  writer.Add(checkpoint.connections);
  writer.Add(checkpoint.brake);
  writer.Add(checkpoint.locomotives);
  writer.Add(checkpoint.breakaway);
  writer.Add(checkpoint.driver);
  writer.Add(checkpoint.built_in_driver);
  writer.Add(checkpoint.summary);
  writer.Add(checkpoint.output);
  return Finish(writer);
}

TrainCheckpoint DecodeTrainCheckpoint(const Bytes& bytes) {
  const std::uint64_t format = FormatOf(bytes, kTrainMark, "a checkpoint of a train");
  if (format != kTrainFormat) {
    throw SnapshotError("is a checkpoint of format version " + std::to_string(format) + ", written by " +
                        WriterOf(bytes) + "; this program, train_brake " TRAIN_BRAKE_VERSION ", reads version " +
                        std::to_string(kTrainFormat) +
                        ": finish the run with the build that wrote it, or run its config.yaml again");
  }
  ByteReader reader = ReaderOf(bytes);
  TrainCheckpoint checkpoint;
  checkpoint.scenario = reader.Text();
  checkpoint.exchange = reader.Word();
  checkpoint.state_digest = reader.Word();
  checkpoint.at_time_zero.mean_position_m = reader.Number();
  checkpoint.at_time_zero.stored_energy_j = reader.Number();
  checkpoint.vehicles = States(reader);
  checkpoint.connections = reader.Numbers();
  checkpoint.brake = reader.Numbers();
  checkpoint.locomotives = reader.Numbers();
  checkpoint.breakaway = reader.Numbers();
  checkpoint.driver = reader.Numbers();
  checkpoint.built_in_driver = reader.Numbers();
  checkpoint.summary = reader.Numbers();
  checkpoint.output = reader.Block();
  reader.End();
  return checkpoint;
}

}  // namespace train_dynamics
