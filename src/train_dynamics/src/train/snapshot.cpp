#include "train_dynamics/train/snapshot.h"

#include <algorithm>
#include <cstring>

#include "train_dynamics/numeric/digest.h"

namespace train_dynamics {
namespace {

constexpr std::uint64_t kFormatVersion = 2;  // rises when the fields or their meaning change
constexpr std::size_t kWord = sizeof(std::uint64_t);

std::uint64_t Checksum(const std::uint8_t* bytes, std::size_t size) {
  Digest digest;
  for (std::size_t at = 0; at < size; at += kWord) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + at, std::min(kWord, size - at));
    digest.Add(word);
  }
  digest.Add(std::uint64_t{size});
  return digest.value();
}

ByteWriter Begin(const char* mark) {
  ByteWriter writer;
  writer.AddRaw(mark, kWord);
  writer.Add(kFormatVersion);
  return writer;
}

Bytes Finish(ByteWriter& writer) {
  writer.Add(Checksum(writer.bytes().data(), writer.bytes().size()));
  return writer.bytes();
}

/// A reader of what stands between mark and checksum. @param what  "a checkpoint", for messages
ByteReader ReaderOf(const Bytes& bytes, const char* mark, const std::string& what) {
  constexpr std::size_t kHead = 2 * kWord;
  if (bytes.size() < kWord || std::memcmp(bytes.data(), mark, kWord) != 0)
    throw SnapshotError("is not " + what);
  ByteReader head(bytes.data() + kWord, bytes.size() - kWord);
  const std::uint64_t version = head.Word();
  if (version != kFormatVersion) {
    throw SnapshotError("is " + what + " of format version " + std::to_string(version) +
                        ", this program reads version " + std::to_string(kFormatVersion));
  }
  if (bytes.size() < kHead + kWord) throw SnapshotError("is cut short");
  const std::size_t end = bytes.size() - kWord;
  if (ByteReader(bytes.data() + end, kWord).Word() != Checksum(bytes.data(), end)) {
    throw SnapshotError("is damaged or cut short: its checksum is wrong");
  }
  return {bytes.data() + kHead, end - kHead};
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
  throw SnapshotError("is of " + std::to_string(rows.size()) + " vehicle(s), not of " +
                      std::to_string(vehicles));
}

Bytes Encode(const BlockSnapshot& snapshot) {
  ByteWriter writer = Begin(kBlockMark);
  writer.Add(snapshot.exchange);
  writer.Add(snapshot.first);
  Add(snapshot.states, writer);
  return Finish(writer);
}

BlockSnapshot DecodeBlockSnapshot(const Bytes& bytes) {
  ByteReader reader = ReaderOf(bytes, kBlockMark, "a snapshot of vehicles");
  BlockSnapshot snapshot;
  snapshot.exchange = reader.Word();
  snapshot.first = reader.Word();
  snapshot.states = States(reader);
  reader.End();
  return snapshot;
}

Bytes Encode(const TrainCheckpoint& checkpoint) {
  ByteWriter writer = Begin(kTrainMark);
  writer.Add(checkpoint.scenario);
  writer.Add(checkpoint.exchange);
  writer.Add(checkpoint.state_digest);
  Add(checkpoint.vehicles, writer);
  writer.Add(checkpoint.connections);
  writer.Add(checkpoint.brake);
  writer.Add(checkpoint.summary);
  writer.Add(checkpoint.output);
  return Finish(writer);
}

TrainCheckpoint DecodeTrainCheckpoint(const Bytes& bytes) {
  ByteReader reader = ReaderOf(bytes, kTrainMark, "a checkpoint of a train");
  TrainCheckpoint checkpoint;
  checkpoint.scenario = reader.Text();
  checkpoint.exchange = reader.Word();
  checkpoint.state_digest = reader.Word();
  checkpoint.vehicles = States(reader);
  checkpoint.connections = reader.Numbers();
  checkpoint.brake = reader.Numbers();
  checkpoint.summary = reader.Numbers();
  checkpoint.output = reader.Block();
  reader.End();
  return checkpoint;
}

}  // namespace train_dynamics
