#include "strict_config/text_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace strict_config {
namespace {

namespace fs = std::filesystem;

/// The number of bytes of the UTF-8 character that begins at `i`, or 0 if there is none.
std::size_t CharacterLength(const std::string& text, std::size_t i) {
  const auto byte = [&](std::size_t j) { return j < text.size() ? static_cast<unsigned char>(text[j]) : 0u; };
  const unsigned lead = byte(i);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4) return 0;
  for (std::size_t j = 1; j < length; ++j) {
    if ((byte(i + j) & 0xC0u) != 0x80u) return 0;
  }
  const unsigned second = byte(i + 1);
  const bool overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
  const bool surrogate = lead == 0xED && second > 0x9F;
  const bool beyond_unicode = lead == 0xF4 && second > 0x8F;
  return overlong || surrogate || beyond_unicode ? 0 : length;
}

}  // namespace

std::string DisplayPath(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error).lexically_normal();
  if (error) return path.string();
  const fs::path here = fs::current_path(error);
  if (error) return absolute.string();
  const fs::path relative = absolute.lexically_relative(here);
  return relative.empty() || *relative.begin() == ".." ? absolute.string() : relative.string();
}

bool IsCleanText(const std::string& text, const std::string& label, ErrorList& errors) {
  int line = 1;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte < 0x20 && byte != '\n' && byte != '\r' && byte != '\t') || byte == 0x7F) {
      errors.Add(label, line, "",
                 byte == 0 ? "is not a text file (it contains a zero byte)"
                           : "is not a text file (it contains a control character)");
      return false;
    }
    if (byte == '\r' && i + 1 < text.size() && text[i + 1] != '\n') {
      errors.Add(label, line, "",
                 "has a carriage return without a line feed; save it with the line ends of Unix or Windows");
      return false;
    }
    const std::size_t length = CharacterLength(text, i);
    if (length == 0) {
      errors.Add(label, line, "", "is not a text file in UTF-8");
      return false;
    }
    if (byte == '\n') ++line;
    i += length;
  }
  return true;
}

std::optional<std::string> ReadTextFile(const fs::path& path, std::size_t max_bytes, ErrorList& errors) {
  const std::string label = DisplayPath(path);
  const auto refuse = [&](const std::string& reason) {
    errors.Add(label, 0, "", reason);
    return std::nullopt;
  };

  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) return refuse("does not exist");
  if (error) return refuse("cannot be read: " + error.message());
  if (fs::is_directory(status)) return refuse("is a folder, not a file");
  if (!fs::is_regular_file(status)) return refuse("is not a regular file");

  std::ifstream stream(path, std::ios::binary);
  if (!stream) return refuse(std::string("cannot be read: ") + std::strerror(errno));
  // The file may grow while it is read, so the limit is kept here and not asked of the file system.
  std::string text;
  char block[65536];
  while (text.size() <= max_bytes) {
    stream.read(block, sizeof block);
    text.append(block, static_cast<std::size_t>(stream.gcount()));
    if (!stream) break;
  }
  if (stream.bad()) return refuse("cannot be read to its end");
  if (text.size() > max_bytes) {
    return refuse("is larger than " + std::to_string(max_bytes >> 20) + " MB, the limit for such a file");
  }
  if (!IsCleanText(text, label, errors)) return std::nullopt;
  return text;
}

}  // namespace strict_config
