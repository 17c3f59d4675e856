#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/time.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "train_dynamics/numeric/stream_digest.h"
#include "train_dynamics/train/byte_stream.h"
#include "train_results/message_views.h"

namespace train_results {

/// Writes messages into a bag (format 2.0, not compressed), one after the other.
///
/// Like rosbag::Bag, but for appending only. rosbag::Bag seeks before every message and writes it in pieces, with 25
/// system calls for a record of a train, and cannot be closed on a full disk. Here a message is serialised into the
/// open chunk, which is written in one piece once it has 768 KiB.
///
/// The bag is called FILE.active until it is complete, so that FILE is always readable.
class BagWriter {
 public:
  /// @throws std::system_error if the file cannot be made
  explicit BagWriter(const std::string& file);
  /// Prepares to continue the bag of a checkpoint, FILE or FILE.active. Only reads it; GoOn changes it.
  /// @throws std::invalid_argument, SnapshotError if there is no such bag, or its bytes have changed since
  BagWriter(const std::string& file, const train_dynamics::Bytes& checkpoint);
  /// Opens that bag and truncates it to the checkpoint; nothing can be written before this call.
  /// @throws std::system_error
  void GoOn();
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// A new topic, for Write. @param latched  a player gives its last message to later subscribers
  template <class Message>
  int AddTopic(const std::string& name, bool latched = false) {
    namespace traits = ros::message_traits;
    return AddConnection(name, traits::datatype<Message>(), traits::md5sum<Message>(), traits::definition<Message>(),
                         latched);
  }

  /// @param time  not before that of the last message
  /// @throws std::system_error if the file cannot grow any more
  template <class Message>
  void Write(int topic, ros::Time time, const Message& message) {
    const std::uint32_t size = ros::serialization::serializationLength(message);
    ros::serialization::OStream stream(BeginMessage(topic, time, size), size);
    ros::serialization::serialize(stream, message);
    if (chunk_.size() > kChunkThreshold) WriteChunk();
  }

  /// The same for the message behind a view: see message_views.h.
  template <class View>
  void WriteView(int topic, ros::Time time, const View& view) {
    const std::uint32_t size = SerializedLength(view);
    ros::serialization::OStream stream(BeginMessage(topic, time, size), size);
    Serialize(stream, view);
    if (chunk_.size() > kChunkThreshold) WriteChunk();
  }

  int topics() const { return static_cast<int>(connections_.size()); }

  /// Writes all messages so far. @return the state from which a writer can continue
  train_dynamics::Bytes Checkpoint();
  /// Waits until all data written before is on the disk. May be called while another thread continues to write.
  /// @throws std::system_error
  void Sync() const;

  /// Completes the bag and gives it its name. On a full disk it keeps all whole chunks that fit; if those of the last
  /// checkpoint and the index do not fit, it stays FILE.active without an index.
  /// @throws std::system_error if it is incomplete
  void Close();

 private:
  using Bytes = train_dynamics::Bytes;
  /// Does not initialise new bytes, which are written at once.
  template <class T>
  struct Uninitialised : std::allocator<T> {
    // NOLINTBEGIN(readability-identifier-naming): what the standard calls them
    template <class U>
    struct rebind {
      using other = Uninitialised<U>;
    };
    // NOLINTEND(readability-identifier-naming)
    template <class U>
    void construct(U* place) {
      ::new (static_cast<void*>(place)) U;
    }
    template <class U, class... Arguments>
    void construct(U* place, Arguments&&... arguments) {
      ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
    }
  };
  using Buffer = std::vector<std::uint8_t, Uninitialised<std::uint8_t>>;
  static constexpr std::size_t kChunkThreshold = 768 * 1024;

  struct Connection {
    Bytes record;                ///< its description, as in the file
    bool described = false;      ///< in a chunk
    std::uint32_t messages = 0;  ///< in the open chunk
    Bytes index;                 ///< time and place of each of these
  };
  struct Chunk {
    std::uint64_t position = 0;                     ///< in the file
    ros::Time begin, end;                           ///< times of its first and last message
    std::map<std::uint32_t, std::uint32_t> counts;  ///< messages by connection
  };

  int AddConnection(const std::string& topic, const std::string& type, const std::string& md5sum,
                    const std::string& definition, bool latched);
  std::uint8_t* BeginMessage(int topic, ros::Time time, std::uint32_t size);
  void WriteChunk();
  void Truncate();
  void WriteIndex();
  void WriteFileHeader(std::uint64_t index_position, std::size_t connections);
  void Write(const std::uint8_t* bytes, std::size_t count, std::uint64_t position);
  void Write(const Bytes& bytes, std::uint64_t position) { Write(bytes.data(), bytes.size(), position); }
  [[noreturn]] void Fail() const;

  std::string file_;
  int descriptor_;
  std::uint64_t size_;                   ///< of the file, up to its last whole chunk
  train_dynamics::StreamDigest digest_;  ///< of the file behind its header, up to the same
  std::vector<Connection> connections_;
  std::vector<Chunk> chunks_;    ///< in the file
  std::size_t kept_chunks_ = 0;  ///< of these, the number that a checkpoint covers
  Chunk open_;
  Buffer chunk_;  ///< records of the open one
};

}  // namespace train_results
