#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace train_dynamics {

/// Bytes that are not a snapshot, or are one that does not fit.
class SnapshotError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

using Bytes = std::vector<std::uint8_t>;

/// Appends numbers and texts to bytes: little-endian, counts before arrays.
class ByteWriter {
 public:
  void Add(std::uint64_t word) { AddRaw(&word, sizeof word); }
  void Add(double number) { AddRaw(&number, sizeof number); }
  void Add(const std::string& text);
  void Add(const Bytes& bytes);
  void Add(const std::vector<double>& numbers);
  void AddRaw(const void* from, std::size_t size);

  const Bytes& bytes() const { return bytes_; }

 private:
  Bytes bytes_;
};

/// Reads them in the same order. Keeps a reference. All functions throw SnapshotError if the bytes end too early;
/// nothing larger than what is left is ever allocated.
class ByteReader {
 public:
  explicit ByteReader(const Bytes& bytes) : at_(bytes.data()), left_(bytes.size()) {}
  ByteReader(const std::uint8_t* bytes, std::size_t size) : at_(bytes), left_(size) {}

  std::uint64_t Word();
  double Number();
  std::string Text();
  Bytes Block();
  std::vector<double> Numbers();
  /// @throws SnapshotError if bytes are left
  void End() const;

 private:
  std::size_t Count(std::size_t element);
  void Get(void* to, std::size_t count, std::size_t element);

  const std::uint8_t* at_;
  std::size_t left_;
};

}  // namespace train_dynamics
