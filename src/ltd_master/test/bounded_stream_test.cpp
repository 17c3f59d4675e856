#include <gtest/gtest.h>
#include <train_brake_msgs/StepResponse.h>
#include <train_brake_msgs/bounded_stream.h>

#include <limits>
#include <string>
#include <vector>

namespace train_brake_msgs {
namespace {

using Bytes = std::vector<std::uint8_t>;

template <class Message>
Bytes BytesOf(const Message& message) {
  Bytes bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  stream.next(message);
  return bytes;
}

template <class Message>
void Read(Bytes bytes, Message& message) {
  ReadMessage(bytes.data(), static_cast<std::uint32_t>(bytes.size()), message);
}

/// With something in every kind of field: flag, text, number, array of numbers, of bytes, of messages.
StepResponse Example() {
  StepResponse reply;
  reply.ok = true;
  reply.message = "a text";
  reply.exchange = 17;
  reply.head_displacement_m = {1.5, -2.5, std::numeric_limits<double>::quiet_NaN()};
  reply.record.state_digest = {7, 8};
  reply.record.details.resize(2);
  reply.record.details[1].header.frame_id = "wagon";
  reply.snapshot = {1, 2, 3};
  return reply;
}

TEST(BoundedStream, ReadsWhatRoscppWrites) {
  const Bytes bytes = BytesOf(Example());
  StepResponse read;
  read.head_velocity_mps = {9.0};  // of an earlier reply
  read.record.details.resize(5);
  Read(bytes, read);
  EXPECT_EQ(BytesOf(read), bytes);  // bit by bit, so that NaN equals NaN
}

TEST(BoundedStream, RefusesWhatIsCutShortOrTooLong) {
  const Bytes bytes = BytesOf(Example());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    StepResponse read;
    EXPECT_THROW(Read(Bytes(bytes.begin(), bytes.begin() + static_cast<long>(size)), read), std::exception) << size;
  }
  Bytes longer = bytes;
  longer.push_back(0);
  StepResponse read;
  EXPECT_THROW(Read(longer, read), std::exception);
}

TEST(BoundedStream, TakesNoMemoryForElementsThatAreNotThere) {
  // 2^29 + 1 numbers of 8 bytes: 4 GiB, or 8 bytes if counted in 32 bits.
  const std::uint32_t count = (1u << 29) + 1;
  std::vector<double> numbers;
  Bytes bytes = BytesOf(count);
  bytes.resize(bytes.size() + sizeof(double));
  EXPECT_THROW(Read(bytes, numbers), std::exception);
  EXPECT_LT(numbers.capacity(), 1000u);

  std::vector<WagonState> details;
  EXPECT_THROW(Read(bytes, details), std::exception);
  EXPECT_LT(details.capacity(), 1000u);
}

}  // namespace
}  // namespace train_brake_msgs
