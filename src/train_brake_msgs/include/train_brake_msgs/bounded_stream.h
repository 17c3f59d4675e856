#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace train_brake_msgs {

/// Reads a message from untrusted bytes.
///
/// roscpp's IStream allocates as many elements as an array announces before it checks that their bytes exist; here the
/// bytes are checked first. Every byte is read once, so that a process that shares the memory cannot change a number
/// after it was checked.
class BoundedStream : public ros::serialization::Stream {
 public:
  static const ros::serialization::StreamType stream_type = ros::serialization::stream_types::Input;

  BoundedStream(std::uint8_t* data, std::uint32_t size) : Stream(data, size) {}

  template <class T>
  void next(T& value) {
    ros::serialization::deserialize(*this, value);
  }

  template <class T, class Allocator>
  void next(std::vector<T, Allocator>& values) {
    std::uint32_t count = 0;
    next(count);
    if constexpr (ros::message_traits::IsSimple<T>::value) {
      if (count > getLength() / sizeof(T)) throw std::runtime_error("an array is longer than its message");
      values.resize(count);
      if (count == 0) return;
      const auto size = static_cast<std::uint32_t>(count * sizeof(T));
      std::memcpy(values.data(), advance(size), size);
    } else {
      values.clear();
      for (std::uint32_t i = 0; i < count; ++i) next(values.emplace_back());
    }
  }
};

/// Reads a message that must fill those bytes. @throws std::exception if they are not such a message, which then holds
/// arbitrary values
template <class Message>
void ReadMessage(std::uint8_t* data, std::uint32_t size, Message& message) {
  BoundedStream stream(data, size);
  stream.next(message);
  if (stream.getLength() != 0) {
    throw std::runtime_error(std::to_string(stream.getLength()) + " bytes are left of a message");
  }
}

/// Appends a message, as it is on the wire.
template <class Message>
void AppendMessage(const Message& message, std::vector<std::uint8_t>& bytes) {
  const std::size_t begin = bytes.size();
  const std::uint32_t size = ros::serialization::serializationLength(message);
  bytes.resize(begin + size);
  ros::serialization::OStream stream(bytes.data() + begin, size);
  stream.next(message);
}

}  // namespace train_brake_msgs
