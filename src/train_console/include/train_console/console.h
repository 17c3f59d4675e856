#pragma once

#include <fmt/format.h>

#include <string>

namespace train_console {

/// Makes a process independent of who reads what it says. Call it first in main, before any file is opened.
///
/// - Descriptors 0, 1 and 2 that are closed become /dev/null. Otherwise the next files that are opened get these
///   numbers, and messages are written into results.
/// - A pipe whose reader has gone (SIGPIPE) and a file at the limit of its size (SIGXFSZ, `ulimit -f`) do not end the
///   process: the write that meets them fails instead (EPIPE, EFBIG).
void PrepareProcess();

/// Writes to the standard error, or not, if that cannot be written. Never throws.
void WriteMessage(const std::string& text) noexcept;

/// A message to people, see WriteMessage. Never throws.
template <class... Values>
void Tell(fmt::format_string<Values...> format, Values&&... values) noexcept {
  try {
    WriteMessage(fmt::format(format, std::forward<Values>(values)...));
  } catch (...) {  // out of memory: the message is lost, the run is not
  }
}

/// Writes to the standard output. A failure does not show here but in FinishOutput.
void WriteOutput(const std::string& text);

/// A part of a program's output, see WriteOutput.
template <class... Values>
void Print(fmt::format_string<Values...> format, Values&&... values) {
  WriteOutput(fmt::format(format, std::forward<Values>(values)...));
}

/// Writes what is left of the output, of whatever part of the program.
/// @return why some of it could not be written; empty: all was
std::string FinishOutput();

}  // namespace train_console
