#include "train_console/console.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

namespace train_console {
namespace {

int g_error = 0;  ///< errno of the first write to the standard output that failed

void Flush() {
  if (std::fflush(stdout) != 0 && g_error == 0) g_error = errno;
}

}  // namespace

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
