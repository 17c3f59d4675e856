#include "train_console/console.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <utility>

namespace train_console {
namespace {

int g_error = 0;  ///< errno of the first write to the standard output that failed

void Flush() {
  if (std::fflush(stdout) != 0 && g_error == 0) g_error = errno;
}

/// The character of UTF-8 that begins at `i`, and its number of bytes; {0, 0} if none does.
std::pair<std::uint32_t, std::size_t> CharacterAt(const std::string& text, std::size_t i) {
  const auto byte = [&](std::size_t j) { return static_cast<unsigned char>(text[j]); };
  const unsigned lead = byte(i);
  if (lead < 0x80) return {lead, 1};
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC2 ? 2 : 0;
  if (length == 0 || lead > 0xF4 || i + length > text.size()) return {0, 0};
  std::uint32_t character = lead & (0x7Fu >> length);
  for (std::size_t j = i + 1; j < i + length; ++j) {
    if ((byte(j) & 0xC0u) != 0x80u) return {0, 0};
    character = (character << 6u) | (byte(j) & 0x3Fu);
  }
  constexpr std::uint32_t kShortest[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = character >= 0xD800 && character <= 0xDFFF;
  if (character < kShortest[length] || character > 0x10FFFF || is_surrogate) return {0, 0};
  return {character, length};
}

bool IsControl(std::uint32_t character) {
  const auto is_in = [character](std::uint32_t first, std::uint32_t last) {
    return character >= first && character <= last;
  };
  if (character == '\n' || character == '\t') return false;
  return is_in(0, 0x1F) || is_in(0x7F, 0x9F) || is_in(0x202A, 0x202E) || is_in(0x2066, 0x2069);
}

}  // namespace

std::string Presentable(const std::string& text) {
  std::string presentable;
  presentable.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const auto [character, length] = CharacterAt(text, i);
    if (length == 0 || IsControl(character)) {
      presentable += '?';
    } else {
      presentable.append(text, i, length);
    }
    i += std::max<std::size_t>(length, 1);
  }
  return presentable;
}

std::string ShellWord(const std::string& text) {
  constexpr const char* kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=:,./@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string word = "'";
  for (const char character : text) word += character == '\'' ? std::string("'\\''") : std::string(1, character);
  return word + "'";
}

void PrepareProcess() {
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
    if (fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    // The lowest free number is given: this one.
    if (open("/dev/null", descriptor == STDIN_FILENO ? O_RDONLY : O_WRONLY) == -1) return;
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void WriteMessage(const std::string& text) noexcept {
  if (std::fwrite(text.data(), 1, text.size(), stderr) != text.size() || std::fflush(stderr) != 0) {
    std::clearerr(stderr);  // the next message has its own chance
  }
}

void WriteOutput(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() && g_error == 0) g_error = errno;
}

std::string FinishOutput() {
  Flush();
  if (g_error != 0) return std::strerror(g_error);
  return std::ferror(stdout) != 0 ? "an earlier write failed" : "";
}

}  // namespace train_console
