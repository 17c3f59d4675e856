#include "train_results/plain_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <stdexcept>
#include <system_error>
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

/// Writes a file and waits until it is on the disk. @return 0, or errno
int WriteToDisk(const fs::path& file, const std::string& text) {
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) return errno;
  int error = 0;
  for (std::size_t done = 0; done < text.size() && error == 0;) {
    const ssize_t written = write(descriptor, &text[done], text.size() - done);
    if (written >= 0) {
      done += static_cast<std::size_t>(written);
    } else if (errno != EINTR) {
      error = errno;
    }
  }
  // EINVAL: no file of a disk (a pipe, a device), where there is nothing to wait for.
  if (error == 0 && fsync(descriptor) != 0 && errno != EINVAL && errno != EROFS) error = errno;
  if (close(descriptor) != 0 && error == 0) error = errno;
  return error;
}

}  // namespace

std::string WriteFailure(int error) {
  const std::string reason = std::generic_category().message(error);
  return error == EFBIG ? reason + " (ulimit -f limits the size of files)" : reason;
}

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
  const bool has_more =
      ReadPieces(stream, max_bytes + 1, [&](const char* bytes, std::size_t count) { text.append(bytes, count); });
  if (has_more) {
    Refuse(file, "is larger than " + std::to_string(max_bytes >> 20) + " MB, the limit for such a file");
  }
  return text;
}

void AddToDigest(const fs::path& file, std::uint64_t from, std::uint64_t to, train_dynamics::StreamDigest& digest) {
  std::ifstream stream = OpenPlainFile(file);
  stream.seekg(static_cast<std::streamoff>(from));
  const bool is_whole = from <= to && ReadPieces(stream, to - from, [&](const char* bytes, std::size_t count) {
                          digest.Add(bytes, count);
                        });
  if (!is_whole) Refuse(file, "is shorter than it was at the checkpoint");
}

void SyncFile(const fs::path& file) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  int error = descriptor < 0 || fdatasync(descriptor) != 0 ? errno : 0;
  if (descriptor >= 0 && close(descriptor) != 0 && error == 0) error = errno;
  if (error != 0) throw std::runtime_error("cannot write " + file.string() + ": " + WriteFailure(error));
}

void WriteFile(const fs::path& file, const std::string& text) {
  const fs::path unfinished = file.string() + ".unfinished";
  int error = WriteToDisk(unfinished, text);
  if (error == 0 && rename(unfinished.c_str(), file.c_str()) != 0) error = errno;
  if (error == 0) {
    // The new name, too. Not every file system can do that for a folder; the old file is the fallback.
    const int folder = open(file.has_parent_path() ? file.parent_path().c_str() : ".", O_RDONLY | O_CLOEXEC);
    if (folder >= 0) {
      fsync(folder);
      close(folder);
    }
    return;
  }
  std::error_code ignored;
  fs::remove(unfinished, ignored);
  throw std::runtime_error("cannot write " + file.string() + ": " + WriteFailure(error));
}

}  // namespace train_results
