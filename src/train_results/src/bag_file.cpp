#include "train_results/bag_file.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>

namespace train_results {
namespace {

constexpr const char* kVersion = "#ROSBAG V2.0\n";
constexpr std::uint32_t kLargestHeader =
    1 << 20;  // [bytes]; a header has a few short fields, a connection's a definition

enum Operation : std::uint8_t { kMessage = 2, kChunk = 5, kConnection = 7 };

using Fields = std::map<std::string, std::string>;

std::uint32_t Number(const char* bytes) {
  std::uint32_t number = 0;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

/// Fields "name=value", each after its length; nothing if the text is not made of these.
std::optional<Fields> FieldsOf(const std::string& text) {
  Fields fields;
  constexpr std::size_t kLength = sizeof(std::uint32_t);
  for (std::size_t at = 0; at < text.size();) {
    if (text.size() - at < kLength) return std::nullopt;
    const std::size_t size = Number(&text[at]);
    at += kLength;
    if (text.size() - at < size) return std::nullopt;
    const std::string field = text.substr(at, size);
    const std::size_t equals = field.find('=');
    if (equals == std::string::npos) return std::nullopt;
    fields[field.substr(0, equals)] = field.substr(equals + 1);
    at += size;
  }
  return fields;
}

}  // namespace

/// One pass over the records.
class BagFile::Scan {
 public:
  Scan(std::ifstream& stream, std::vector<Topic>& topics) : stream_(stream), topics_(topics) {
    stream_.seekg(0, std::ios::end);
    size_ = static_cast<std::uint64_t>(stream_.tellg());
    stream_.seekg(0);
  }

  void Run() {
    if (Take(std::strlen(kVersion)) != kVersion) throw UnreadableBag("is no bag of format 2.0");
    while (Record()) {
    }
  }

 private:
  /// One record; a chunk is entered, as its content is records. @return false at the end, or where the file is cut off
  bool Record() {
    const std::optional<std::string> header = TakeText(kLargestHeader);
    // A record has a header: zeros come from a file system after a loss of power.
    if (!header || header->empty()) return false;
    const std::optional<Fields> fields = FieldsOf(*header);
    const std::optional<std::string> size = Take(sizeof(std::uint32_t));
    if (!fields) throw UnreadableBag("is damaged at byte " + std::to_string(at_));
    if (!size) return false;
    const std::uint32_t length = Number(size->data());
    const std::string operation = Value(*fields, "op");
    switch (operation.size() == 1 ? operation[0] : 0) {
      case kChunk:
        if (Value(*fields, "compression") == "none") return true;
        throw UnreadableBag("is compressed: `rosbag decompress` makes one that can be read");
      case kConnection:
        return Describe(*fields, length);
      case kMessage:
        return Note(*fields, length);
      default:
        return Skip(length);
    }
  }

  bool Describe(const Fields& fields, std::uint32_t length) {
    const std::optional<std::string> description = length <= kLargestHeader ? Take(length) : std::nullopt;
    if (!description) return false;
    const Fields what = FieldsOf(*description).value_or(Fields());
    const std::string name = Value(fields, "topic");
    auto topic = std::find_if(topics_.begin(), topics_.end(), [&](const Topic& each) { return each.name == name; });
    if (topic == topics_.end()) {
      topic = topics_.insert(topic, {name, Value(what, "type"), Value(what, "md5sum"), {}});
    }
    topic_[Value(fields, "conn")] = static_cast<std::size_t>(topic - topics_.begin());
    return true;
  }

  bool Note(const Fields& fields, std::uint32_t length) {
    const auto topic = topic_.find(Value(fields, "conn"));
    const Place place{at_, length};
    if (!Skip(length)) return false;
    if (topic != topic_.end()) topics_[topic->second].messages.push_back(place);
    return true;
  }

  static std::string Value(const Fields& fields, const std::string& name) {
    const auto found = fields.find(name);
    return found == fields.end() ? "" : found->second;
  }

  std::optional<std::string> TakeText(std::uint32_t largest) {
    const std::optional<std::string> size = Take(sizeof(std::uint32_t));
    if (!size) return std::nullopt;
    const std::uint32_t length = Number(size->data());
    if (length > largest) throw UnreadableBag("is damaged at byte " + std::to_string(at_));
    return Take(length);
  }

  std::optional<std::string> Take(std::size_t count) {
    if (size_ - at_ < count) return std::nullopt;
    std::string text(count, '\0');
    stream_.read(text.data(), static_cast<std::streamsize>(count));
    if (!stream_) return std::nullopt;
    at_ += count;
    return text;
  }

  bool Skip(std::uint64_t count) {
    if (size_ - at_ < count) return false;
    stream_.ignore(static_cast<std::streamsize>(count));
    at_ += count;
    return true;
  }

  std::ifstream& stream_;
  std::vector<Topic>& topics_;
  std::uint64_t size_ = 0, at_ = 0;
  std::map<std::string, std::size_t> topic_;  ///< by connection number
};

BagFile::BagFile(const std::string& file) {
  if (!std::filesystem::is_regular_file(file)) throw UnreadableBag("is not a regular file");
  stream_.open(file, std::ios::binary);
  if (!stream_) throw UnreadableBag("cannot be read");
  Scan(stream_, topics_).Run();
}

Bytes BagFile::Read(const Place& message) {
  Bytes bytes(message.size);
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(message.position));
  stream_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream_) throw UnreadableBag("cannot be read to its end");
  return bytes;
}

}  // namespace train_results
