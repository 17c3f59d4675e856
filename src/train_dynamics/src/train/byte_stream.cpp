#include "train_dynamics/train/byte_stream.h"

#include <cstring>

namespace train_dynamics {

void ByteWriter::AddRaw(const void* from, std::size_t size) {
  const auto* bytes = static_cast<const std::uint8_t*>(from);
  bytes_.insert(bytes_.end(), bytes, bytes + size);
}

void ByteWriter::Add(const std::string& text) {
  Add(std::uint64_t{text.size()});
  AddRaw(text.data(), text.size());
}

void ByteWriter::Add(const Bytes& bytes) {
  Add(std::uint64_t{bytes.size()});
  AddRaw(bytes.data(), bytes.size());
}

void ByteWriter::Add(const std::vector<double>& numbers) {
  Add(std::uint64_t{numbers.size()});
  AddRaw(numbers.data(), numbers.size() * sizeof(double));
}

std::uint64_t ByteReader::Word() {
  std::uint64_t word = 0;
  Get(&word, 1, sizeof word);
  return word;
}

double ByteReader::Number() {
  double number = 0.0;
  Get(&number, 1, sizeof number);
  return number;
}

std::string ByteReader::Text() {
  std::string text(Count(1), '\0');
  Get(text.data(), text.size(), 1);
  return text;
}

Bytes ByteReader::Block() {
  Bytes bytes(Count(1));
  Get(bytes.data(), bytes.size(), 1);
  return bytes;
}

std::vector<double> ByteReader::Numbers() {
  std::vector<double> numbers(Count(sizeof(double)));
  Get(numbers.data(), numbers.size(), sizeof(double));
  return numbers;
}

void ByteReader::End() const {
  if (left_ != 0) throw SnapshotError("is damaged: it has more than it should");
}

/// Of an array that follows.
std::size_t ByteReader::Count(std::size_t element) {
  const std::uint64_t count = Word();
  if (count > left_ / element) throw SnapshotError("is cut short");
  return count;
}

void ByteReader::Get(void* to, std::size_t count, std::size_t element) {
  if (count > left_ / element) throw SnapshotError("is cut short");
  if (count == 0) return;
  std::memcpy(to, at_, count * element);
  at_ += count * element;
  left_ -= count * element;
}

}  // namespace train_dynamics
