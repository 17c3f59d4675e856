#pragma once

#include <fmt/format.h>

#include <string>

namespace train_console {

/// Makes a process independent of the readers of its output. Call it first in main, before any file is opened.
///
/// - Descriptors 0, 1 and 2 that are closed become /dev/null. Otherwise the next files that are opened get these
///   numbers, and messages are written into results.
/// - A pipe whose reader has gone (SIGPIPE) and a file at the limit of its size (SIGXFSZ, `ulimit -f`) do not end the
///   process: the write that meets them fails instead (EPIPE, EFBIG).
void PrepareProcess();

/// Text of unknown origin (names, paths, what others report) as it may be shown on a terminal and written to a log.
///
/// Each control character but line feeds and tabs becomes '?': ASCII's, Unicode's second set (U+0080 to U+009F), and
/// those that turn the direction of writing (U+202A to U+202E, U+2066 to U+2069). So do bytes that are not UTF-8.
std::string Presentable(const std::string& text);

/// Text as one word of a shell's command: as it is, or quoted where a shell would split or change it.
std::string ShellWord(const std::string& text);

/// Writes to the standard error; drops the text if that fails. Never throws.
void WriteMessage(const std::string& text) noexcept;

/// A message to people: presentable, see WriteMessage. Never throws.
template <class... Values>
void Tell(fmt::format_string<Values...> format, Values&&... values) noexcept {
  try {
    WriteMessage(Presentable(fmt::format(format, std::forward<Values>(values)...)));
  } catch (...) {  // out of memory: the message is lost, the run is not
  }
}

/// Writes to the standard output. A failure is reported by FinishOutput, not here.
void WriteOutput(const std::string& text);

/// A part of a program's output: presentable, see WriteOutput.
template <class... Values>
void Print(fmt::format_string<Values...> format, Values&&... values) {
  WriteOutput(Presentable(fmt::format(format, std::forward<Values>(values)...)));
}

/// Flushes the output of all parts of the program.
/// @return why some of it could not be written; empty: all was
std::string FinishOutput();

}  // namespace train_console
