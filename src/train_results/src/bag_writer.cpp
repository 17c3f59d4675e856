#include "train_results/bag_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "train_results/plain_file.h"

namespace train_results {
namespace {

// wiki.ros.org/Bags/Format/2.0. A record is a header and data, each behind its length. A header is a list of fields
// "name=value", each behind its length. Numbers are little-endian. Fields are in the order of rosbag::Bag.
constexpr char kVersion[] = "#ROSBAG V2.0\n";
constexpr std::size_t kFileStart = sizeof kVersion - 1 + 4 + 4096 + 4;  // version and padded file header
constexpr std::uint32_t kIndexVersion = 1;

enum Operation : std::uint8_t {
  kMessage = 2,
  kFileHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

using train_dynamics::ByteReader;
using train_dynamics::Bytes;
using train_dynamics::ByteWriter;

// To Bytes or to the buffer of a chunk.

template <class Buffer>
void Append(Buffer& bytes, const std::string& text) {
  bytes.insert(bytes.end(), text.begin(), text.end());
}

template <class Buffer, class Number>
void Append(Buffer& bytes, Number number) {
  static_assert(std::is_integral_v<Number> || std::is_enum_v<Number>);
  const auto* begin = reinterpret_cast<const std::uint8_t*>(&number);
  bytes.insert(bytes.end(), begin, begin + sizeof number);
}

template <class Buffer>
void Append(Buffer& bytes, ros::Time time) {
  Append(bytes, time.sec);
  Append(bytes, time.nsec);
}

/// Appends what `append` does, behind its length.
template <class Buffer, class Appender>
void AppendWithLength(Buffer& bytes, const Appender& append) {
  const std::size_t place = bytes.size();
  Append(bytes, std::uint32_t{0});
  append();
  const auto length = static_cast<std::uint32_t>(bytes.size() - place - sizeof(std::uint32_t));
  std::memcpy(&bytes[place], &length, sizeof length);
}

template <class Buffer>
void AppendFields(Buffer&) {}

template <class Buffer, class Value, class... More>
void AppendFields(Buffer& bytes, const char* name, const Value& value, const More&... more) {
  AppendWithLength(bytes, [&] {
    bytes.insert(bytes.end(), name, name + std::strlen(name));
    bytes.push_back('=');
    Append(bytes, value);
  });
  AppendFields(bytes, more...);
}

/// Appends the header of a record: AppendHeader(bytes, name, value, name, value ...).
template <class Buffer, class... Fields>
void AppendHeader(Buffer& bytes, const Fields&... fields) {
  AppendWithLength(bytes, [&] { AppendFields(bytes, fields...); });
}

/// @throws SnapshotError if a bag knows no such time
ros::Time TimeOf(std::uint64_t nanoseconds) {
  if (nanoseconds >> 32 >= 1000000000u) throw train_dynamics::SnapshotError("is damaged: no such time");
  ros::Time time;
  time.fromNSec(nanoseconds);
  return time;
}

void Rename(const std::string& from, const std::string& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0)
    throw std::runtime_error("cannot write " + to + ": " + WriteFailure(errno));
}

}  // namespace

BagWriter::BagWriter(const std::string& file)
    : file_(file),
      descriptor_(open((file + ".active").c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)),
      size_(kFileStart) {
  if (descriptor_ < 0) Fail();
  try {
    WriteFileHeader(0, 0);
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

BagWriter::BagWriter(const std::string& file, const Bytes& checkpoint) : file_(file), descriptor_(-1), size_(0) {
  ByteReader reader(checkpoint);
  size_ = reader.Word();
  const std::uint64_t digest = reader.Word();
  for (std::uint64_t count = reader.Word(); count > 0; --count) {
    Connection& connection = connections_.emplace_back();
    connection.record = reader.Block();
    connection.described = reader.Word() != 0;
  }
  std::uint64_t last_position = 0;
  for (std::uint64_t count = reader.Word(); count > 0; --count) {
    Chunk& chunk = chunks_.emplace_back();
    chunk.position = reader.Word();
    if (chunk.position < std::max<std::uint64_t>(kFileStart, last_position) || chunk.position > size_) {
      throw train_dynamics::SnapshotError("is damaged: no such place in the bag");
    }
    last_position = chunk.position;
    chunk.begin = TimeOf(reader.Word());
    chunk.end = TimeOf(reader.Word());
    for (std::uint64_t counts = reader.Word(); counts > 0; --counts) {
      const auto id = static_cast<std::uint32_t>(reader.Word());
      chunk.counts[id] = static_cast<std::uint32_t>(reader.Word());
      if (id >= connections_.size()) throw train_dynamics::SnapshotError("is damaged: no such topic");
    }
  }
  reader.End();
  kept_chunks_ = chunks_.size();

  const std::string found = std::filesystem::exists(file) ? file : file + ".active";
  AddToDigest(found, kFileStart, size_, digest_);
  if (digest_.value() != digest) {
    throw std::invalid_argument(found + " is not the bag that the checkpoint is of, or it is damaged");
  }
}

void BagWriter::GoOn() {
  const std::string active = file_ + ".active";
  if (std::filesystem::exists(file_)) Rename(file_, active);
  descriptor_ = open(active.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor_ < 0) Fail();
  Truncate();
  WriteFileHeader(0, 0);
}

Bytes BagWriter::Checkpoint() {
  WriteChunk();
  kept_chunks_ = chunks_.size();
  ByteWriter writer;
  writer.Add(size_);
  writer.Add(digest_.value());
  writer.Add(std::uint64_t{connections_.size()});
  for (const Connection& connection : connections_) {
    writer.Add(connection.record);
    writer.Add(std::uint64_t{connection.described});
  }
  writer.Add(std::uint64_t{chunks_.size()});
  for (const Chunk& chunk : chunks_) {
    writer.Add(chunk.position);
    writer.Add(chunk.begin.toNSec());
    writer.Add(chunk.end.toNSec());
    writer.Add(std::uint64_t{chunk.counts.size()});
    for (const auto& [id, messages] : chunk.counts) {
      writer.Add(std::uint64_t{id});
      writer.Add(std::uint64_t{messages});
    }
  }
  return writer.bytes();
}

void BagWriter::Sync() const {
  if (fdatasync(descriptor_) != 0) Fail();
}

BagWriter::~BagWriter() {
  try {
    Close();
  } catch (const std::exception&) {  // an unwinding caller has the first error already
  }
}

int BagWriter::AddConnection(const std::string& topic, const std::string& type, const std::string& md5sum,
                             const std::string& definition, bool latched) {
  const auto id = static_cast<std::uint32_t>(connections_.size());
  Bytes& record = connections_.emplace_back().record;
  AppendHeader(record, "conn", id, "op", kConnection, "topic", topic);
  AppendWithLength(record, [&] {  // the data
    AppendFields(record, "md5sum", md5sum, "message_definition", definition, "type", type);
    if (latched) AppendFields(record, "latching", std::string("1"));
  });
  return static_cast<int>(id);
}

/// Appends a message's record without its data. @return where the data belong
std::uint8_t* BagWriter::BeginMessage(int topic, ros::Time time, std::uint32_t size) {
  if (chunk_.empty()) open_.begin = time;
  open_.end = time;
  Connection& connection = connections_[topic];
  if (!connection.described) chunk_.insert(chunk_.end(), connection.record.begin(), connection.record.end());
  connection.described = true;
  ++connection.messages;
  Append(connection.index, time);
  Append(connection.index, static_cast<std::uint32_t>(chunk_.size()));
  AppendHeader(chunk_, "conn", static_cast<std::uint32_t>(topic), "op", kMessage, "time", time);
  Append(chunk_, size);
  chunk_.resize(chunk_.size() + size);
  return &chunk_[chunk_.size() - size];
}

/// Moves the open chunk and its index to the file. It stays open if that fails.
void BagWriter::WriteChunk() {
  if (chunk_.empty()) return;
  const auto size = static_cast<std::uint32_t>(chunk_.size());
  Bytes header, index;
  AppendHeader(header, "compression", std::string("none"), "op", kChunk, "size", size);
  Append(header, size);
  for (std::uint32_t id = 0; id < connections_.size(); ++id) {
    const Connection& connection = connections_[id];
    if (connection.messages == 0) continue;
    open_.counts[id] = connection.messages;
    AppendHeader(index, "conn", id, "count", connection.messages, "op", kIndex, "ver", kIndexVersion);
    Append(index, static_cast<std::uint32_t>(connection.index.size()));
    index.insert(index.end(), connection.index.begin(), connection.index.end());
  }
  Write(header, size_);
  Write(chunk_.data(), chunk_.size(), size_ + header.size());
  Write(index, size_ + header.size() + chunk_.size());

  digest_.Add(header.data(), header.size());
  digest_.Add(chunk_.data(), chunk_.size());
  digest_.Add(index.data(), index.size());
  open_.position = size_;
  size_ += header.size() + chunk_.size() + index.size();
  chunks_.push_back(std::exchange(open_, {}));
  chunk_.clear();
  for (Connection& connection : connections_) {
    connection.messages = 0;
    connection.index.clear();
  }
}

/// Cuts off what is behind the last whole chunk.
void BagWriter::Truncate() {
  if (ftruncate(descriptor_, static_cast<off_t>(size_)) != 0) Fail();
}

/// Writes the part after the last chunk (all connections and the positions of the chunks) and the header that refers to
/// it.
void BagWriter::WriteIndex() {
  Truncate();
  std::set<std::uint32_t> connections;
  for (const Chunk& chunk : chunks_) {
    for (const auto& count : chunk.counts) connections.insert(count.first);
  }
  Bytes index;
  for (std::uint32_t id : connections) {
    index.insert(index.end(), connections_[id].record.begin(), connections_[id].record.end());
  }
  for (const Chunk& chunk : chunks_) {
    AppendHeader(index, "chunk_pos", chunk.position, "count", static_cast<std::uint32_t>(chunk.counts.size()),
                 "end_time", chunk.end, "op", kChunkInfo, "start_time", chunk.begin, "ver", kIndexVersion);
    AppendWithLength(index, [&] {
      for (const auto& [id, messages] : chunk.counts) {
        Append(index, id);
        Append(index, messages);
      }
    });
  }
  Write(index, size_);
  WriteFileHeader(size_, connections.size());
}

/// @param index_position  0: none, the sign of a truncated bag
void BagWriter::WriteFileHeader(std::uint64_t index_position, std::size_t connections) {
  Bytes bytes;
  Append(bytes, std::string(kVersion));
  AppendHeader(bytes, "chunk_count", static_cast<std::uint32_t>(chunks_.size()), "conn_count",
               static_cast<std::uint32_t>(connections), "index_pos", index_position, "op", kFileHeader);
  AppendWithLength(bytes, [&] { bytes.resize(kFileStart, ' '); });
  Write(bytes, 0);
}

void BagWriter::Fail() const {
  const std::error_code error(errno, std::generic_category());
  const char* hint = error == std::errc::file_too_large ? " (ulimit -f limits the size of files)" : "";
  throw std::system_error(error, "cannot write " + file_ + hint);
}

void BagWriter::Write(const std::uint8_t* bytes, std::size_t count, std::uint64_t position) {
  for (std::size_t done = 0; done < count;) {
    const ssize_t written = pwrite(descriptor_, bytes + done, count - done, static_cast<off_t>(position + done));
    if (written > 0) {
      done += static_cast<std::size_t>(written);
    } else if (errno != EINTR) {
      Fail();
    }
  }
}

void BagWriter::Close() {
  if (descriptor_ < 0) return;
  std::exception_ptr error;
  const auto works = [&error](const auto& step) {
    try {
      step();
    } catch (const std::system_error&) {
      if (error == nullptr) error = std::current_exception();
      return false;
    }
    return true;
  };
  works([this] { WriteChunk(); });
  // On a full disk the index replaces data that did not fit, and if needed also whole chunks, the last first, but none
  // that a checkpoint covers.
  bool indexed = false;
  while (!(indexed = works([this] { WriteIndex(); })) && chunks_.size() > kept_chunks_) {
    size_ = chunks_.back().position;
    chunks_.pop_back();
  }
  if (!indexed) works([this] { Truncate(); });
  const bool complete = close(descriptor_) == 0 && indexed;
  descriptor_ = -1;
  if (complete) Rename(file_ + ".active", file_);
  if (error != nullptr) std::rethrow_exception(error);
  if (!complete) Fail();
}

}  // namespace train_results
