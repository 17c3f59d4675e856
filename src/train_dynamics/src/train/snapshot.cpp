#include "train_dynamics/train/snapshot.h"

#include <cstring>

#include "train_dynamics/numeric/digest.h"

namespace train_dynamics {
namespace {

constexpr std::uint64_t kFormatVersion = 1;  // rises when the fields or their meaning change
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

class Writer {
 public:
  explicit Writer(const char* mark) {
    Add(mark, kWord);
    Add(kFormatVersion);
  }
  void Add(std::uint64_t word) { Add(&word, sizeof word); }
  void Add(const std::string& text) {
    Add(std::uint64_t{text.size()});
    Add(text.data(), text.size());
  }
  void Add(const std::vector<double>& numbers) {
    Add(std::uint64_t{numbers.size()});
    Add(numbers.data(), numbers.size() * sizeof(double));
  }
  std::vector<std::uint8_t> Finish() {
    Add(Checksum(bytes_.data(), bytes_.size()));
    return std::move(bytes_);
  }

 private:
  void Add(const void* from, std::size_t size) {
    const auto* bytes = static_cast<const std::uint8_t*>(from);
    bytes_.insert(bytes_.end(), bytes, bytes + size);
  }
  std::vector<std::uint8_t> bytes_;
};

class Reader {
 public:
  /// @param what  "a checkpoint", for messages
  Reader(const std::vector<std::uint8_t>& bytes, const char* mark, const std::string& what)
      : at_(bytes.data()), left_(bytes.size()) {
    if (left_ < kWord || std::memcmp(at_, mark, kWord) != 0) throw SnapshotError("is not " + what);
    at_ += kWord;
    left_ -= kWord;
    const std::uint64_t version = Word();
    if (version != kFormatVersion) {
      throw SnapshotError("is " + what + " of format version " + std::to_string(version) +
                          ", this program reads version " + std::to_string(kFormatVersion));
    }
    if (left_ < kWord) throw SnapshotError("is cut short");
    std::uint64_t checksum = 0;
    std::memcpy(&checksum, bytes.data() + bytes.size() - kWord, kWord);
    if (checksum != Checksum(bytes.data(), bytes.size() - kWord)) {
      throw SnapshotError("is damaged or cut short: its checksum is wrong");
    }
    left_ -= kWord;
  }
  std::uint64_t Word() {
    std::uint64_t word = 0;
    Get(&word, 1, sizeof word);
    return word;
  }
  std::string Text() {
    std::string text(Count(1), '\0');
    Get(text.data(), text.size(), 1);
    return text;
  }
  std::vector<double> Numbers() {
    std::vector<double> numbers(Count(sizeof(double)));
    Get(numbers.data(), numbers.size(), sizeof(double));
    return numbers;
  }
  void End() const {
    if (left_ != 0) throw SnapshotError("is damaged: it has more than it should");
  }

 private:
  /// Of an array that follows; no larger than what is left, so that nothing huge is allocated.
  std::size_t Count(std::size_t element) {
    const std::uint64_t count = Word();
    if (count > left_ / element) throw SnapshotError("is cut short");
    return count;
  }
  void Get(void* to, std::size_t count, std::size_t element) {
    if (count > left_ / element) throw SnapshotError("is cut short");
    if (count == 0) return;
    std::memcpy(to, at_, count * element);
    at_ += count * element;
    left_ -= count * element;
  }
  const std::uint8_t* at_;
  std::size_t left_;
};

constexpr const char* kBlockMark = "TBBLOCK\n";
constexpr const char* kTrainMark = "TBTRAIN\n";

}  // namespace

std::vector<std::uint8_t> Encode(const BlockSnapshot& snapshot) {
  Writer writer(kBlockMark);
  writer.Add(snapshot.exchange);
  writer.Add(snapshot.first);
  writer.Add(snapshot.count);
  writer.Add(snapshot.state);
  return writer.Finish();
}

BlockSnapshot DecodeBlockSnapshot(const std::vector<std::uint8_t>& bytes) {
  Reader reader(bytes, kBlockMark, "a snapshot of vehicles");
  BlockSnapshot snapshot;
  snapshot.exchange = reader.Word();
  snapshot.first = reader.Word();
  snapshot.count = reader.Word();
  snapshot.state = reader.Numbers();
  reader.End();
  return snapshot;
}

std::vector<std::uint8_t> Encode(const TrainCheckpoint& checkpoint) {
  Writer writer(kTrainMark);
  writer.Add(checkpoint.scenario);
  writer.Add(checkpoint.exchange);
  writer.Add(checkpoint.state_digest);
  writer.Add(checkpoint.vehicles);
  writer.Add(checkpoint.connections);
  writer.Add(checkpoint.summary);
  return writer.Finish();
}

TrainCheckpoint DecodeTrainCheckpoint(const std::vector<std::uint8_t>& bytes) {
  Reader reader(bytes, kTrainMark, "a checkpoint of a train");
  TrainCheckpoint checkpoint;
  checkpoint.scenario = reader.Text();
  checkpoint.exchange = reader.Word();
  checkpoint.state_digest = reader.Word();
  checkpoint.vehicles = reader.Numbers();
  checkpoint.connections = reader.Numbers();
  checkpoint.summary = reader.Numbers();
  reader.End();
  return checkpoint;
}

}  // namespace train_dynamics
