#include "train_results/plain_file.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace train_results {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Refuse(const fs::path& file, const std::string& reason) {
  throw std::invalid_argument(file.string() + " " + reason);
}

/// Calls take(bytes, count) for the next `count` bytes in pieces. @return false if the file ends before
template <class Take>
bool ReadPieces(std::ifstream& stream, std::uint64_t count, const Take& take) {
  std::vector<char> piece(1 << 18);
  while (count > 0) {
    stream.read(piece.data(), static_cast<std::streamsize>(std::min<std::uint64_t>(count, piece.size())));
    const auto got = static_cast<std::size_t>(stream.gcount());
    if (got == 0) return false;
    take(piece.data(), got);
    count -= got;
  }
  return true;
}

}  // namespace

std::ifstream OpenPlainFile(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) Refuse(file, "does not exist");
  if (error) Refuse(file, "cannot be read: " + error.message());
  if (!fs::is_regular_file(status)) Refuse(file, "is not a regular file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) Refuse(file, "cannot be read");
  return stream;
}

std::string ReadPlainFile(const fs::path& file, std::uint64_t max_bytes) {
  std::ifstream stream = OpenPlainFile(file);
  std::string text;
  const bool has_more = ReadPieces(stream, max_bytes + 1,
                                   [&](const char* bytes, std::size_t count) { text.append(bytes, count); });
  if (has_more) {
    Refuse(file, "is larger than " + std::to_string(max_bytes >> 20) + " MB, the limit for such a file");
  }
  return text;
}

void AddToDigest(const fs::path& file, std::uint64_t from, std::uint64_t to,
                 train_dynamics::StreamDigest& digest) {
  std::ifstream stream = OpenPlainFile(file);
  stream.seekg(static_cast<std::streamoff>(from));
  const bool is_whole =
      from <= to &&
      ReadPieces(stream, to - from, [&](const char* bytes, std::size_t count) { digest.Add(bytes, count); });
  if (!is_whole) Refuse(file, "is shorter than it was at the checkpoint");
}

void WriteFile(const fs::path& file, const std::string& text) {
  const fs::path unfinished = file.string() + ".unfinished";
  std::ofstream stream(unfinished, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) {
    std::error_code ignored;
    fs::remove(unfinished, ignored);
    throw std::runtime_error("cannot write " + file.string());
  }
  fs::rename(unfinished, file);
}

}  // namespace train_results
